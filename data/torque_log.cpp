// Plateaus. A sample belongs to the running plateau while its speed lies within the tolerance of the plateau's mean so
// far. A few samples further away (`lone` of them, or a twentieth of a second) are a logger's dropouts. They stay in
// the torque series, whose even spacing the autocorrelation needs. More in a row end the plateau. A gap in time, where
// a logger lost samples, ends it where another plateau could have been in it: from the shortest one's length on.
#include "data/torque_log.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>

#include "data/cosine_modes.hpp"
#include "data/steadiness.hpp"
#include "data/time_series.hpp"

namespace data {
namespace {

constexpr std::size_t lone = 4;
constexpr double lone_time = 0.05;  // s; no mixer changes its speed and comes back in that

/// Samples in a row that may lie off a plateau's speed.
std::size_t drop_outs(const TorqueLog& log) {
  if (!(log.interval > 0.0)) return lone;
  return std::max(lone, static_cast<std::size_t>(lone_time / log.interval));
}

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
    const bool adjoins = second.first - (first.first + first.count) <= drop_outs(log);
    if (plateaus[from].ramp && adjoins && ratio > 0.5 && ratio < 2.0 && trends[to].change > 2.0 * trends[to].scatter)
      plateaus[to].ramp = true;
  };
  for (std::size_t k = 1; k < plateaus.size(); ++k) goes_on(k - 1, k);
  for (std::size_t k = plateaus.size(); k-- > 1;) goes_on(k, k - 1);
}

/// The step in which the tachometer counts, or 0: every difference between speeds of the log is a multiple of it. A
/// column of wanted speeds has no more values than holds; a tachometer has others in the ramps between them.
double tachometer_step(const TorqueLog& log, std::size_t holds) {
  constexpr std::size_t most = 1000;  // values; more are no steps
  std::set<double> values;
  for (const double speed : log.speed) {
    values.insert(speed);
    if (values.size() > most) return 0.0;
  }
  if (values.size() < 2 * holds + 4) return 0.0;
  double step = HUGE_VAL;
  for (auto one = values.begin(); std::next(one) != values.end(); ++one) step = std::min(step, *std::next(one) - *one);
  const bool multiples = std::all_of(values.begin(), values.end(), [&](double speed) {
    const double steps = (speed - *values.begin()) / step;
    return std::abs(steps - std::round(steps)) < 0.1;
  });
  return multiples ? step : 0.0;
}

/// Mean and sd of the speed over what is used. Single dropouts count in neither. Where many samples lie off, the
/// tachometer is coarse or the speed swings, and all of them count.
void set_speed(const TorqueLog& log, Plateau& plateau, double tolerance) {
  constexpr double many = 0.1;
  const auto gather = [&](bool all) {
    std::vector<double> speeds;
    for (std::size_t i = plateau.used_from; i < plateau.first + plateau.count; ++i)
      if (all || std::abs(log.speed[i] - plateau.speed) <= tolerance * std::abs(plateau.speed))
        speeds.push_back(log.speed[i]);
    return speeds;
  };
  std::vector<double> speeds = gather(false);
  const auto used = static_cast<double>(plateau.first + plateau.count - plateau.used_from);
  plateau.off_speed = 1.0 - static_cast<double>(speeds.size()) / used;
  if (plateau.off_speed > many) speeds = gather(true);
  if (speeds.empty()) return;
  double sum = 0.0, squares = 0.0;
  for (const double speed : speeds) {
    sum += speed - plateau.speed;
    squares += (speed - plateau.speed) * (speed - plateau.speed);
  }
  const auto members = static_cast<double>(speeds.size());
  plateau.speed += sum / members;
  if (members > 1.0) plateau.speed_sd = std::sqrt(std::max(0.0, squares - sum * sum / members) / (members - 1.0));
}

/// The torque of samples at even steps of time, of the log's interval: the mean over each step, where a sample stands
/// until the next one. That is what a log of changes means, and of a log read at uneven times it gives no sample more
/// weight than its time.
std::vector<double> at_even_steps(const TorqueLog& log, std::size_t first, std::size_t count) {
  constexpr double most = 1e6;
  const double start = log.time[first], end = log.time[first + count - 1] + log.interval;
  const auto steps = static_cast<std::size_t>(std::clamp((end - start) / log.interval, 1.0, most));
  const double step = (end - start) / static_cast<double>(steps);
  std::vector<double> means(steps, 0.0);
  for (std::size_t i = first; i < first + count; ++i) {
    const double from = log.time[i] - start, to = (i + 1 < first + count ? log.time[i + 1] : end) - start;
    for (auto k = static_cast<std::size_t>(from / step); k < steps && static_cast<double>(k) * step < to; ++k)
      means[k] += log.torque[i] / step *
                  std::max(0.0, std::min(to, static_cast<double>(k + 1) * step) -
                                    std::max(from, static_cast<double>(k) * step));
  }
  return means;
}

