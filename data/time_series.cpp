// The mean of a correlated, possibly not yet stationary series x_1 ... x_n, and its standard error.
//
// Start-up. MSER-5: K. P. White, "An effective truncation heuristic for bias reduction in simulation output",
// Simulation 69 (1997) 323. With Z_j the means of 5 consecutive samples, drop the first d of the b batches for which
//   MSER(d) = sum_{j > d} (Z_j - mean)^2 / (b - d)^2
// is smallest. Deviation: the minimum of a stationary series is often at some d > 0 by chance, so the d batches are
// dropped only when their own mean differs from the mean of the rest by more than `start_up_significance` standard
// errors, and they die away towards the rest or lie outside of its fluctuations: a slow fluctuation, of which the rest
// has seen too little to know its errors, does neither. Or, for a start-up whose mean happens to agree, when their
// variance is that of another process (over four times the rest's). In both cases most of them must be away, as medians
// tell: rare bursts, of which the first batches have more by chance, are part of a stationary series. Otherwise
// everything is kept.
//
// Spikes. One sample S standard deviations away would have the batches before it dropped, as long as they are fewer
// than S^2 / 3 samples, and hide a true start-up behind the variance that it adds. So the start is chosen in the series
// without its spikes, by Hampel's rule (F. R. Hampel, J. Am. Stat. Assoc. 69 (1974) 383; as a filter L. Davies,
// U. Gather, ibid. 88 (1993) 782): with m_i the median of the 2 h + 1 samples around i, x_i is a spike and
// replaced by m_i where
//   |x_i - m_i| > 8 max(s_i, s),  s_i = 1.4826 median |x - m_i| of these samples,  s = 1.4826 median_i |x_i - m_i|
// h is 10 samples, in a long series 1/200 of it and at most 100: a spike has up to h samples, a start-up more. Spikes
// that a series begins with are its start-up. In a coarse logger's series, where s is 0, the step takes its place.
//
// Error. var(mean) = sd^2 tau / n with tau = 1 + 2 sum_{t=1..M} rho(t), rho the autocorrelation function.
// A. Sokal, "Monte Carlo methods in statistical mechanics" (1996), section 3: M is the smallest with M >= c tau_int(M),
// in his convention tau_int = tau / 2. U. Wolff, Comput. Phys. Commun. 156 (2004) 143, eq. (49): subtracting the
// sample's own mean biases rho by about -tau / n, undone to leading order by the factor 1 + (2 M + 1) / n. Deviation:
// tau >= 1, so that a chance negative correlation never claims a better error than independent samples have. Where M
// passes 1000, tau is taken from means of 5 consecutive samples: H. Flyvbjerg, H. G. Petersen, J. Chem. Phys. 91 (1989)
// 461, whose blocking leaves the variance of the mean as it is.
#include "data/time_series.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

namespace data {
namespace {

constexpr std::size_t batch = 5;
constexpr std::size_t window_max = 1000;  // samples
constexpr double start_up_significance = 3.0;
constexpr double outside_fluctuations = 3.0;  // standard deviations of a sample
constexpr double dying_away = 2.0;            // the deviation of the first third over that of the last one
constexpr double no_bursts = 0.2;             // of the head's deviation, that of its median; less is a few bursts'
constexpr double spike_distance = 8.0;        // robust standard deviations

double mean_of(std::span<const double> x) {
  double sum = 0.0;
  for (const double value : x) sum += value;
  const double first = sum / static_cast<double>(x.size());
  double rest = 0.0;  // second pass: removes the rounding of the first
  for (const double value : x) rest += value - first;
  return first + rest / static_cast<double>(x.size());
}

std::vector<double> batch_means(std::span<const double> x) {
  std::vector<double> z(x.size() / batch);
  for (std::size_t j = 0; j < z.size(); ++j) z[j] = mean_of(x.subspan(j * batch, batch));
  return z;
}

/// Integrated autocorrelation time, in samples, of a series y about its mean, with the sum of its squares. Where the
/// window passes `window_max` the series is replaced by the means of `batch` samples, which have the same variance of
/// their mean, so that the time that it takes grows with the length of the series alone.
double integrated_time(const std::vector<double>& y, double squares, double window_factor) {
  const std::size_t n = y.size();
  double tau = 1.0;
  std::size_t window = 0;
  while (window + 1 < n && static_cast<double>(window) < window_factor * 0.5 * std::max(tau, 1.0)) {
    if (window == window_max && n >= 4 * batch * window_max) {
      const std::vector<double> means = batch_means(y);
      double their_squares = 0.0;
      for (const double value : means) their_squares += value * value;
      return static_cast<double>(n) / squares * their_squares * integrated_time(means, their_squares, window_factor) *
             batch / static_cast<double>(means.size());
    }
    ++window;
    double product = 0.0;
    for (std::size_t i = window; i < n; ++i) product += y[i] * y[i - window];
    tau += 2.0 * product / squares;
  }
  return tau * (1.0 + (2.0 * static_cast<double>(window) + 1.0) / static_cast<double>(n));
}

/// Mean, sd, tau and error of a series taken as stationary.
SeriesMean stationary(std::span<const double> x, const SeriesOptions& options) {
  SeriesMean result;
  const std::size_t n = x.size();
  const auto count = static_cast<double>(n);
  result.mean = mean_of(x);
  std::vector<double> y(n);
  double squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    y[i] = x[i] - result.mean;
    squares += y[i] * y[i];
  }
  result.effective_samples = count;
  if (!std::isfinite(squares) || n < 2) {
    result.standard_error = std::numeric_limits<double>::infinity();
    result.reliable = false;
    return result;
  }
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * std::abs(result.mean);
  if (squares <= count * rounding * rounding) return result;  // a constant series: its mean is exact

