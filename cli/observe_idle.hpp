#pragma once
// The idle torque: that of the empty machine, which is taken off what the meter read.
#include <string>
#include <vector>

#include "cli/observe_options.hpp"
#include "data/torque_log.hpp"

namespace cli {

/// The torque that is taken off: nothing, one value for all rows, or the empty machine's torque at each speed.
struct Idle {
  enum class Kind { none, value, log } kind = Kind::none;
  std::vector<data::MeanTorque> at;        ///< SI, idle torque at each plateau
  std::vector<std::string> warnings = {};  ///< warnings of the empty machine's own log
};

/// Finds the idle torque. Throws InputError: 64 options that contradict each other; 65 a speed at which the empty
/// machine was not run.
Idle find_idle(const ObserveOptions& options, const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus);

/// The torque of one row, without the idle torque. A value that is taken off every row has an error common to all,
/// which is stated beside the rows. The error of a log's torque at each speed is the row's own.
data::MeanTorque observed_torque(const data::Plateau& plateau, const Idle& idle, std::size_t i);

/// The meter's reading at standstill, in words; empty where it is not more than the rows' errors allow. It is for logs
/// of which no idle torque is taken off.
std::string standstill_reading(const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus,
                               const data::PlateauOptions& options);

}  // namespace cli
