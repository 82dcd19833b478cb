#pragma once
// Observations as a table that a study reads.
#include <string>
#include <vector>

#include "cli/observe_idle.hpp"
#include "data/torque_log.hpp"
#include "data/unit.hpp"

namespace cli {

/// A table with one row per plateau. Beside the columns that a study reads it has the numbers on which each mean rests.
/// Names are plain, for programs that look for them. The comment of units can also be read after a spreadsheet has
/// saved it again.
std::string observations_csv(const ObserveOptions& options, const data::TorqueLog& log,
                             const std::vector<data::Plateau>& plateaus, const Idle& idle, const data::Unit& unit);

}  // namespace cli