  result.sd = std::sqrt(squares / (count - 1.0));
  const double tau = std::max(1.0, integrated_time(y, squares, options.window_factor));
  result.integrated_time = tau;
  result.effective_samples = count / tau;
  result.standard_error = result.sd * std::sqrt(tau / count);
  result.reliable = count >= 20.0 * tau;
  return result;
}

/// The sorted window of 2 h + 1 samples around each, at the ends the first or last ones; calls use(i, window).
template <class Use>
void sorted_windows(std::span<const double> x, std::size_t half, Use use) {
  const std::size_t width = std::min(x.size(), 2 * half + 1);
  std::vector<double> window(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(width));
  std::sort(window.begin(), window.end());
  std::size_t first = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i > first + half && first + width < x.size()) {
      window.erase(std::lower_bound(window.begin(), window.end(), x[first]));
      const double next = x[first + width];
      window.insert(std::upper_bound(window.begin(), window.end(), next), next);
      ++first;
    }
    use(i, window);
  }
}

/// The median absolute deviation of sorted values from their median: outwards from the middle, half of them.
double median_deviation(const std::vector<double>& sorted) {
  const std::size_t n = sorted.size(), middle = n / 2;
  std::size_t low = middle, high = middle + 1;  // of values[low ...high) all are seen
  double farthest = 0.0;
  while (high - low <= n / 2) {
    const double below = low > 0 ? sorted[middle] - sorted[low - 1] : std::numeric_limits<double>::infinity();
    const double above = high < n ? sorted[high] - sorted[middle] : std::numeric_limits<double>::infinity();
    farthest = std::min(below, above);
    below <= above ? static_cast<void>(--low) : static_cast<void>(++high);
  }
  return farthest;
}

/// Number of batches that MSER drops, at most `most`.
std::size_t mser(const std::vector<double>& z, std::size_t most) {
  const double centre = mean_of(z);
  double sum = 0.0, squares = 0.0, best = std::numeric_limits<double>::infinity();
  std::size_t best_start = 0;
  for (std::size_t start = z.size(); start-- > 0;) {  // sums over z[start ...] grow towards the front
    const double value = z[start] - centre;
    sum += value;
    squares += value * value;
    if (start > most) continue;
    const auto left = static_cast<double>(z.size() - start);
    const double statistic = std::max(0.0, squares - sum * sum / left) / (left * left);
    if (statistic <= best) {
      best = statistic;
      best_start = start;
    }
  }
  return best_start;
}

/// Whether the deviation of the head from `level` is much larger at its beginning than at its end.
bool dies_away(std::span<const double> head, double level) {
  const std::size_t third = head.size() / 3;
  if (third == 0) return true;
  const double first = mean_of(head.first(third)) - level, last = mean_of(head.last(third)) - level;
  return std::abs(first) > dying_away * std::abs(last);
}

/// Median distance from a level.
double median_distance(std::span<const double> x, double level) {
  std::vector<double> away;
  for (const double value : x) away.push_back(std::abs(value - level));
  return median_of(std::move(away));
}

