#pragma once
// What the positions that a user gives to the spheres of a rig of meshes must keep clear of.
#include <span>

#include "dem/case/stl_rig.hpp"
#include "dem/engine/simulation.hpp"

namespace dem {

/// What the positions of StlRig::packing stand among.
struct GivenPacking {
  std::span<const Body> bodies;
  std::span<const double> radii;  ///< m, of each sphere of the bed, or the one of all
  double overlap_limit = 0.0;     ///< of a radius (RunControl)
  double radius(std::size_t sphere) const { return radii[radii.size() == 1 ? 0 : sphere]; }
};

/// Given positions must lie in the box, clear of the meshes and of each other, and given diameters be those of the bed
/// that the materials make. Throws data::InputError (78) for the
/// first that does not.
void check_packing(const StlRig& rig, const GivenPacking& given);

}  // namespace dem
