#pragma once
// A range and how the unit interval spans it. Designs, surrogates and posteriors work in [0, 1], so that no result
// depends on a unit, and a Hamaker constant near 1e-18 J and a friction near 0.4 look the same.
//   linear  x = low + u (high - low)      log  x = low (high / low)^u
#include <cmath>

#include "data/texts.hpp"

namespace data {

enum class Scale { linear, log };

template <>
inline constexpr std::array texts_of<Scale> = {"linear", "log"};

struct Axis {
  double low = 0.0;   ///< SI, above 0 on a log scale
  double high = 1.0;  ///< SI, above low
  Scale scale = Scale::linear;

  /// The place u of a value on the unit interval.
  double to_unit(double value) const {
    if (scale == Scale::log) return std::log(value / low) / std::log(high / low);
    return (value - low) / (high - low);
  }
  /// The value at u.
  double from_unit(double u) const {
    if (scale == Scale::log) return low * std::pow(high / low, u);
    return low + u * (high - low);
  }
  /// dx/du at u.
  double slope(double u) const { return scale == Scale::log ? from_unit(u) * std::log(high / low) : high - low; }
};

}  // namespace data
