#pragma once
// The keys of [rig] with kind = "stl":
//
// [[rig.mesh]]  name, file (STL, from the study's folder), unit (what 1 in the file stands for: "mm"); axis = [1, 0, 0]
//               and point = ["0 mm", "0 mm", "0 mm"] of its rotation and its torque (a measured mesh at rest that gives
//               none has the axis that all have in common which turn or swing); one of
//                 speed_ratio (constant speed over the rig's rpm; 1 for a mixer that the study's rpm drives),
//                 rpm (constant speed of its own), programme = { time = ["0 s", "1 s"], speed = ["0 rpm", "60 rpm"] }
//               (linear between, constant beyond); and [[rig.mesh.oscillation]] along or about = [0, 0, 1], amplitude,
//               frequency, phase. Motions begin when the settling ends.
// [rig]         torque_of (name of the mesh whose torque is the output, or a list of names whose torques are summed;
//               default: the first that moves), down = [0, 0, -1] (direction of gravity), rpm, fill, packing (CSV with
//               columns x, y, z; if wanted vx, vy, vz in m/s, unless a heading has a unit of its own, and frozen, 1 for
//               spheres that never move), packing_unit ("m")
// [rig.box]     low, high (corners), periodic = ["x"]
// [rig.region]  where the centres start: low, high of a box (default: the rig's box), or from, to (ends of the axis),
//               radius, inner_radius of a cylinder
#include <memory>
#include <string>

#include "data/study_file.hpp"
#include "dem/case/stl_rig.hpp"

namespace dem {

/// Problems are recorded in the study. Files are found from `folder`.
std::shared_ptr<const StlRig> read_stl_rig(const data::Section& rig, const std::string& folder);

}  // namespace dem
