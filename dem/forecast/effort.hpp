#pragma once
// The cost of a run, measured on this machine in about a tenth of a second. 1728 spheres of the case's mean size on a
// periodic cubic lattice, each touching four neighbours, move a little under the case's own laws and time step. A bed
// has walls besides: runs of slice and machine took 1.0 to 1.6 times as long.
#include "dem/bed/derived.hpp"

namespace dem {

struct Effort {
  double rate = 0.0;              ///< particle-steps per second of processor time, one thread
  double bytes_per_sphere = 0.0;  ///< bytes of state and lists
};
Effort measure_effort(const Case& c, const Derived& d);

}  // namespace dem
