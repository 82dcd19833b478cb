#pragma once
// Sentences about a rig before it runs, the same for all kinds.
#include <string>

#include "dem/forecast/forecast.hpp"

namespace dem {

/// Notes a gap of less than four of the largest sphere; warns of one in which spheres are pinched.
void say_gap(Forecast& f, const std::string& between, double width);

/// Warns of a tool that only skims the bed. Measured on slices, the torque falls by a third and more while the bed
/// settles under such a tool, and may come to 0 (dem/STEADY.md).
void say_immersion(Forecast& f, const std::string& tool, double lowest);

}  // namespace dem
