#pragma once
// Uphill from a point without leaving its basin: steps of a BFGS model of -log p inside a trust region, which grows
// where the model predicts the rise and shrinks where it does not (J. Nocedal, S. J. Wright, "Numerical Optimization",
// 2nd ed. (2006), algorithms 4.1 and 6.1). Coordinates are in units of `width`; the support's faces are held to.
#include "uq/infer/explore.hpp"

namespace uq {

struct Climb {
  Eigen::VectorXd x;
  double log_density = nowhere;
  bool known = false;  ///< the climb ended where the knowledge reaches
  int evaluations = 0;
};

Climb climb(const Target& target, const Eigen::VectorXd& start, const Eigen::VectorXd& width,
            const Knowledge& knowledge);

}  // namespace uq
