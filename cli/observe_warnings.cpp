#include "cli/observe_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data/log_faults.hpp"

namespace cli {

std::vector<std::string> warnings_of(const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus,
                                     const Idle& idle) {
  std::vector<std::string> warnings;
  for (const data::Plateau& plateau : plateaus)
    for (std::string& fault : data::plateau_faults(log, plateau)) warnings.push_back(std::move(fault));
  std::size_t negative = 0;
  for (std::size_t i = 0; i < plateaus.size(); ++i) negative += observed_torque(plateaus[i], idle, i).value < 0.0;
  if (negative > 0)
    warnings.push_back(fmt::format("{} negative: is the sign of the sensor right{}?",
                                   negative == plateaus.size()
                                       ? "every torque is"
                                       : fmt::format("{} of {} torques are", negative, plateaus.size()),
                                   idle.kind == Idle::Kind::none ? "" : ", and is so much idle torque meant"));
  if (log.missing > 0)
    warnings.push_back(fmt::format(
        "{} samples without all three values are left out: where the sensor was beyond its range then, means are too "
        "small",
        log.missing));
  for (const data::Plateau& plateau : plateaus)
    if (!plateau.torque.reliable)
      warnings.push_back(fmt::format(
          "{:.4g} {} at {:.4g} s: too short for its correlation, or still drifting: its error is too small; measure "
          "longer",
          log.speed_unit.from_si(plateau.speed), log.speed_unit.symbol, log.time[plateau.first]));
  return warnings;
}

std::string left_over(const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus,
                      const data::PlateauOptions& options, double known) {
  const double standstill = data::standstill_speed(log);
  double turning = 0.0, held = 0.0;
  for (std::size_t i = 1; i < log.time.size(); ++i)
    if (std::abs(log.speed[i]) > standstill && log.time[i] >= options.from && log.time[i] <= options.to &&
        log.time[i] - log.time[i - 1] <= std::max(4.0 * log.interval, options.shortest))  // else nothing was logged
      turning += log.time[i] - log.time[i - 1];
  for (const data::Plateau& plateau : plateaus)
    held += log.time[plateau.first + plateau.count - 1] - log.time[plateau.first];
  if (turning - known < 1.5 * held) return {};
  return fmt::format(
      "{:.3g} s of {:.3g} s of turning belong to no speed that stays within {:g} %: where the tachometer scatters by "
      "more, widen that (--tolerance {:g})",
      turning - known - held, turning, 100.0 * options.tolerance, 500.0 * options.tolerance);
}

}  // namespace cli
