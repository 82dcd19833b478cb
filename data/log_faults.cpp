// Robust scales: the median and the median absolute deviation, times 1.4826 for a normal distribution's sd.
#include "data/log_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace data {
namespace {

/// A torque of so few values says nothing of a limit: the logger is coarse.
constexpr std::size_t coarse_levels = 3;

constexpr std::array codes{999.0,   999.9,   999.99,  9999.0, 9999.9, 9999.99, 99999.0, 99999.9, 999999.0, 9999999.0,
                           32767.0, 32768.0, 65535.0, 1e10,   1e30,   9.9e37,  1e37,    1e38,    3.4e38};

struct MedianSpread {
  double median = 0.0, sd = 0.0;
};
MedianSpread spread_of(const std::vector<double>& values) {
  MedianSpread spread{median_of(values), 0.0};
  std::vector<double> away;
  for (const double value : values) away.push_back(std::abs(value - spread.median));
  spread.sd = 1.4826 * median_of(std::move(away));
  return spread;
}

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

/// "100 rpm at 12.5 s".
std::string place_of(const TorqueLog& log, const Plateau& plateau) {
  return fmt::format("{:.4g} {} at {:.4g} s", log.speed_unit.from_si(plateau.speed), log.speed_unit.symbol,
                     log.time[plateau.first]);
}

/// "2 spikes, the largest 40 mN m at 17.3 s", of the samples used at `spikes`, each away from what it stands in.
std::string spikes_in_words(const TorqueLog& log, const Plateau& plateau, const std::vector<std::size_t>& spikes,
                            double usual) {
  std::size_t farthest = spikes.front();
  const auto away = [&](std::size_t i) { return std::abs(log.torque[plateau.used_from + i] - usual); };
  for (const std::size_t i : spikes)
    if (away(i) > away(farthest)) farthest = i;
  return fmt::format("{} spike{} {:.4g} {} at {:.5g} s", spikes.size(), spikes.size() == 1 ? "," : "s, the largest",
                     log.torque_unit.from_si(log.torque[plateau.used_from + farthest]), log.torque_unit.symbol,
                     log.time[plateau.used_from + farthest]);
}

std::vector<double> used_torques(const TorqueLog& log, const Plateau& plateau) {
  const double* const torque = log.torque.data();
  return {torque + plateau.used_from, torque + plateau.first + plateau.count};
}

struct Level {
  double value = 0.0;
  std::size_t count = 0, next = 0;  ///< samples at the extreme value, and at the value beside it
};
Level extreme(const std::map<double, std::size_t>& levels, bool largest) {
  const auto beside = [](auto at) { return std::next(at)->second; };
  if (largest)
    return {levels.rbegin()->first, levels.rbegin()->second, levels.size() > 1 ? beside(levels.rbegin()) : 0};
  return {levels.begin()->first, levels.begin()->second, levels.size() > 1 ? beside(levels.begin()) : 0};
}

std::map<double, std::size_t> levels_of(const std::vector<double>& values) {
  std::map<double, std::size_t> levels;
  for (const double value : values) ++levels[value];
  return levels;
}

/// Change along the straight line through the values where it is beyond chance, else 0. The line's slope over n samples
/// has the error sqrt(12) / n times that of the mean of what remains around it.
double drift(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0.0, slope = 0.0;
  for (const double value : values) mean += value / n;
  for (std::size_t i = 0; i < values.size(); ++i)
    slope += (static_cast<double>(i) - 0.5 * (n - 1.0)) * (values[i] - mean) * 12.0 / (n * n * n - n);
  std::vector<double> rest;
  for (std::size_t i = 0; i < values.size(); ++i)
    rest.push_back(values[i] - slope * (static_cast<double>(i) - 0.5 * (n - 1.0)));
  const double error = std::sqrt(12.0) * mean_with_error(rest, {.start_up_fraction_max = 0.0}).standard_error;
  const double change = slope * n;
  return std::abs(change) > 5.0 * error ? change : 0.0;
}

/// The longest run of samples below a tenth of what nine in ten do not exceed, if it is a fiftieth of all and five
/// samples: a machine that stood still. First, and one past the last; none: equal.
std::pair<std::size_t, std::size_t> idle_part(const std::vector<double>& values) {
  std::vector<double> sizes;
  for (const double value : values) sizes.push_back(std::abs(value));
  const auto high = sizes.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), high, sizes.end());
  const double low = 0.1 * *high;
  std::pair<std::size_t, std::size_t> idle{0, 0};
  for (std::size_t from = 0; from < values.size(); ++from) {
    std::size_t to = from;
    while (to < values.size() && std::abs(values[to]) < low) ++to;
    if (to - from > idle.second - idle.first) idle = {from, to};
    from = std::max(from, to);
  }
  const std::size_t count = idle.second - idle.first;
  return count >= 5 && 50 * count >= values.size() ? idle : std::pair<std::size_t, std::size_t>{0, 0};
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

