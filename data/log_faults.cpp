// What is odd in a plateau (log_faults.hpp).
#include "data/log_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace data {
namespace {

/// A torque of so few values says nothing of a limit: the logger is coarse.
constexpr std::size_t coarse_levels = 3;

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
  const double error = std::sqrt(12.0) * mean_of_hold(rest).standard_error;
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

namespace {

/// A plateau and what is known of the torques that its mean is of.
struct Used {
  const TorqueLog& log;
  const Plateau& plateau;
  std::string at;              ///< place_of
  std::vector<double> values;  ///< N m, spikes that are left out replaced
  std::map<double, std::size_t> levels;

  double count() const { return static_cast<double>(values.size()); }
};

/// More samples at an end of the range than beside it: a limit, or a machine that was off.
std::vector<std::string> limits_in_words(const Used& used) {
  std::vector<std::string> words;
  if (used.levels.size() <= coarse_levels) return words;
  const Unit& unit = used.log.torque_unit;
  for (const bool largest : {false, true}) {
    const Level level = extreme(used.levels, largest);
    if (!(static_cast<double>(level.count) > 0.02 * used.count() && level.count >= 5 && level.count > 3 * level.next))
      continue;
    words.push_back(
        level.value == 0.0
            ? fmt::format("{}: {:.0f} % of the samples are exactly 0: the machine or its sensor was off then, so its "
                          "mean is too small",
                          used.at, 100.0 * static_cast<double>(level.count) / used.count())
            : fmt::format("{}: {:.0f} % of the samples are exactly {:.5g} {}, and none lies {}: clipped there, so its "
                          "mean is too {}",
                          used.at, 100.0 * static_cast<double>(level.count) / used.count(), unit.from_si(level.value),
                          unit.symbol, largest ? "above" : "below", largest ? "small" : "large"));
  }
  return words;
}

/// So few values that the logger's resolution moves the mean; empty where they are more.
std::string resolution_in_words(const Used& used) {
  const std::size_t samples = used.values.size();
  if (used.levels.size() < 2 || samples < 50 || used.levels.size() > std::max<std::size_t>(8, samples / 50)) return "";
  std::vector<double> steps;
  for (auto one = used.levels.begin(); std::next(one) != used.levels.end(); ++one)
    steps.push_back(std::next(one)->first - one->first);
  const double step = median_of(std::move(steps));
  if (!(step > 0.5 * used.plateau.torque.sd)) return "";
  const Unit& unit = used.log.torque_unit;
  return fmt::format(
      "{}: the torque takes {} values only, {:.3g} {} apart, the logger's resolution: the mean may be off by "
      "{:.2g} {} beyond its error",
      used.at, used.levels.size(), step / unit.factor, unit.symbol, 0.5 * step / unit.factor, unit.symbol);
}

/// What the speed is not known by.
std::vector<std::string> speed_in_words(const Used& used) {
  std::vector<std::string> words;
  const Plateau& plateau = used.plateau;
  const Unit& unit = used.log.speed_unit;
  if (0.5 * plateau.speed_step > coarse_speed * std::abs(plateau.speed))
    words.push_back(fmt::format("{}: the tachometer counts in steps of {:.3g} {}: the speed may be off by half of one",
                                used.at, plateau.speed_step / unit.factor, unit.symbol));
  if (plateau.off_speed > 0.1)
    words.push_back(
        fmt::format("{}: {:.0f} % of the samples lie off that speed by more than the tolerance: the tachometer is "
                    "coarse or the speed swings, and the speed is the mean of all",
                    used.at, 100.0 * plateau.off_speed));
  return words;
}

/// A while in which the machine stood still; empty where there is none.
std::string idle_in_words(const Used& used) {
  const auto [from, to] = idle_part(used.values);
  if (to <= from) return "";
  const std::size_t first = used.plateau.used_from;
  return fmt::format(
      "{}: the torque falls to nearly nothing from {:.4g} to {:.4g} s: where the machine stood still, leave that out "
      "(--window FROM TO)",
      used.at, used.log.time[first + from], used.log.time[first + to - 1]);
}

/// A while in which the torque stays at one value amid samples that change: a sensor or a logger that was stuck. Runs
/// of equal samples are about geometric in length where the logger is coarse or repeats its samples, of n runs of mean
/// m the longest about m log n; one of m (log n + 10) comes of itself once in 20,000 logs.
std::string stuck_in_words(const Used& used) {
  std::size_t runs = 1, longest = 0, longest_at = 0, from = 0;
  const std::size_t count = used.values.size();
  for (std::size_t i = 1; i <= count; ++i) {
    if (i < count && used.values[i] == used.values[i - 1]) continue;
    if (i - from > longest) longest = i - from, longest_at = from;
    if (i < count) ++runs;
    from = i;
  }
  if (runs < 10 || longest < 20) return "";
  const double mean = static_cast<double>(count - longest) / static_cast<double>(runs - 1);
  if (!(static_cast<double>(longest) > mean * (std::log(static_cast<double>(runs)) + 10.0))) return "";
  const Unit& unit = used.log.torque_unit;
  const std::size_t first = used.plateau.used_from + longest_at;
  return fmt::format(
      "{}: the torque stays at {:.5g} {} from {:.4g} to {:.4g} s, {:.0f} % of the samples, and changes before and after: "
      "a sensor or logger that was stuck (cut these lines out of the log)",
      used.at, unit.from_si(used.log.torque[first]), unit.symbol, used.log.time[first],
      used.log.time[first + longest - 1], 100.0 * static_cast<double>(longest) / used.count());
}

/// Samples farther than eight sd from the median.
std::vector<std::size_t> spikes_of(const std::vector<double>& values, const MedianSpread& spread) {
  std::vector<std::size_t> spikes;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (spread.sd > 0.0 && std::abs(values[i] - spread.median) > 8.0 * spread.sd) spikes.push_back(i);
  return spikes;
}

/// What the spikes do to the mean; empty where there are none, or so many that they are no spikes.
std::string spikes_counted_in_words(const Used& used, const std::vector<std::size_t>& spikes, double usual) {
  const auto number = static_cast<double>(spikes.size());
  if (!(number > 0.0 && number < 0.2 * used.count())) return "";
  double others = 0.0;
  for (std::size_t i = 0; i < used.values.size(); ++i)
    if (!std::binary_search(spikes.begin(), spikes.end(), i)) others += used.values[i];
  const Unit& unit = used.log.torque_unit;
  const bool one = spikes.size() == 1;
  return fmt::format(
      "{}: {}, count{} in the mean {:.4g}, which is {:.4g} without {}: if {} no torque, leave {} out "
      "(--without-spikes)",
      used.at, spikes_in_words(used.log, used.plateau, spikes, usual), one ? "s" : "",
      unit.from_si(used.plateau.torque.mean), unit.from_si(others / (used.count() - number)), one ? "it" : "them",
      one ? "it is" : "they are", one ? "it" : "them");
}

/// A drift that the error does not cover; empty where there is none.
std::string drift_in_words(const Used& used) {
  const double change = drift(used.values);
  if (!(std::abs(change) > 2.0 * used.plateau.torque.standard_error)) return "";
  const Unit& unit = used.log.torque_unit;
  return fmt::format(
      "{}: the torque drifts by {:.3g} {} from the beginning of what is used to its end: the error does not cover that",
      used.at, change / unit.factor, unit.symbol);
}

}  // namespace

std::vector<std::string> plateau_faults(const TorqueLog& log, const Plateau& plateau) {
  std::vector<double> values = used_torques(log, plateau);
  if (plateau.torque.spikes_out > 0) values = without_spikes(values).series;
  constexpr std::size_t fewest = 20;
  if (values.size() < fewest) return {};
  const MedianSpread spread = spread_of(values);
  const std::vector<std::size_t> spikes = spikes_of(values, spread);
  std::map<double, std::size_t> levels = levels_of(values);
  const Used used{log, plateau, place_of(log, plateau), std::move(values), std::move(levels)};

  std::vector<std::string> words = limits_in_words(used);
  if (words.empty()) words.push_back(stuck_in_words(used));
  words.push_back(resolution_in_words(used));
  for (std::string& one : speed_in_words(used)) words.push_back(std::move(one));
  words.push_back(idle_in_words(used));
  words.push_back(spikes_counted_in_words(used, spikes, spread.median));
  if (spikes.empty()) words.push_back(drift_in_words(used));
  std::erase(words, "");
  return words;
}

std::optional<Problem> doubted_columns(const TorqueLog& log) {
  constexpr double standing = 1e-3;  // rad/s, a hundredth of a turn a minute
  if (std::all_of(log.speed.begin(), log.speed.end(), [](double speed) { return std::abs(speed) < standing; }))
    return Problem{log.file, "the speed is 0 throughout: the machine stood still, or nothing was read into that column",
                   "name the column of the speed with --rpm, or take the column out and give a constant speed with "
                   "--constant-speed"};
  const auto different = [](const std::vector<double>& values) {
    return std::set<double>(values.begin(), values.end()).size();
  };
  constexpr std::size_t few = 20, many_times = 10;
  const std::size_t torques = different(log.torque), speeds = different(log.speed);
  if (torques < 2 || torques > few || speeds < many_times * torques) return {};
  return Problem{
      log.file,
      fmt::format("the torque takes {} values and the speed {}: are the two columns exchanged?", torques, speeds),
      "correct the headings, or name the columns with --torque and --rpm"};
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
