#pragma once
// The posterior of a case over its scaled unknowns u:
//   log p(u | y) = sum_s log prior_s(u_s) + log L(u) + const
//   log L(u) = sum_g log N(y_g | m_g(u), D_g + C_g(u))      (full constants, so that evidences can be compared)
// g runs over the emulators, y_g are all the case's numbers that emulator g predicts, D_g their measurement variances,
// m_g and C_g the emulator's mean and full covariance across those rows: a surrogate's error at one speed is nearly the
// same error at the next, and counting it as independent would make posteriors too narrow. Gradient, with S = D + C, r
// = y - m, a = S^-1 r:
//   dlogL/dk = a' dm/dk + 1/2 (a' dC/dk a - tr(S^-1 dC/dk))
#include <Eigen/Dense>
#include <memory>

#include "uq/case_model.hpp"
#include "uq/log_density.hpp"

namespace uq {

/// Stacked prediction of all rows at u.
struct StackedPrediction {
  Eigen::VectorXd mean;        ///< SI
  Eigen::MatrixXd covariance;  ///< SI^2, of the emulators alone; zero between emulators
};
StackedPrediction predict(const CaseModel& model, const Eigen::VectorXd& u);

double log_prior(const CaseModel& model, const Eigen::VectorXd& u);
Evaluation log_prior_gradient(const CaseModel& model, const Eigen::VectorXd& u);

double log_likelihood(const CaseModel& model, const Eigen::VectorXd& u);
Evaluation log_likelihood_gradient(const CaseModel& model, const Eigen::VectorXd& u);
/// Of each row of `points`.
Eigen::VectorXd log_likelihoods(const CaseModel& model, const Eigen::MatrixXd& points);

/// Log likelihood of each measured number on its own (its marginal), in the order of the rows.
Eigen::VectorXd pointwise_log_likelihood(const CaseModel& model, const Eigen::VectorXd& u);

/// (y - m)' (D + C)^-1 (y - m) at u for other data y.
double chi_squared(const StackedPrediction& prediction, const Eigen::VectorXd& variance, const Eigen::VectorXd& y);

/// The posterior for the samplers; the prior is its reference. The model is shared.
Target posterior_target(std::shared_ptr<const CaseModel> model);

/// d mean / du of all rows, rows x unknowns.
Eigen::MatrixXd sensitivity(const CaseModel& model, const Eigen::VectorXd& u);

}  // namespace uq
