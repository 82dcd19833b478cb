#pragma once
// Where spheres of one size start in a region with bodies in it (dem/stl_rig.hpp says how).
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dem/simulation.hpp"
#include "dem/stl_rig.hpp"

namespace dem {

struct Packable {
  const FillRegion& region;
  Vec3 low, high;  ///< m, the box
  std::array<bool, 3> periodic;
  Vec3 down;              ///< unit
  double diameter = 0.0;  ///< m
};

/// Free sites of the lattice, lowest first, those of a layer in random order; each keeps clear of all others and of the
/// bodies by the jitter that `jittered` gives it.
std::vector<Vec3> free_sites(const Packable& where, std::span<const Body> bodies, std::uint64_t seed);

/// The first `count` sites, each moved at random, in random order.
std::vector<Vec3> jittered(std::vector<Vec3> sites, std::size_t count, double diameter, std::uint64_t seed);

/// How deep a sphere at `center` reaches into the bodies at the start [m]; negative when it does not.
double depth_in_bodies(std::span<const Body> bodies, std::span<const Surface> surfaces, Vec3 center, double radius);

}  // namespace dem
