#pragma once
// log sum_i exp(l_i), which neither overflows nor underflows.
#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace surrogate {

/// Minus infinity where no term is finite.
inline double log_sum(const Eigen::VectorXd& logs) {
  constexpr double none = -std::numeric_limits<double>::infinity();
  const double largest = logs.size() == 0 ? none : logs.maxCoeff();
  return std::isfinite(largest) ? largest + std::log((logs.array() - largest).exp().sum()) : none;
}

}  // namespace surrogate
