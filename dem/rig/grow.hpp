#pragma once
// Where spheres start that must fill a vessel to its real level: a bed of random loose packing, grown in place.
//
// 1. The spheres, in random order, take the lowest sites of a cubic lattice, one sphere's mean volume / 0.58 a site,
//    that are free of the bodies (dem/rig/packing.hpp). The bed so has its level in a vessel of any shape. Where these
//    sites are too few the lattice is made closer, up to 0.70, as half a site is lost along walls.
// 2. The spheres are small there, and grow to their size while those that overlap push each other apart, each by half
//    of the overlap (W. S. Jodrey & E. M. Tory, Phys. Rev. A 32:2347 (1985); here all pairs at once), and bodies push
//    them off. No sphere moves more than half its way to the nearest wall at once, so none goes through one.
// 3. The spheres grow to half a hundredth more than their size, so that at the end none touches another.
//
// A round passes over a list of pairs, made again when a sphere has moved by half of its slack. The list comes from
// grids of cells, one for each octave of radii, each sphere looking into its own and the coarser ones. The run's
// settling lets the bed sink from some 0.55 to its own density, so that it falls by little.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dem/rig/packing.hpp"

namespace dem {

struct Grown {
  std::size_t count = 0;  ///< spheres
  std::uint64_t seed = 0;
};

/// The spheres' centres [m], in the order of the grains; empty where the region has no room for them. Of `where` the
/// region, the box and `down` are used.
std::vector<Vec3> grow(const Packable& where, std::span<const Body> bodies, const Grains& grains, const Grown& what);

}  // namespace dem