/// Whether the first `d` samples belong to another process than the rest.
bool is_start_up(std::span<const double> series, std::size_t d, const SeriesMean& rest) {
  const std::span<const double> head = series.first(d), tail = series.subspan(d);
  const double independent = std::max(1.0, static_cast<double>(d) / rest.integrated_time);
  const double error = std::hypot(rest.standard_error, rest.sd / std::sqrt(independent));
  const double middle = median_of({tail.begin(), tail.end()});
  const double away = std::abs(mean_of(head) - rest.mean);
  const double typical = std::abs(median_of({head.begin(), head.end()}) - middle);
  const double of_median =
      1.2533 * sd_of_median_deviation * median_distance(tail, middle) / std::sqrt(independent);  // of a normal one's
  if (away > start_up_significance * error && typical > std::max(no_bursts * away, 2.0 * of_median) &&
      (away > outside_fluctuations * rest.sd || dies_away(head, rest.mean)))
    return true;
  double squares = 0.0;
  for (const double value : head) squares += (value - rest.mean) * (value - rest.mean);
  return independent >= 10.0 && squares / static_cast<double>(d) > 4.0 * rest.sd * rest.sd &&
         median_distance(head, middle) > 2.0 * median_distance(tail, middle);
}

/// The least scale of a spike's neighbourhood, from the distances of all samples from their medians.
double least_scale(const std::vector<double>& away) {
  if (const double usual = median_of(away); usual > 0.0) return sd_of_median_deviation * usual;
  std::vector<double> steps;
  std::copy_if(away.begin(), away.end(), std::back_inserter(steps), [](double one) { return one > 0.0; });
  return 100 * steps.size() < away.size() ? 0.0 : median_of(steps);  // a constant but for single samples, or coarse
}

}  // namespace

Despiked without_spikes(std::span<const double> series) {
  Despiked clean{{series.begin(), series.end()}, {}};
  if (series.size() < 4) return clean;
  const std::size_t half = std::clamp<std::size_t>(series.size() / 200, 10, 100);
  std::vector<double> median(series.size()), scale(series.size()), away(series.size());
  sorted_windows(series, half, [&](std::size_t i, const std::vector<double>& window) {
    median[i] = window[window.size() / 2];
    scale[i] = sd_of_median_deviation * median_deviation(window);
    away[i] = std::abs(series[i] - median[i]);
  });
  const double least = least_scale(away);
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (away[i] == 0.0 || away[i] <= spike_distance * std::max(scale[i], least)) continue;
    clean.series[i] = median[i];
    clean.spikes.push_back(i);
  }
  return clean;
}

double median_of(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double spread_about(std::vector<double> values, double centre) {
  for (double& value : values) value = std::abs(value - centre);
  return sd_of_median_deviation * median_of(std::move(values));
}

MedianSpread spread_of(const std::vector<double>& values) {
  const double median = median_of(values);
  return {median, spread_about(values, median)};
}

SeriesMean mean_with_error(std::span<const double> series, const SeriesOptions& options) {
  if (series.empty()) {
    return {.mean = std::numeric_limits<double>::quiet_NaN(),
            .standard_error = std::numeric_limits<double>::infinity(),
            .reliable = false};
  }
  const SeriesMean whole = stationary(series, options);
  const std::size_t batches = series.size() / batch;
  const double fraction = std::clamp(options.start_up_fraction_max, 0.0, 0.9);
  if (batches < 4 || whole.sd == 0.0 || (fraction == 0.0 && options.spikes_count)) return whole;

  const Despiked clean = without_spikes(series);
  const std::span<const double> despiked = clean.series;
  const auto from = [&](std::size_t first) {
    SeriesMean rest = stationary((options.spikes_count ? series : despiked).subspan(first), options);
    rest.dropped = first;
    if (!options.spikes_count)
      rest.spikes_out = static_cast<std::size_t>(clean.spikes.end() -
                                                 std::lower_bound(clean.spikes.begin(), clean.spikes.end(), first));
    return rest;
  };
  std::size_t front = 0;  // spikes with which the series begins
  while (fraction > 0.0 && front < clean.spikes.size() && clean.spikes[front] == front) ++front;
  const std::vector<double> z = batch_means(despiked.subspan(front));
  const auto most = static_cast<std::size_t>(fraction * static_cast<double>(z.size()));
  const std::size_t dropped = front + mser(z, most) * batch;
  if (dropped == front || !is_start_up(despiked, dropped, stationary(despiked.subspan(dropped), options)))
    return front == 0 && clean.spikes.empty() ? whole : from(front);

  SeriesMean rest = from(dropped);
  // The start-up may not have ended within the part that may go.
  if (dropped == front + most * batch) rest.reliable = false;
  return rest;
}

}  // namespace data
