#pragma once
// Separate hills of a likelihood along a profile. A value may be excluded by the 95 % interval, and a hill about it
// still hold several per cent of the posterior: then "one value, known well" would be wrong of what the data leave
// open.
#include <Eigen/Core>
#include <vector>

namespace uq {

struct Hill {
  Eigen::Index best = 0;             ///< its point of least deviance
  Eigen::Index first = 0, last = 0;  ///< points between the peaks of the deviance on either side, or to the path's ends
  double peak = 0.0;                 ///< deviance of the lower of these peaks; infinite where there is none
  double mass = 0.0;  ///< share of prior x exp(-deviance / 2) over the path, both along straight lines between points
};

/// Hills from left to right; what rises by less than `prominence` on a side is no hill of its own. `u`: rising;
/// `log_prior`: at each point, up to a constant.
std::vector<Hill> find_hills(const Eigen::VectorXd& u, const Eigen::VectorXd& deviance,
                             const Eigen::VectorXd& log_prior, double prominence = 1.0);

}  // namespace uq
