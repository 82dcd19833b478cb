#pragma once
// Mean of a correlated time series and its standard error.
#include <cstddef>
#include <span>
#include <vector>

namespace data {

struct SeriesOptions {
  double start_up_fraction_max = 0.5;  ///< the truncation rule may drop up to this much of the series as start-up
  double window_factor = 5.0;  ///< Sokal's automatic window: M >= window_factor * tau / 2 (his tau_int is half of ours)
  bool spikes_count = true;    ///< spikes count in mean and error; the choice of the start is always made without them
};

struct SeriesMean {
  double mean = 0.0;
  double standard_error = 0.0;     ///< sd of the mean, autocorrelation included
  double sd = 0.0;                 ///< sd of one sample
  double integrated_time = 1.0;    ///< integrated autocorrelation time tau, in samples: var(mean) = sd^2 tau / n
  double effective_samples = 0.0;  ///< n / tau
  std::size_t spikes_out = 0;      ///< spikes left out of mean and error, where SeriesOptions says so
  std::size_t dropped = 0;         ///< samples taken for start-up; 0 when the front does not differ from the rest
  bool reliable =
      true;  ///< false when the series is too short for its correlation (n < 20 tau) or its start-up does not end
  bool drifts = false;  ///< the mean is not that of a steady flow, and is not reliable either
};

/// The median (of an even number of values the upper one of the middle two); NaN where there is no value.
double median_of(std::vector<double> values);

/// The standard deviation of a normal distribution over its median absolute deviation.
inline constexpr double sd_of_median_deviation = 1.4826;

/// What an outlier does not move: the median, and the median absolute deviation as a normal distribution's sd.
struct MedianSpread {
  double median = 0.0, sd = 0.0;
};
MedianSpread spread_of(const std::vector<double>& values);
/// The same sd about a centre that is known.
double spread_about(std::vector<double> values, double centre);

/// A series in which each spike is replaced by the median of its neighbours.
struct Despiked {
  std::vector<double> series;
  std::vector<std::size_t> spikes;  ///< indices of the spikes
};

/// Replaces the spikes of a finite series. A spike is a sample, or a few in a row, far from the median of the samples
/// around it (Hampel's rule).
Despiked without_spikes(std::span<const double> series);

/// Mean and error of a series: start-up by MSER-5 (White 1997), error by the integrated autocorrelation time with
/// Sokal's window.
SeriesMean mean_with_error(std::span<const double> series, const SeriesOptions& options = {});

}  // namespace data