std::optional<double> saturated_at(const TorqueLog& log, const Plateau& plateau, double most) {
  const std::vector<double> values = used_torques(log, plateau);
  if (values.size() < 10) return {};
  const std::map<double, std::size_t> levels = levels_of(values);
  if (levels.size() == 1) return levels.begin()->first;
  if (levels.size() <= coarse_levels) return {};
  for (const bool largest : {false, true}) {
    const Level level = extreme(levels, largest);
    // Values that are merely coarse become rarer towards the ends.
    if (static_cast<double>(level.count) > most * static_cast<double>(values.size()) && level.count > 3 * level.next)
      return level.value;
  }
  return {};
}

std::optional<double> dies_at(const TorqueLog& log, const Plateau& plateau) {
  constexpr std::size_t fewest = 5;
  constexpr double nearly_nothing = 0.1;
  if (plateau.torque.dropped < fewest) return {};
  const auto dropped = log.torque.begin() + static_cast<std::ptrdiff_t>(plateau.used_from);
  const double before =
      std::abs(median_of(std::vector<double>(dropped - static_cast<std::ptrdiff_t>(plateau.torque.dropped), dropped)));
  if (std::abs(median_of(used_torques(log, plateau))) >= nearly_nothing * before) return {};
  std::size_t end = plateau.used_from;
  while (std::abs(log.torque[end - 1]) < nearly_nothing * before) --end;  // ends: half of the dropped are larger
  return log.time[end];
}

constexpr double coarse_speed = 0.01;  // of a speed: half a step of the tachometer

