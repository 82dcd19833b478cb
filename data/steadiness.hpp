#pragma once
// Whether a series is stationary, and its mean with an error that is true for a correlated one.
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "data/texts.hpp"
#include "data/time_series.hpp"

namespace data {

/// What a run says of its means, and a row of the table in its column `state`.
enum class FlowState {
  steady,
  drifting,   ///< it was not steady by the end
  too_short,  ///< for its correlation: its error is not known, or what seems to drift may be chance
};
template <>
inline constexpr std::array texts_of<FlowState> = {"steady", "drifting", "short"};

struct SteadinessOptions {
  std::size_t error_modes = 8;   ///< of which the error is made: the slowest; with fewer, the series is too short
  std::size_t drift_modes = 16;  ///< at most, of which the slowest two are compared with the others
};

struct Steadiness {
  SeriesMean mean;       ///< `reliable`: there are `error_modes`
  double drift_p = 1.0;  ///< how often a stationary series has as much power in its slowest two modes
};

/// Of a series from which the start-up is gone already. Throws nothing; a series that is too short is not reliable.
Steadiness steadiness(std::span<const double> series, const SteadinessOptions& options = {});

/// Whether series of the same span are steady together, with a chance of `level` to call steady ones drifting however
/// they depend on each other: each p is compared with level / number (Bonferroni).
bool drifts(std::span<const double> p, double level);

}  // namespace data