/// Mean and error of the torque of samples, and how many of the first ones are start-up.
SeriesMean mean_of_samples(const TorqueLog& log, std::size_t first, std::size_t count, bool spikes_count) {
  if (!log.uneven() || count < 2) return mean_of_hold({log.torque.data() + first, count}, spikes_count);
  const std::vector<double> even = at_even_steps(log, first, count);
  SeriesMean found = mean_of_hold(even, spikes_count);
  const double last = log.time[first + count - 1] + log.interval - log.time[first];
  const double until = log.time[first] + last * static_cast<double>(found.dropped) / static_cast<double>(even.size());
  const auto begin = log.time.begin() + static_cast<std::ptrdiff_t>(first);
  found.dropped =
      static_cast<std::size_t>(std::lower_bound(begin, begin + static_cast<std::ptrdiff_t>(count) - 1, until) - begin);
  return found;
}

/// Mean and error of a stretch of constant `speed`.
Plateau reduce(const TorqueLog& log, std::size_t first, std::size_t count, double speed,
               const PlateauOptions& options) {
  Plateau plateau{.first = first, .count = count, .used_from = first, .speed = speed};
  while (plateau.used_from < first + count && log.time[plateau.used_from] - log.time[first] < options.dead_time)
    ++plateau.used_from;
  const std::size_t left = first + count - plateau.used_from;
  plateau.torque = mean_of_samples(log, plateau.used_from, left, options.spikes_count);
  plateau.used_from += plateau.torque.dropped;
  set_speed(log, plateau, options.tolerance);
  return plateau;
}

/// Joins plateaus that are one hold. Either nothing but a few samples parts two of the same speed, as of a coarse
/// tachometer; or the speed goes up and down between short neighbours, three times or more, about one mean.
void join_swings(const TorqueLog& log, std::vector<Plateau>& plateaus, const PlateauOptions& options) {
  constexpr std::size_t few_samples = 8;
  constexpr double few_seconds = 1.0;
  const auto length = [&](const Plateau& p) { return log.time[p.first + p.count - 1] - log.time[p.first]; };
  const auto gap = [&](std::size_t k) {
    return log.time[plateaus[k].first] - log.time[plateaus[k - 1].first + plateaus[k - 1].count - 1];
  };
  const auto step = [&](std::size_t k) { return plateaus[k].speed - plateaus[k - 1].speed; };
  const auto within = [&](std::size_t k, double tolerances) {
    return std::abs(step(k)) <= tolerances * options.tolerance * std::abs(plateaus[k - 1].speed);
  };
  const auto same = [&](std::size_t k) {
    return within(k, 1.0) && gap(k) <= std::max(few_seconds, static_cast<double>(few_samples) * log.interval);
  };
  const auto swings = [&](std::size_t k, std::size_t from) {
    return within(k, 4.0) && gap(k) <= options.shortest && length(plateaus[k]) < 4.0 * options.shortest &&
           length(plateaus[k - 1]) < 4.0 * options.shortest && (k == from + 1 || step(k) * step(k - 1) < 0.0);
  };
  std::vector<Plateau> joined;
  for (std::size_t k = 0, end = 0; k < plateaus.size(); k = end) {
    end = k + 1;
    while (end < plateaus.size() && same(end)) ++end;
    if (end == k + 1) {
      while (end < plateaus.size() && swings(end, k)) ++end;
      if (end - k < 3) end = k + 1;
    }
    if (end == k + 1) {
      joined.push_back(plateaus[k]);
      continue;
    }
    const std::size_t first = plateaus[k].first, last = plateaus[end - 1].first + plateaus[end - 1].count - 1;
    double sum = 0.0;
    for (std::size_t i = first; i <= last; ++i) sum += log.speed[i];
    joined.push_back(reduce(log, first, last - first + 1, sum / static_cast<double>(last - first + 1), options));
  }
  plateaus = std::move(joined);
}

/// Whether the autocorrelation swings to the other side once it has come to zero, as that of a hum does. It is looked
/// at through some thousand products a lag and some dozens of lags a doubling, so that long logs take no time.
bool swings_back(std::span<const double> series) {
  constexpr double clearly = -0.1, products = 3989.0;
  const std::size_t n = series.size(), most = n / 10;
  double mean = 0.0;
  for (const double value : series) mean += value / static_cast<double>(n);
  const auto product = [&](std::size_t lag) {
    const double step = std::max(1.0, static_cast<double>(n - lag) / products);
    double sum = 0.0, count = 0.0;
    for (double at = 0.0; at < static_cast<double>(n - lag); at += step, count += 1.0) {
      const auto i = static_cast<std::size_t>(at);
      sum += (series[i] - mean) * (series[i + lag] - mean);
    }
    return sum / count;
  };
  const auto next = [](std::size_t lag) { return lag + std::max<std::size_t>(1, lag / 32); };
  const double variance = product(0);
  std::size_t zero = 1;
  while (zero < most && product(zero) > 0.0) zero = next(zero);
  for (std::size_t lag = zero; lag < std::min(3 * zero + 1, most); lag = next(lag))
    if (product(lag) < clearly * variance) return true;
  return false;
}

