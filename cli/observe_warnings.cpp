#include "cli/observe_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data/log_faults.hpp"

namespace cli {
namespace {

/// Speeds that are held more than once, with torques further apart than their errors say.
std::vector<std::string> repeats_apart(const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus,
                                       const Idle& idle) {
  constexpr double same_speed = 0.01, far = 5.0;  // of the speed; standard errors of the difference
  std::vector<std::string> warnings;
  std::vector<bool> told(plateaus.size(), false);
  for (std::size_t i = 0; i < plateaus.size(); ++i) {
    if (told[i]) continue;
    std::vector<double> values;
    double apart = 0.0;
    for (std::size_t j = i; j < plateaus.size(); ++j) {
      if (std::abs(plateaus[j].speed - plateaus[i].speed) > same_speed * std::abs(plateaus[i].speed)) continue;
      const data::MeanTorque one = observed_torque(plateaus[i], idle, i), other = observed_torque(plateaus[j], idle, j);
      values.push_back(other.value);
      told[j] = true;
      apart = std::max(apart, std::abs(other.value - one.value) / std::hypot(one.error, other.error));
    }
    if (values.size() < 2 || !(apart > far)) continue;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    warnings.push_back(fmt::format(
        "{:.4g} {} is held {} times, and its torques, {:.4g} to {:.4g} {}, lie {:.2g} standard errors apart: what "
        "changes between the holds is larger than the errors here (raise these in the file, or let the case find them: "
        "noise = \"unknown\")",
        log.speed_unit.from_si(plateaus[i].speed), log.speed_unit.symbol, values.size(),
        log.torque_unit.from_si(*least), log.torque_unit.from_si(*most), log.torque_unit.symbol, apart));
  }
  return warnings;
}

}  // namespace

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
    warnings.push_back(fmt::format("{} samples without all three values are left out: {}", log.missing,
                                   log.missing_torque > 0
                                       ? "where the sensor was beyond its range then, means are too small"
                                       : "none of them lacks its torque, but a time or a speed"));
  for (const data::Plateau& plateau : plateaus)
    if (!plateau.torque.reliable)
      warnings.push_back(fmt::format(
          "{:.4g} {} at {:.4g} s: too short for its correlation, or still drifting: its error is too small; measure "
          "longer",
          log.speed_unit.from_si(plateau.speed), log.speed_unit.symbol, log.time[plateau.first]));
  for (std::string& repeat : repeats_apart(log, plateaus, idle)) warnings.push_back(std::move(repeat));
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
