#pragma once
// Where spheres start: on the sites of a lattice, in a region with bodies in it (dem/case/stl_rig.hpp says how) or in
// the slice (dem/rig/slice.cpp). Where the lattice has too few sites they grow to a dense bed instead
// (dem/rig/grow.hpp).
//
// The lattice is that of the largest spheres. A site takes one of them, or a parcel of n^3 smaller spheres, at least n
// times smaller (n up to 8), on a cubic lattice of their own, so that fine powder does not start as a cloud.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dem/case/grains.hpp"
#include "dem/case/stl_rig.hpp"
#include "dem/engine/simulation.hpp"

namespace dem {

struct Packable {
  const FillRegion& region;
  Vec3 low, high;  ///< m, the box
  std::array<bool, 3> periodic;
  Vec3 down;               ///< unit
  double diameter = 0.0;   ///< m, of the largest sphere
  double clearance = 0.0;  ///< m, least distance of a site's centre from bodies and from the box's closed faces
};

/// Spacing of the lattice's sites and the largest random shift of each, in diameters of the largest sphere.
inline constexpr double site_spacing = 1.1, site_jitter = 0.04;

/// What each site holds: the first sphere of each parcel, one more, and n of n^3.
struct Parcels {
  std::vector<std::size_t> first;
  std::vector<int> along;
  double clearance = 0.0;  ///< m, clearance that a site's centre needs, its jitter included
  std::size_t sites() const { return along.size(); }
};
/// Divides the first `count` spheres, which are sorted largest first, among parcels.
Parcels make_parcels(const Grains& grains, std::size_t count);
/// The spheres at the sites, which hold the parcels in their order.
std::vector<Vec3> place(const Parcels& parcels, const std::vector<Vec3>& sites, double largest);

/// Free sites of the lattice, lowest first, those of a layer in random order; each keeps clear of all others and of the
/// bodies by the jitter that `jittered` gives it.
std::vector<Vec3> free_sites(const Packable& where, std::span<const Body> bodies, std::uint64_t seed);

/// The first `count` sites, each moved at random, in random order.
std::vector<Vec3> jittered(std::vector<Vec3> sites, std::size_t count, double diameter, std::uint64_t seed);

/// How deep a sphere at `center` reaches into the bodies at the start [m]; negative when it does not.
double depth_in_bodies(std::span<const Body> bodies, std::span<const Surface> surfaces, Vec3 center, double radius);

}  // namespace dem
