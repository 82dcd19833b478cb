#include "cli/observe_idle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data/error.hpp"
#include "data/log_faults.hpp"

namespace cli {

Idle find_idle(const ObserveOptions& options, const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus) {
  Idle idle;
  const bool from_log = !options.idle_log.empty() || !options.idle_window.seconds.empty();
  if (options.idle && from_log)
    throw data::InputError(
        data::ExitStatus::usage,
        data::Problem{"--idle", "and a log of the idle torque contradict each other", "give one of them"});
  if (options.idle_error && !options.idle)
    throw data::InputError(data::ExitStatus::usage,
                           data::Problem{"--idle-error", "has no value that it is the error of", "give --idle, too"});
  if (options.idle) {
    idle.kind = Idle::Kind::value;
    const data::MeanTorque value{log.torque_unit.to_si(*options.idle),
                                 log.torque_unit.factor * options.idle_error.value_or(0.0)};
    idle.at.assign(plateaus.size(), value);
  } else if (from_log) {
    idle.kind = Idle::Kind::log;
    data::TorqueLog empty = options.idle_log.empty() ? log : data::read_torque_log(options.idle_log, options.columns);
    if (!options.idle_log.empty())
      for (const std::string& note : empty.notes) say(options.common, fmt::format("note: {}: {}", empty.file, note));
    if (!options.idle_log.empty()) {
      for (const std::string& words : empty.warnings) idle.warnings.push_back(fmt::format("{}: {}", empty.file, words));
      for (const std::string& words : data::remove_no_values(empty))
        idle.warnings.push_back(fmt::format("{}: {}", empty.file, words));
    }
    data::PlateauOptions part = options.plateaus;
    part.from = options.idle_window.from();
    part.to = options.idle_window.to();
    const std::vector<data::Plateau> found = data::find_plateaus(empty, part);
    for (const data::Plateau& plateau : plateaus) {
      const auto value = data::idle_at(found, plateau.speed, 2.0 * options.plateaus.tolerance);
      if (!value) {
        std::string speeds;
        for (const data::Plateau& one : found)
          speeds += fmt::format("{}{:.4g}", speeds.empty() ? "" : ", ", log.speed_unit.from_si(one.speed));
        data::refuse_data(
            empty.file,
            fmt::format("the empty machine was not run at {:.4g} {} (its plateaus: {})",
                        log.speed_unit.from_si(plateau.speed), log.speed_unit.symbol, speeds.empty() ? "none" : speeds),
            "log it at every speed of the measurement, or give one value with --idle");
      }
      idle.at.push_back(*value);
    }
  }
  return idle;
}

data::MeanTorque observed_torque(const data::Plateau& plateau, const Idle& idle, std::size_t i) {
  data::MeanTorque found{plateau.torque.mean, plateau.torque.standard_error};
  if (idle.kind != Idle::Kind::none) found.value -= idle.at[i].value;
  if (idle.kind == Idle::Kind::log) found.error = std::hypot(found.error, idle.at[i].error);
  return found;
}

std::string standstill_reading(const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus,
                               const data::PlateauOptions& options) {
  const double standstill = data::standstill_speed(log);
  double least_error = INFINITY;
  for (const data::Plateau& plateau : plateaus) least_error = std::min(least_error, plateau.torque.standard_error);
  const auto stands = [&](std::size_t i) {
    return i < log.time.size() && std::abs(log.speed[i]) <= standstill && log.time[i] >= options.from &&
           log.time[i] <= options.to;
  };
  std::vector<std::string> readings;
  data::SeriesMean first;
  bool matters = false, zero_moves = false;
  for (std::size_t begin = 0; begin < log.time.size(); ++begin) {
    if (!stands(begin)) continue;
    std::size_t last = begin;
    while (stands(last + 1)) ++last;
    if (log.time[last] - log.time[begin] >= options.shortest) {
      const data::SeriesMean zero = data::mean_of_hold({log.torque.data() + begin, last - begin + 1});
      matters = matters || std::abs(zero.mean) > 3.0 * std::hypot(zero.standard_error, least_error);
      if (readings.empty()) first = zero;
      zero_moves = zero_moves || std::abs(zero.mean - first.mean) >
                                     5.0 * std::hypot(zero.standard_error, first.standard_error, least_error);
      readings.push_back(fmt::format("{:.4g} +- {:.2g} {} from {:.4g} s on", log.torque_unit.from_si(zero.mean),
                                     zero.standard_error / log.torque_unit.factor, log.torque_unit.symbol,
                                     log.time[begin]));
    }
    begin = last;
  }
  if (!matters) return {};
  if (zero_moves)
    return fmt::format(
        "at standstill the meter reads {}: its zero moves, and no one value can be taken off. Read the empty machine "
        "before and after each speed, or state what it may be off by (common_error)",
        fmt::join(readings, ", "));
  return fmt::format(
      "at standstill the meter reads {}, and nothing is taken off: if that is its zero, and not powder that "
      "leans on the mixer, take it off (--idle {:.4g})",
      fmt::join(readings, ", "), log.torque_unit.from_si(first.mean));
}

}  // namespace cli
