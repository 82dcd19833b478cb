#pragma once
// The drum rig: a horizontal cylinder about the y axis that turns about -y, so that at a positive speed the side x > 0
// rises. The powder is inside, between two end plates; or the drum has none and repeats along y.
//
// The shell is a polygon with its corners on the radius. It has so many sides, between 48 and 720, that their middles
// lie a fiftieth of the smallest sphere's radius further in. Each end plate is a flat polygon that covers the circle.
//
// The torque is that of all turning parts about the axis: the shell, and end plates that turn with it. It is positive
// when the powder resists. In steady flow the weight's moment about the axis is held by shell and end plates together:
// weight * centre_x = torque of the shell + torque of the end plates. End plates that rest brake the powder, so their
// part is negative and the torque of the shell alone is larger than weight * centre_x.
#include "dem/case/case.hpp"
#include "dem/rig/rig.hpp"
#include "dem/walls/mesh.hpp"

namespace dem {

/// The cylinder's wall, y in [0, length].
TriangleMesh shell_mesh(const Drum& drum, double smallest);

/// Both end plates, at y = 0 and y = length.
TriangleMesh end_plates_mesh(const Drum& drum);

/// The fill of the drum, the powder taken as a liquid of spheres packed to packing_fraction.
struct DrumFill {
  double share = 0.0;    ///< of the drum's volume
  double surface = 0.0;  ///< m above the axis, at rest
};
DrumFill fill_of_drum(const Case& c);
/// A drum fuller than this is refused: little surface is left on which powder could flow, and no room to fill it.
inline constexpr double fullest_drum = 0.85;

/// Froude number w^2 R / g: from 1 on, inertia holds spheres at the wall all the way round.
double froude_number(const Case& c);

/// Indices of the bodies.
inline constexpr std::size_t shell = 0, plates = 1;

}  // namespace dem
