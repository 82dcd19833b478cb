#pragma once
// One point of a study: what is simulated, under which settings and with which random streams.
#include <cstdint>
#include <string>
#include <vector>

#include "campaign/workspace.hpp"
#include "data/run_table.hpp"
#include "dem/run/run.hpp"

namespace campaign {

struct Point {
  std::string material;
  std::vector<double> inputs;  ///< SI: parameters, then controls, in the study's order
};

/// Reads a point from texts like "friction=0.4" and "hamaker=2e-18 J". A bare number is in the unit of the parameter or
/// control. What is not given is the material's fixed value or the middle of the range, of a speed
/// to either side of a standstill that of the speeds forwards. Throws InputError (64) on an
/// unknown name, unit or a value outside the target's physical range.
Point parse_point(const Workspace& workspace, const std::string& material, const std::vector<std::string>& at);

/// The point in words: "friction 0.4, hamaker 2e-18 J, rpm 150 rpm".
std::string describe(const data::Study& study, const Point& point);

/// The material's DEM case with the point's values set by target, run until the errors of the study's outputs are
/// known.
dem::Case case_at(const Workspace& workspace, const Point& point);

/// Hash of every DEM setting of the material that decides what a run estimates and is not an input: rows with another
/// hash are stale.
std::string settings_hash(const Workspace& workspace, const std::string& material);

/// Hash of the DEM settings that decide how the bed moves; run.start_up_turns, which decides what is dropped of a run,
/// is not among them. A run kept in a file goes on, with its seed, when another part of it is wanted.
std::string course_hash(const Workspace& workspace, const std::string& material);

/// A 64-bit number that depends on every character of the text.
std::uint64_t number_from(const std::string& text);

/// Seed of the point's random streams: a function of the study's seed, the point and the course's settings alone.
std::uint64_t run_seed(const Workspace& workspace, const Point& point);

/// The row of the run table that a finished run makes. Outputs that the DEM does not give are an InputError (78).
data::RunRow to_row(const Workspace& workspace, const Point& point, const dem::RunResult& result);

/// The material named, or the only or first one of the study. Throws InputError (64) when there is none of that name.
std::string choose_material(const data::Study& study, const std::string& wanted);

}  // namespace campaign
