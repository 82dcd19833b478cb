#pragma once
// The share of a posterior's width that is held by errors which repeated readings share: a meter's gain or zero, the
// rig's scale, a setting known to an error, a discrepancy. Neither repeats nor more accurate readings take that part
// away, so another remedy is needed: to find that error by itself. (A setting's error averages out over other
// settings.)
//
// At each of some draws u of the posterior the model is taken as linear. With J the slopes of the predicted data times
// the priors' sds P, and S the data's covariance without what the sampled nuisances do,
//   V(u) = P (J' S^-1 J + 1)^-1 P.
// A nuisance that is known has no column in J, and an error that is integrated out leaves S. With V' made so,
//   share of a parameter = 1 - sum_u V'(u) / sum_u V(u),
// sums over draws, so that a curved ridge is seen along its length. Deviation: flat priors count as normal ones of the
// same sd.
#include <Eigen/Dense>
#include <vector>

#include "uq/findings/parameter_results.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

/// The errors of the case that repeated readings share.
std::vector<CommonError> shared_errors(const CaseModel& model);

/// The share of each of the case's own parameters; zero where repeats share no error.
/// `draws`: rows in u, of the model's posterior.
std::vector<CommonShare> common_shares(const CaseModel& model, const Eigen::MatrixXd& draws);

}  // namespace uq
