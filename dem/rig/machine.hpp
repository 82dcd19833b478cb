#pragma once
// The machine rig: two augers like the slice's side by side in a double trough, between end walls. A partition parts
// the troughs and is open at both ends, so the powder goes round: along one auger, through the opening, back along the
// other.
//
//            opening        partition         opening       seen from above, x to the right; both augers are
//         |           |===================|           |     right-handed
//         |   second: turns about -x, moves to +x  -->|     y > 0
//         |           |===================|           |
//         |<-- first: turns about +x, moves to -x     |     y < 0
//
// Both augers rise on the side of the partition. The blade of each begins two clearances of blade and trough from the
// end wall where its powder comes in. It ends where the other opening begins, where powder that arrives pushes the
// powder before it over the sill. The openings reach from the sill up. Partition and troughs meet without a step: the
// axes are 2 trough_radius + partition apart.
//
// The torque is the sum of both mixers', each about its own axis, positive when the powder resists. The axial flow is
// the mean of both troughs' along the partition, positive the way that the augers convey: powder goes round in its
// mass / this flow.
#include "dem/case/case.hpp"
#include "dem/case/cross_section.hpp"
#include "dem/rig/rig.hpp"
#include "dem/walls/mesh.hpp"

namespace dem {

/// Distance [m] of either axis from the middle plane, y = 0.
double axis_offset(const Rig& rig);

/// The first auger's mesh, y < 0, and the second's.
TriangleMesh first_auger(const Rig& rig);
TriangleMesh second_auger(const Rig& rig);

/// Troughs, partition and end walls; the outer walls reach up to `top` [m] above the axes.
TriangleMesh double_trough(const Rig& rig, double top);

TroughFill fill_of_machine(const Case& c);

/// Indices of the bodies.
inline constexpr std::size_t first_mixer = 0, second_mixer = 1;

}  // namespace dem
