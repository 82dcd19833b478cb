#pragma once
// A material's DEM case from a study. Keys, with their defaults, in dem/case/case.hpp; quantities carry units as text.
//
// [rig]      kind = "slice"; shaft_radius, blade_radius, blade_thickness, pitch, trough_radius (lengths), pitches
// (count),
//            fill (number of spheres, or a mass with its unit), rpm (angular speed, for `simulate` without a control);
//            kind = "drum"; drum_radius, drum_length, end_plates = "turning"|"resting"|"none", rpm, and fill, or level
//            (of the drum's volume, by the bed at rest);
//            kind = "stl": dem/reading/read_stl_rig.hpp
// [materials.NAME]  density, diameter, fill (instead of the rig's), coarse_graining, and any key of [contact] in a
//            sub-table [materials.NAME.contact] that differs for this material
// [contact]  stiffness, wall_stiffness, restitution, tangential_ratio, tangential_damping, friction, wall_friction,
//            tension = "allowed"|"clamped", cap = "net"|"repulsion"|"thornton", hamaker, wall_hamaker,
//            hamaker_of = "simulation"|"original", length_scale = "diameter"|"radius",
//            wall_attraction = "as_grains"|"derjaguin", minimum_separation, cut_off
// [run]      gravity, steps_per_contact, skin (in diameters), settle, start_up, sample_interval, window, shortest,
//            shortest_turns, longest; the wanted error is [training] standard_error
#include <string_view>

#include "data/study_file.hpp"
#include "dem/case/case.hpp"

namespace dem {

/// Problems are recorded in the study; `material` "" reads a study without [materials].
Case read_case(const data::StudyFile& study, std::string_view material);

}  // namespace dem
