#pragma once
// Points on both sides of a point, for central differences: one-sided at an end of the support, so that nothing is
// evaluated where the posterior is not defined.
#include <Eigen/Core>
#include <algorithm>

#include "uq/posterior/case_model.hpp"

namespace uq {

struct BothSides {
  Eigen::VectorXd low, high;
  double apart = 0.0;  ///< high - low along the unknown
};

/// The points `share` of the support's width to either side of u along unknown s.
inline BothSides both_sides(const CaseModel& model, const Eigen::VectorXd& u, Eigen::Index s, double share) {
  const double lower = model.lower()[s], upper = model.upper()[s], step = share * (upper - lower);
  BothSides at{.low = u, .high = u};
  at.low[s] = std::max(u[s] - step, lower);
  at.high[s] = std::min(u[s] + step, upper);
  at.apart = at.high[s] - at.low[s];
  return at;
}

}  // namespace uq
