#pragma once
// The cost of a run, measured on this machine in about a tenth of a second. 1728 spheres of the case's mean size on a
// periodic cubic lattice, each touching four neighbours, move a little under the case's own laws and time step. A bed
// has walls besides: runs of slice and machine took 1.0 to 1.6 times as long.
//
// The meshes of an STL rig are measured, too, where they are fine: their surfaces are made as a run makes them, and it
// is timed how long it takes to find what a sphere at the wall may touch. A run does so at each rebuild of its lists,
// for half of the spheres, or for as many as half of the surface has room for.
#include "dem/bed/derived.hpp"

namespace dem {

struct Effort {
  double rate = 0.0;              ///< particle-steps per second of processor time, one thread
  double bytes_per_sphere = 0.0;  ///< bytes of state and lists
  double seconds_at_walls = 0.0;  ///< s of processor time a step, to list what spheres at fine meshes may touch
  double bytes_of_meshes = 0.0;   ///< bytes of fine meshes, while their surfaces are made
};
Effort measure_effort(const Case& c, const Derived& d);

}  // namespace dem