std::vector<std::string> plateau_faults(const TorqueLog& log, const Plateau& plateau) {
  std::vector<std::string> words;
  const Unit& unit = log.torque_unit;
  const std::string at = place_of(log, plateau);
  std::vector<double> values = used_torques(log, plateau);
  if (plateau.torque.spikes_out > 0) values = without_spikes(values).series;
  if (values.size() < 20) return words;
  const std::map<double, std::size_t> levels = levels_of(values);
  const auto count = static_cast<double>(values.size());
  const MedianSpread spread = spread_of(values);
  if (levels.size() > 1) {
    for (const bool largest : {false, true}) {
      const Level level = extreme(levels, largest);
      if (levels.size() > coarse_levels && static_cast<double>(level.count) > 0.02 * count && level.count >= 5 &&
          level.count > 3 * level.next)
        words.push_back(
            level.value == 0.0
                ? fmt::format(
                      "{}: {:.0f} % of the samples are exactly 0: the machine or its sensor was off then, so its "
                      "mean is too small",
                      at, 100.0 * static_cast<double>(level.count) / count)
                : fmt::format(
                      "{}: {:.0f} % of the samples are exactly {:.5g} {}, and none lies {}: clipped there, so its "
                      "mean is too {}",
                      at, 100.0 * static_cast<double>(level.count) / count, unit.from_si(level.value), unit.symbol,
                      largest ? "above" : "below", largest ? "small" : "large"));
    }
    std::vector<double> steps;
    for (auto one = levels.begin(); std::next(one) != levels.end(); ++one)
      steps.push_back(std::next(one)->first - one->first);
    const double step = median_of(std::move(steps));
    if (values.size() >= 50 && levels.size() <= std::max<std::size_t>(8, values.size() / 50) &&
        step > 0.5 * plateau.torque.sd)
      words.push_back(fmt::format(
          "{}: the torque takes {} values only, {:.3g} {} apart, the logger's resolution: the mean may be off by "
          "{:.2g} {} beyond its error",
          at, levels.size(), step / unit.factor, unit.symbol, 0.5 * step / unit.factor, unit.symbol));
  }
  if (0.5 * plateau.speed_step > coarse_speed * std::abs(plateau.speed))
    words.push_back(fmt::format("{}: the tachometer counts in steps of {:.3g} {}: the speed may be off by half of one",
                                at, plateau.speed_step / log.speed_unit.factor, log.speed_unit.symbol));
  if (plateau.off_speed > 0.1)
    words.push_back(
        fmt::format("{}: {:.0f} % of the samples lie off that speed by more than the tolerance: the tachometer is "
                    "coarse or the speed "
                    "swings, and the speed is the mean of all",
                    at, 100.0 * plateau.off_speed));
  if (const auto [from, to] = idle_part(values); to > from)
    words.push_back(
        fmt::format("{}: the torque falls to nearly nothing from {:.4g} to {:.4g} s: where the machine stood "
                    "still, leave that out (--window FROM TO)",
                    at, log.time[plateau.used_from + from], log.time[plateau.used_from + to - 1]));
  std::vector<std::size_t> spikes;
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool spike = spread.sd > 0.0 && std::abs(values[i] - spread.median) > 8.0 * spread.sd;
    if (spike) spikes.push_back(i);
    if (!spike) sum += values[i];
  }
  if (const auto number = static_cast<double>(spikes.size()); number > 0.0 && number < 0.2 * count) {
    const bool one = spikes.size() == 1;
    words.push_back(fmt::format(
        "{}: {}, count{} in the mean {:.4g}, which is {:.4g} without {}: if {} no torque, leave {} out "
        "(--without-spikes)",
        at, spikes_in_words(log, plateau, spikes, spread.median), one ? "s" : "", unit.from_si(plateau.torque.mean),
        unit.from_si(sum / (count - number)), one ? "it" : "them", one ? "it is" : "they are", one ? "it" : "them"));
  }
  if (const double change = drift(values); spikes.empty() && std::abs(change) > 2.0 * plateau.torque.standard_error)
    words.push_back(
        fmt::format("{}: the torque drifts by {:.3g} {} from the beginning of what is used to its end: the error does "
                    "not cover that",
                    at, change / unit.factor, unit.symbol));
  return words;
}

std::vector<std::string> plateau_notes(const TorqueLog& log, const Plateau& plateau) {
  std::vector<std::string> words;
  const Unit& unit = log.torque_unit;
  const std::vector<double> values = used_torques(log, plateau);
  if (plateau.torque.spikes_out > 0) {
    const std::vector<std::size_t> spikes = without_spikes(values).spikes;
    double mean = 0.0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    if (!spikes.empty())
      words.push_back(fmt::format("{}: {}, left out of the mean {:.4g}, which is {:.4g} with {}",
                                  place_of(log, plateau), spikes_in_words(log, plateau, spikes, median_of(values)),
                                  unit.from_si(plateau.torque.mean), unit.from_si(mean),
                                  spikes.size() == 1 ? "it" : "them"));
  }
  const std::size_t from = plateau.used_from - plateau.torque.dropped;  // behind the dead time
  const double hold = log.time[plateau.first + plateau.count - 1] - log.time[plateau.first];
  const double out = log.time[plateau.used_from] - log.time[from];
  if (out > long_start_up * hold) {
    double head = 0.0;
    for (std::size_t i = from; i < plateau.used_from; ++i)
      head += log.torque[i] / static_cast<double>(plateau.torque.dropped);
    const bool differs = std::abs(head - plateau.torque.mean) > 3.0 * plateau.torque.standard_error;
    words.push_back(
        fmt::format("{}: the first {:.3g} s of {:.3g} s are left out as start-up, as {}; if it is none, cut out "
                    "what is right with --window",
                    place_of(log, plateau), out, hold,
                    differs ? fmt::format("the torque is {:.4g} {} there and {:.4g} after", unit.from_si(head),
                                          unit.symbol, unit.from_si(plateau.torque.mean))
                            : "the torque scatters more there"));
  }
  return words;
}

}  // namespace data
