#pragma once
// The options of demcal observe.
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "data/torque_log.hpp"

namespace cli {

/// A part of a log, in seconds.
struct Window {
  std::vector<double> seconds;  ///< empty: all of the log; else its begin and end
  double from() const { return seconds.empty() ? -INFINITY : seconds[0]; }
  double to() const { return seconds.empty() ? INFINITY : seconds[1]; }
};

struct ObserveOptions {
  Common common;
  std::string log, out, idle_log, unit, output = "torque", control = "rpm";
  data::LogColumns columns;
  data::PlateauOptions plateaus;
  Window window, idle_window;
  std::optional<double> constant_speed;    ///< in rpm or --rpm-unit
  std::optional<double> idle, idle_error;  ///< in the log's unit of torque
};

}  // namespace cli
