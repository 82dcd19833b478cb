#pragma once
// The surrogate's share of a posterior's width: what would be left if the surrogate's mean were the truth.
//
// The draws u_j of the posterior are weighted by the ratio of the likelihoods without and with the surrogate's error,
//   w_j = N(y; m(u_j), E) / N(y; m(u_j), E + S(u_j)),
// and give each parameter's mean a and variance v without that error beside mean b and variance V with it:
//   share = max(1 - v / V, (a - b)^2 / V, 0), at most 1.
// The second part sees a posterior that would move without becoming narrower. Where few draws carry the weight
// (effective number 1 / sum w^2 below `least_effective`), the surrogate's error rules, and the share counts as 1.
#include <Eigen/Dense>
#include <string>
#include <vector>

#include "uq/posterior/case_model.hpp"

namespace uq {

struct SurrogateShare {
  double share = 1.0;          ///< share of the posterior variance, for the worst parameter
  std::string parameter;       ///< the worst parameter
  std::vector<double> shares;  ///< share for each of the case's own parameters
  std::vector<double> left;    ///< for each: v / V, the variance that is left without the surrogate's error
  std::vector<double> moved;   ///< for each: |a - b| / sqrt(V); where it is large, few draws lie where v is asked for
  double effective_draws = 0.0;

  /// Whether the draws tell what an exact surrogate would leave of parameter k: there are enough of them where it would
  /// be.
  bool tells(std::size_t k) const;
};

inline constexpr double least_effective = 20.0;  ///< least effective number of draws

/// The surrogate's share. `draws`: rows in u, of the model's posterior, with the model's log likelihood at each.
SurrogateShare surrogate_share(const CaseModel& model, const Eigen::MatrixXd& draws,
                               const Eigen::VectorXd& log_likelihood);

/// The share from a thousand of the draws at most: enough for a few per cent.
SurrogateShare surrogate_share(const CaseModel& model, const Eigen::MatrixXd& draws);

}  // namespace uq
