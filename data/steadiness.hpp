#pragma once
// A test whether a series is stationary, and its mean with an error that is true for a correlated series.
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "data/texts.hpp"
#include "data/time_series.hpp"

namespace data {

/// Whether a run's means are those of the steady flow, as its row's column `state` says.
enum class FlowState {
  steady,
  drifting,   ///< the flow was not steady by the end
  too_short,  ///< too short for its correlation: the error is not known, or what seems to drift may be chance
};
template <>
inline constexpr std::array texts_of<FlowState> = {"steady", "drifting", "short"};

struct SteadinessOptions {
  std::size_t error_modes = 8;   ///< slowest modes that make the error; with fewer, the series is too short
  std::size_t drift_modes = 16;  ///< at most; the slowest two of them are compared with the others
  bool fast_noise = false;  ///< white noise may lie over the series, as a sensor's does: is it long enough below that?
};

struct Steadiness {
  SeriesMean mean;       ///< `reliable`: there are at least `error_modes` modes
  double drift_p = 1.0;  ///< how often a stationary series has as much power in its slowest two modes
};

/// Mean and drift of a series from which the start-up is gone already. Throws nothing; a series that is too short is
/// not reliable.
Steadiness steadiness(std::span<const double> series, const SteadinessOptions& options = {});

/// Whether series of the same span are steady together, with a chance of `level` to call steady ones drifting however
/// they depend on each other: each p is compared with level / number (Bonferroni).
bool drifts(std::span<const double> p, double level);

}  // namespace data
