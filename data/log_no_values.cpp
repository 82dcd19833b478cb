// Samples that are no measurement (log_faults.hpp).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "data/log_faults.hpp"

namespace data {
namespace {

constexpr std::array codes{999.0,   999.9,   999.99,  9999.0, 9999.9, 9999.99, 99999.0, 99999.9, 999999.0, 9999999.0,
                           32767.0, 32768.0, 65535.0, 1e10,   1e30,   9.9e37,  1e37,    1e38,    3.4e38};

bool is_code(double value) {
  return std::any_of(codes.begin(), codes.end(),
                     [&](double code) { return std::abs(std::abs(value) - code) <= 1e-6 * code; });
}

/// Marks the codes among values (in the log's own unit); returns which there are, and how often.
std::map<double, std::size_t> mark_codes(const std::vector<double>& values, std::vector<bool>& out) {
  std::map<double, std::size_t> found;
  const MedianSpread spread = spread_of(values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!is_code(values[i])) continue;
    if (std::abs(values[i] - spread.median) <= 10.0 * std::max(spread.sd, 0.1 * std::abs(spread.median))) continue;
    out[i] = true;
    ++found[values[i]];
  }
  return found;
}

/// Zeros between samples that lie far above what one sample differs from the next.
std::size_t mark_drop_outs(const TorqueLog& log, std::vector<bool>& out) {
  double fastest = 0.0;
  for (std::size_t i = 0; i < log.speed.size(); ++i)
    if (!out[i]) fastest = std::max(fastest, std::abs(log.speed[i]));
  std::vector<double> steps;
  double last = NAN;
  for (std::size_t i = 0; i < log.torque.size(); ++i) {
    if (out[i] || log.torque[i] == 0.0) continue;
    if (std::isfinite(last)) steps.push_back(std::abs(log.torque[i] - last));
    last = log.torque[i];
  }
  if (steps.empty()) return 0;
  const double step = median_of(std::move(steps));
  constexpr std::size_t reach = 5;
  std::size_t found = 0;
  std::vector<bool> zeros(out.size(), false);
  for (std::size_t i = 0; i < log.torque.size(); ++i) {
    if (out[i] || log.torque[i] != 0.0 || std::abs(log.speed[i]) <= 0.01 * fastest) continue;
    double before = 0.0, after = 0.0;
    for (std::size_t k = 1; k <= reach && k <= i && before == 0.0; ++k) before = out[i - k] ? 0.0 : log.torque[i - k];
    for (std::size_t k = 1; k <= reach && i + k < log.torque.size() && after == 0.0; ++k)
      after = out[i + k] ? 0.0 : log.torque[i + k];
    if (before * after <= 0.0 || std::min(std::abs(before), std::abs(after)) <= 8.0 * step) continue;
    zeros[i] = true;
    ++found;
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = out[i] || zeros[i];
  return found;
}

}  // namespace

std::vector<std::string> remove_no_values(TorqueLog& log) {
  std::vector<bool> out(log.time.size(), false);
  std::vector<std::string> words;
  const auto codes_in = [&](const std::vector<double>& si, const Unit& unit, const char* what) {
    std::vector<double> values;
    for (const double value : si) values.push_back(unit.from_si(value));
    for (const auto& [code, count] : mark_codes(values, out))
      words.push_back(
          fmt::format("{} samples with a {} of {:g} {}, which looks like a code for 'no value', are left out", count,
                      what, code, unit.symbol));
  };
  codes_in(log.torque, log.torque_unit, "torque");
  codes_in(log.speed, log.speed_unit, "speed");
  if (const std::size_t zeros = mark_drop_outs(log, out); zeros > 0)
    words.push_back(fmt::format(
        "{} samples with a torque of exactly 0 amid others of a turning machine are left out as drop-outs", zeros));
  if (words.empty()) return words;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i]) continue;
    log.time[kept] = log.time[i];
    log.torque[kept] = log.torque[i];
    log.speed[kept++] = log.speed[i];
  }
  log.time.resize(kept);
  log.torque.resize(kept);
  log.speed.resize(kept);
  return words;
}

}  // namespace data
