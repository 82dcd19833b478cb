#pragma once
// Observations as a table that a study reads.
#include <string>
#include <vector>

#include "cli/observe_idle.hpp"
#include "data/torque_log.hpp"
#include "data/unit.hpp"

namespace cli {

/// One row per plateau; beside the columns that a study reads, what the mean rests on. Names are plain, for programs that
/// look for them; the comment of units is read also as a spreadsheet saves it again.
std::string observations_csv(const ObserveOptions& options, const data::TorqueLog& log,
                             const std::vector<data::Plateau>& plateaus, const Idle& idle, const data::Unit& unit);

}  // namespace cli
