#pragma once
// The slice rig: a horizontal right-handed auger (shaft and helical blade) about the x axis in an open U-trough,
// periodic along x. Turning about +x, it moves the powder towards -x.
//
// The auger is dem/rig/auger.hpp's; the trough's half circle has 48 facets, vertices on the radius.
//
// The torque is minus the powder's moment on the mixer: positive when the powder resists. The flow is positive the way
// the helix conveys.
#include <cstdint>
#include <vector>

#include "dem/case/case.hpp"
#include "dem/case/cross_section.hpp"
#include "dem/case/grains.hpp"
#include "dem/rig/rig.hpp"
#include "dem/walls/mesh.hpp"

namespace dem {

/// One box length of the auger: x in [0, pitches * pitch).
TriangleMesh auger_mesh(const Rig& rig);

/// The U-trough over the box, its side walls up to `top` [m] above the axis.
TriangleMesh trough_mesh(const Rig& rig, double top);

/// The filling at its start: a jittered lattice clear of the walls, filled from the bottom, in random order.
struct Packing {
  Grains grains;
  std::vector<Vec3> position;  ///< m
  double top = 0.0;            ///< m above the axis, of the highest sphere
};
Packing pack(const Case& c, std::uint64_t seed);

/// How full the slice will be.
TroughFill fill_of_slice(const Case& c);

/// Indices of the bodies.
inline constexpr std::size_t mixer = 0, trough = 1;

}  // namespace dem
