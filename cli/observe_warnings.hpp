#pragma once
// Warnings that a user of observations should know.
#include <string>
#include <vector>

#include "cli/observe_idle.hpp"
#include "data/torque_log.hpp"

namespace cli {

/// Warnings of sensor and logger, of signs, and of errors that are too small or approximate.
std::vector<std::string> warnings_of(const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus,
                                     const Idle& idle);

/// A warning where less than two thirds of the turning belong to a plateau: by how much, and the remedy. `known`:
/// seconds about which something else was said, such as slow ramps.
std::string left_over(const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus,
                      const data::PlateauOptions& options, double known);

}  // namespace cli
