// The mean of a correlated, possibly not yet stationary series x_1 ... x_n, and its standard error.
//
// Start-up. MSER-5: K. P. White, "An effective truncation heuristic for bias reduction in simulation output",
// Simulation 69 (1997) 323. With Z_j the means of 5 consecutive samples, drop the first d of the b batches for which
//   MSER(d) = sum_{j > d} (Z_j - mean)^2 / (b - d)^2
// is smallest. Deviation: the minimum of a stationary series is often at some d > 0 by chance, so the d batches are
// dropped only when their own mean differs from the mean of the rest by more than `start_up_significance` standard
// errors, or, for a start-up whose mean happens to agree, when their variance is that of another process (over four
// times the rest's); otherwise everything is kept.
//
// Error. var(mean) = sd^2 tau / n with tau = 1 + 2 sum_{t=1..M} rho(t), rho the autocorrelation function.
// A. Sokal, "Monte Carlo methods in statistical mechanics" (1996), section 3: M is the smallest with M >= c tau_int(M),
// in his convention tau_int = tau / 2. U. Wolff, Comput. Phys. Commun. 156 (2004) 143, eq. (49): subtracting the
// sample's own mean biases rho by about -tau / n, undone to leading order by the factor 1 + (2 M + 1) / n. Deviation:
// tau >= 1, so that a chance negative correlation never claims a better error than independent samples have.
#include "data/time_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace data {
namespace {

constexpr std::size_t batch = 5;
constexpr double start_up_significance = 3.0;

double mean_of(std::span<const double> x) {
  double sum = 0.0;
  for (const double value : x) sum += value;
  const double first = sum / static_cast<double>(x.size());
  double rest = 0.0;  // second pass: removes the rounding of the first
  for (const double value : x) rest += value - first;
  return first + rest / static_cast<double>(x.size());
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
  double tau = 1.0;
  std::size_t window = 0;
  while (window + 1 < n && static_cast<double>(window) < options.window_factor * 0.5 * std::max(tau, 1.0)) {
    ++window;
    double product = 0.0;
    for (std::size_t i = window; i < n; ++i) product += y[i] * y[i - window];
    tau += 2.0 * product / squares;
  }
  tau = std::max(1.0, tau * (1.0 + (2.0 * static_cast<double>(window) + 1.0) / count));
  result.integrated_time = tau;
  result.effective_samples = count / tau;
  result.standard_error = result.sd * std::sqrt(tau / count);
  result.reliable = count >= 20.0 * tau;
  return result;
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

/// Whether the first `d` samples belong to another process than the rest.
bool is_start_up(std::span<const double> series, std::size_t d, const SeriesMean& rest) {
  const std::span<const double> head = series.first(d);
  const double head_mean = mean_of(head);
  const double independent = std::max(1.0, static_cast<double>(d) / rest.integrated_time);
  const double error = std::hypot(rest.standard_error, rest.sd / std::sqrt(independent));
  if (std::abs(head_mean - rest.mean) > start_up_significance * error) return true;
  double squares = 0.0;
  for (const double value : head) squares += (value - rest.mean) * (value - rest.mean);
  return independent >= 10.0 && squares / static_cast<double>(d) > 4.0 * rest.sd * rest.sd;
}

}  // namespace

SeriesMean mean_with_error(std::span<const double> series, const SeriesOptions& options) {
  if (series.empty()) {
    return {.mean = std::numeric_limits<double>::quiet_NaN(),
            .standard_error = std::numeric_limits<double>::infinity(),
            .reliable = false};
  }
  const SeriesMean all = stationary(series, options);
  const std::size_t batches = series.size() / batch;
  if (batches < 4 || all.sd == 0.0) return all;

  std::vector<double> z(batches);
  for (std::size_t j = 0; j < batches; ++j) z[j] = mean_of(series.subspan(j * batch, batch));
  const double fraction = std::clamp(options.start_up_fraction_max, 0.0, 0.9);
  const auto most = static_cast<std::size_t>(fraction * static_cast<double>(batches));
  const std::size_t dropped = mser(z, most) * batch;
  if (dropped == 0) return all;

  SeriesMean rest = stationary(series.subspan(dropped), options);
  if (!is_start_up(series, dropped, rest)) return all;
  rest.dropped = dropped;
  if (dropped == most * batch) rest.reliable = false;  // the start-up may not have ended within the part that may go
  return rest;
}

}  // namespace data