/// Whether the slowest modes have clearly more power than the integrated time says that they have: Sokal's window has
/// closed on fast noise. Their mean power over the stated one follows chi-square's law over its degrees of freedom
/// where it has not; one in thirty series of white noise passes one of these limits, and fewer where it is correlated.
bool wanders(std::span<const double> series, const SeriesMean& stated) {
  struct Limit {
    std::size_t modes;
    double ratio;
  };
  constexpr std::array limits{Limit{8, 2.5}, Limit{16, 2.0}, Limit{32, 1.65}, Limit{64, 1.45}};
  const auto n = static_cast<double>(series.size());
  const std::vector<double> c = cosine_modes(series, stated.mean, limits.back().modes);
  const double each = stated.sd * stated.sd * stated.integrated_time;  // n times the mean's variance
  return std::any_of(limits.begin(), limits.end(), [&](const Limit& limit) {
    double power = 0.0;
    for (std::size_t j = 0; j < limit.modes; ++j) power += n * c[j] * c[j] / static_cast<double>(limit.modes);
    return power > limit.ratio * each;
  });
}

}  // namespace

SeriesMean mean_of_hold(std::span<const double> torque, bool spikes_count) {
  constexpr double few = 60.0;
  SeriesMean found = mean_with_error(torque, {.spikes_count = spikes_count});
  if (found.sd == 0.0) return found;
  const std::span<const double> rest = torque.subspan(found.dropped);
  const std::vector<double> without = spikes_count ? std::vector<double>() : without_spikes(rest).series;
  const std::span<const double> used = spikes_count ? rest : std::span<const double>(without);
  const bool wander = wanders(used, found);
  if (!(found.effective_samples < few) && !wander && !swings_back(used)) return found;
  const SeriesMean slow = steadiness(used, {.fast_noise = true}).mean;
  if (wander && !slow.reliable) found.reliable = false;
  // Where it is not known, what it states is the least that the error is.
  if (!(slow.standard_error > (slow.reliable ? 0.0 : found.standard_error))) return found;
  found.standard_error = slow.standard_error;
  found.integrated_time = slow.integrated_time;
  found.effective_samples = slow.effective_samples;
  return found;
}

double standstill_speed(const TorqueLog& log) {
  if (log.speed.empty()) return 0.0;
  // The largest speed but for spikes of the tachometer.
  std::vector<double> sizes;
  for (const double speed : log.speed) sizes.push_back(std::abs(speed));
  const auto fast = sizes.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), fast, sizes.end());
  const double fastest = *fast;
  // The tachometer's scatter where the machine hardly moves, from one sample to the next.
  std::vector<double> steps;
  for (std::size_t i = 1; i < log.speed.size(); ++i)
    if (std::max(std::abs(log.speed[i]), std::abs(log.speed[i - 1])) <= 0.01 * fastest)
      steps.push_back(std::abs(log.speed[i] - log.speed[i - 1]));
  const double scatter = steps.empty() ? 0.0 : sd_of_median_deviation / std::sqrt(2.0) * median_of(std::move(steps));
  return std::clamp(5.0 * scatter, 0.002 * fastest, 0.01 * fastest);
}

std::vector<Plateau> find_plateaus(const TorqueLog& log, const PlateauOptions& options) {
  std::vector<Plateau> found = find_stretches(log, options);
  std::erase_if(found, [](const Plateau& plateau) { return plateau.ramp; });
  return found;
}

std::vector<Plateau> find_stretches(const TorqueLog& log, const PlateauOptions& options) {
  const double standstill = standstill_speed(log);
  const std::size_t few = drop_outs(log);
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
    for (std::size_t i = first + 1; i < n && i - last <= few && inside(i); ++i) {
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
    // A hold may begin within a ramp. Its front is found to a sixty-fourth of the ramp's piece, and long logs in no
    // time.
    first = !turning || long_enough ? last + 1 : first + std::max<std::size_t>(1, (last - first) / 64);
  }
  join_swings(log, plateaus, options);
  mark_ramps(log, plateaus, options.tolerance);
  const double step = tachometer_step(log, plateaus.size());
  for (Plateau& plateau : plateaus) {
    plateau.speed_step = step;
    plateau.speed_sd = std::hypot(plateau.speed_sd, step / std::sqrt(12.0));  // a value within the step may be any
  }
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
