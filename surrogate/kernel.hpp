#pragma once
// Stationary correlation functions with one length scale per input (ARD), of the scaled distance r,
//   r^2 = sum_k ((x_k - x'_k) / l_k)^2,
//   Matern 3/2:            c = (1 + a) exp(-a),            a = sqrt(3) r,   f = 3 exp(-a)
//   Matern 5/2:            c = (1 + a + a^2/3) exp(-a),    a = sqrt(5) r,   f = 5/3 (1 + a) exp(-a)
//   squared exponential:   c = exp(-r^2 / 2),                               f = c
// (Rasmussen & Williams, "Gaussian Processes for Machine Learning", 2006, section 4.2.1). The slope f = -(1/r) dc/dr
// has no singularity at r = 0 and gives every derivative that is needed:
//   dc/d(log l_k) = f ((x_k - x'_k) / l_k)^2,     dc/dx_k = -f (x_k - x'_k) / l_k^2.
#include <Eigen/Core>
#include <numbers>

#include "data/texts.hpp"

namespace surrogate {

enum class Kernel { matern32, matern52, squared_exponential };
using data::to_text;

/// Where a block of correlations is worked out: buffers of the same length, `square` holding r^2 on entry. An empty
/// `slope` means that f is not wanted.
struct CorrelationBlock {
  Eigen::Map<Eigen::ArrayXd> square;  ///< r^2 on entry, scratch afterwards
  Eigen::Map<Eigen::ArrayXd> value;   ///< c
  Eigen::Map<Eigen::ArrayXd> slope;   ///< f
};

inline void correlate(Kernel kernel, CorrelationBlock block) {
  constexpr double sqrt5 = 2.236067977499789696;
  const bool with_slope = block.slope.size() > 0;
  switch (kernel) {
    case Kernel::matern52:
      block.square = sqrt5 * block.square.sqrt();
      block.value = (-block.square).exp();
      if (with_slope) block.slope = (5.0 / 3.0) * (1.0 + block.square) * block.value;
      block.value *= 1.0 + block.square * (1.0 + block.square * (1.0 / 3.0));
      break;
    case Kernel::matern32:
      block.square = std::numbers::sqrt3 * block.square.sqrt();
      block.value = (-block.square).exp();
      if (with_slope) block.slope = 3.0 * block.value;
      block.value *= 1.0 + block.square;
      break;
    case Kernel::squared_exponential:
      block.value = (-0.5 * block.square).exp();
      if (with_slope) block.slope = block.value;
      break;
  }
}

}  // namespace surrogate

template <>
inline constexpr std::array data::texts_of<surrogate::Kernel> = {"matern 3/2", "matern 5/2", "squared exponential"};
