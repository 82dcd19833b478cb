// Plateaus. A sample belongs to the running plateau while its speed lies within the tolerance of the plateau's mean so
// far. One to `lone` samples further away are a logger's dropouts and stay in the torque series, whose even spacing the
// autocorrelation needs; more in a row end the plateau. A gap in time, where a logger lost samples, ends it where another
// plateau could have been in it: from the shortest one's length on.
#include "data/torque_log.hpp"

#include <algorithm>
#include <cmath>

#include "data/steadiness.hpp"

namespace data {
namespace {

constexpr std::size_t lone = 4;

/// The straight line through a stretch's speeds.
struct Trend {
  double slope = 0.0;    ///< rad/s2
  double change = 0.0;   ///< rad/s, over the stretch
  double scatter = 0.0;  ///< rad/s, of the samples around it
};

Trend trend_of(const TorqueLog& log, const Plateau& plateau, double tolerance) {
  double count = 0.0, time = 0.0, speed = 0.0;
  const auto each = [&](auto visit) {
    for (std::size_t i = plateau.first; i < plateau.first + plateau.count; ++i)
      if (std::abs(log.speed[i] - plateau.speed) <= 3.0 * tolerance * std::abs(plateau.speed))
        visit(log.time[i], log.speed[i]);
  };
  each([&](double t, double w) {
    count += 1.0;
    time += t;
    speed += w;
  });
  if (count < 3.0) return {};
  time /= count;
  speed /= count;
  double tt = 0.0, tw = 0.0, ww = 0.0;
  each([&](double t, double w) {
    tt += (t - time) * (t - time);
    tw += (t - time) * (w - speed);
    ww += (w - speed) * (w - speed);
  });
  const double duration = log.time[plateau.first + plateau.count - 1] - log.time[plateau.first];
  return {tw / tt, std::abs(tw / tt) * duration, std::sqrt(std::max(0.0, ww - tw * tw / tt) / count)};
}

/// Marks the pieces of slow ramps: the speed changes steadily, by over half the width that the tolerance allows and
/// well beyond the scatter. What adjoins such a piece and goes on at its rate is the ramp's end.
void mark_ramps(const TorqueLog& log, std::vector<Plateau>& plateaus, double tolerance) {
  std::vector<Trend> trends;
  for (Plateau& plateau : plateaus) {
    trends.push_back(trend_of(log, plateau, tolerance));
    plateau.ramp = trends.back().change > tolerance * std::abs(plateau.speed) &&
                   trends.back().change > 4.0 * trends.back().scatter;
  }
  const auto goes_on = [&](std::size_t from, std::size_t to) {
    const double ratio = trends[to].slope / trends[from].slope;
    const Plateau &first = plateaus[std::min(from, to)], &second = plateaus[std::max(from, to)];
    const bool adjoins = second.first - (first.first + first.count) <= lone;
    if (plateaus[from].ramp && adjoins && ratio > 0.5 && ratio < 2.0 && trends[to].change > 2.0 * trends[to].scatter)
      plateaus[to].ramp = true;
  };
  for (std::size_t k = 1; k < plateaus.size(); ++k) goes_on(k - 1, k);
  for (std::size_t k = plateaus.size(); k-- > 1;) goes_on(k, k - 1);
}

/// Mean and error of a stretch of constant `speed`.
Plateau reduce(const TorqueLog& log, std::size_t first, std::size_t count, double speed,
               const PlateauOptions& options) {
  Plateau plateau{.first = first, .count = count, .used_from = first, .speed = speed};
  while (plateau.used_from < first + count && log.time[plateau.used_from] - log.time[first] < options.dead_time)
    ++plateau.used_from;
  const std::size_t left = first + count - plateau.used_from;
  plateau.torque = mean_of_hold({log.torque.data() + plateau.used_from, left}, options.spikes_count);
  plateau.used_from += plateau.torque.dropped;
  // Dropouts count in neither the speed nor its sd.
  double sum = 0.0, squares = 0.0, members = 0.0;
  for (std::size_t i = plateau.used_from; i < first + count; ++i) {
    if (std::abs(log.speed[i] - speed) > options.tolerance * std::abs(speed)) continue;
    sum += log.speed[i] - speed;
    squares += (log.speed[i] - speed) * (log.speed[i] - speed);
    members += 1.0;
  }
  if (members > 0.0) plateau.speed = speed + sum / members;
  if (members > 1.0) plateau.speed_sd = std::sqrt(std::max(0.0, squares - sum * sum / members) / (members - 1.0));
  return plateau;
}

}  // namespace

SeriesMean mean_of_hold(std::span<const double> torque, bool spikes_count) {
  constexpr double few = 60.0;
  SeriesMean found = mean_with_error(torque, {.spikes_count = spikes_count});
  if (!(found.effective_samples < few)) return found;
  const std::span<const double> rest = torque.subspan(found.dropped);
  const SeriesMean slow = steadiness(spikes_count ? rest : std::span<const double>(without_spikes(rest).series)).mean;
  if (!slow.reliable || !(slow.standard_error > 0.0)) return found;
  found.standard_error = slow.standard_error;
  found.integrated_time = slow.integrated_time;
  found.effective_samples = slow.effective_samples;
  return found;
}

double standstill_speed(const TorqueLog& log) {
  double fastest = 0.0;
  for (const double speed : log.speed) fastest = std::max(fastest, std::abs(speed));
  return 0.01 * fastest;
}

std::vector<Plateau> find_plateaus(const TorqueLog& log, const PlateauOptions& options) {
  std::vector<Plateau> found = find_stretches(log, options);
  std::erase_if(found, [](const Plateau& plateau) { return plateau.ramp; });
  return found;
}

std::vector<Plateau> find_stretches(const TorqueLog& log, const PlateauOptions& options) {
  const double standstill = standstill_speed(log);
  const auto inside = [&](std::size_t i) { return log.time[i] >= options.from && log.time[i] <= options.to; };

  std::vector<Plateau> plateaus;
  const std::size_t n = log.time.size();
  std::size_t first = 0;
  while (first < n) {
    if (!inside(first)) {
      ++first;
      continue;
    }
    double sum = log.speed[first];
    std::size_t members = 1, last = first;
    for (std::size_t i = first + 1; i < n && i - last <= lone && inside(i); ++i) {
      if (log.time[i] - log.time[i - 1] > std::max(static_cast<double>(lone) * log.interval, options.shortest)) break;
      const double mean = sum / static_cast<double>(members);
      if (std::abs(log.speed[i] - mean) > options.tolerance * std::abs(mean)) continue;
      sum += log.speed[i];
      ++members;
      last = i;
    }
    const double mean = sum / static_cast<double>(members);
    const bool turning = std::abs(mean) > standstill;
    const bool long_enough = log.time[last] - log.time[first] >= std::max(options.shortest, options.dead_time);
    if (turning && long_enough && last > first) {
      const Plateau plateau = reduce(log, first, last - first + 1, mean, options);
      if (plateau.used_from <= last) plateaus.push_back(plateau);
    }
    first = !turning || long_enough ? last + 1 : first + 1;
  }
  mark_ramps(log, plateaus, options.tolerance);
  return plateaus;
}

std::optional<MeanTorque> idle_at(const std::vector<Plateau>& idle, double speed, double tolerance) {
  double weight = 0.0, sum = 0.0, plain = 0.0, exact = 0.0;
  for (const Plateau& plateau : idle) {
    if (std::abs(plateau.speed - speed) > tolerance * std::abs(speed)) continue;
    if (const double error = plateau.torque.standard_error; error > 0.0) {
      weight += 1.0 / (error * error);
      sum += plateau.torque.mean / (error * error);
    } else {
      exact += 1.0;
      plain += plateau.torque.mean;
    }
  }
  if (exact > 0.0) return MeanTorque{plain / exact, 0.0};
  if (weight > 0.0) return MeanTorque{sum / weight, 1.0 / std::sqrt(weight)};
  return std::nullopt;
}

}  // namespace data
