#pragma once
// The posterior of a case over its scaled unknowns u:
//   log p(u | y) = sum_s log prior_s(u_s) + log L(u) + const
//   log L(u) = sum_g log N(y_g | mean_g(u), S_g(u))          (full constants, so that evidences can be compared)
// g runs over the emulators, y_g are all the case's numbers that emulator g predicts; mean_g and S_g, the covariance of
// all that is uncertain of them, noise included, are those of uq/posterior/measurement.hpp, which adds a meter's errors
// to the emulator's mean and full covariance across those rows: a surrogate's error at one speed is nearly the same
// error at the next, and counting it as independent would make posteriors too narrow. Gradient, with r = y - mean,
// a = S^-1 r:
//   dlogL/dk = a' dmean/dk + 1/2 (a' dS/dk a - tr(S^-1 dS/dk))
// Where errors of different outputs are correlated (observe.correlation), the likelihood is log N(y | mean(u), S(u)) of
// all numbers together, with r_ij n_i n_j between numbers i and j whose own errors have the sds n. So it is where
// outputs share the error of a setting; the gradient is then one of differences. Deviation: the bands of
// a discrepancy, the part of a Bayes factor that is the surrogate's (held.hpp) and the choice of further runs take the
// outputs one by one.
#include <Eigen/Dense>
#include <functional>
#include <memory>
#include <vector>

#include "uq/infer/log_density.hpp"
#include "uq/posterior/case_model.hpp"
#include "uq/posterior/distinct.hpp"

namespace uq {

/// Stacked prediction of all rows at u.
struct StackedPrediction {
  Eigen::VectorXd mean;                          ///< SI
  Eigen::MatrixXd covariance;                    ///< SI^2, without the noise; zero between emulators
  Eigen::VectorXd noise;                         ///< SI^2, variance of each number's own error
  std::vector<LinkedErrors> linked_errors = {};  ///< between the numbers' own errors

  /// The covariance with the numbers' own errors, whose variances are multiplied by `noise_factor`.
  Eigen::MatrixXd total(double noise_factor = 1.0) const {
    Eigen::MatrixXd sum = covariance;
    add_own_errors(noise_factor * noise, linked_errors, sum);
    return sum;
  }
};
StackedPrediction predict(const CaseModel& model, const Eigen::VectorXd& u);
/// Stacks the laws of the groups' distinct rows at u, as for_each_law gives them.
StackedPrediction stack(const CaseModel& model, const std::vector<GroupLaw>& laws, const Eigen::VectorXd& u);
/// Mean and variance, noise included, of each row alone.
struct RowMoments {
  Eigen::VectorXd mean, variance;
};
RowMoments row_moments(const CaseModel& model, const Eigen::VectorXd& u);
RowMoments moments(const CaseModel& model, const std::vector<GroupLaw>& laws, const Eigen::VectorXd& u);

/// Rows at which a group's emulator is asked: the measured ones and their shifted copies.
Eigen::Index rows_asked(const RowGroup& group);
Eigen::MatrixXd rows_at(const RowGroup& group, const Eigen::VectorXd& u);
/// Log density of the group's numbers, given the emulator's prediction at those rows.
double log_group_density(const CaseModel& model, const RowGroup& group, const surrogate::Prediction& prediction,
                         const Eigen::VectorXd& u);
/// The emulator's predictions of a group's rows at each of `points`: many at once are several times cheaper.
std::vector<surrogate::Prediction> predictions(const RowGroup& group, const Eigen::MatrixXd& points);
/// The law of one group's rows.
GroupLaw group_law(const CaseModel& model, const RowGroup& group, const Eigen::VectorXd& u);
/// Calls `use` for each of `points` in turn, with the law of each group's distinct rows.
void for_each_law(const CaseModel& model, const Eigen::MatrixXd& points,
                  const std::function<void(Eigen::Index point, const std::vector<GroupLaw>& laws)>& use);

double log_prior(const CaseModel& model, const Eigen::VectorXd& u);
Evaluation log_prior_gradient(const CaseModel& model, const Eigen::VectorXd& u);

double log_likelihood(const CaseModel& model, const Eigen::VectorXd& u);
Evaluation log_likelihood_gradient(const CaseModel& model, const Eigen::VectorXd& u);
/// Log likelihood of each row of `points`.
Eigen::VectorXd log_likelihoods(const CaseModel& model, const Eigen::MatrixXd& points);

/// Log likelihood of each measured number on its own (its marginal): points x rows.
Eigen::MatrixXd pointwise_log_likelihoods(const CaseModel& model, const Eigen::MatrixXd& points);

/// (y - mean)' S^-1 (y - mean) of other data y, with the noise's variance times `noise_factor`.
double chi_squared(const StackedPrediction& prediction, const Eigen::VectorXd& y, double noise_factor = 1.0);

/// Chi-squared of the case's own data at u.
double chi_squared(const CaseModel& model, const Eigen::VectorXd& u);
double chi_squared(const CaseModel& model, const std::vector<GroupLaw>& laws, const Eigen::VectorXd& u);

/// Log density of knowledge that is no measurement of this case: the priors of the nuisances, such as a calibration
/// certificate, and the law of each unknown that was cut from another case. A profile adds it to the likelihood,
/// so that these unknowns stay where they are known to be.
Evaluation log_certificates(const CaseModel& model, const Eigen::VectorXd& u);

/// The posterior for the samplers; the prior is its reference. The model is shared.
Target posterior_target(const std::shared_ptr<const CaseModel>& model);

/// d mean / du of all rows, rows x unknowns.
Eigen::MatrixXd sensitivity(const CaseModel& model, const Eigen::VectorXd& u);

}  // namespace uq
