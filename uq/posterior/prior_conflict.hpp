#pragma once
// Whether the data and a stated prior contradict each other. The posterior is then a compromise that neither of the two
// supports, narrower than either.
//
// With s the normal score of the prior, s = Phi^-1(F(u)), the prior is N(0, 1). If the data tell of s with a normal
// error, its posterior mean is distributed over prior and data as N(0, 1 - v), v the posterior variance, so that
//   z = mean of s / sqrt(1 - v)
// is standard normal where prior and data agree: the check of M. Evans, H. Moshonov, Bayesian Anal. 1:893 (2006), on
// the posterior mean as the sufficient statistic. Exact for normal laws; the score makes it hold for skew and cut
// priors, too. Where a prior is so narrow that the data hardly move it, 1 - v is small beside the draws' own scatter of
// v. z is then worked out from the likelihood's slope and curvature at the posterior's mean, which over a narrow law
// hardly change, where the draws' mean score is the one that this leads to.
#include <Eigen/Dense>
#include <vector>

#include "uq/posterior/case_model.hpp"

namespace uq {

struct PriorConflict {
  int unknown = 0;  ///< index into CaseModel::unknowns
  double z = 0.0;   ///< standard deviations, away from the prior
};

/// The conflict of every unknown whose prior says more than a range, and whose posterior lies further than `most` away
/// from it. `draws`: rows in u, of the model's posterior. A cut unknown has no data to contradict.
std::vector<PriorConflict> prior_conflicts(const CaseModel& model, const Eigen::MatrixXd& draws, double most);

}  // namespace uq
