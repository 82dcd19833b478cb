#pragma once
// The posterior's predictions of the data: the check whether the model fits at all, and the bands of the figures.
//
// Check. The distance of data y from the prediction at u is
//   T(y, u) = (y - m(u))' S(u)^-1 (y - m(u)),   S: all that is uncertain of y given u.
// For a replicate y' ~ N(m(u), S(u)), T(y', u) is chi-squared with n degrees of freedom, whatever u is. The posterior
// predictive p (Gelman, Meng, Stern 1996) is therefore a mean over draws of an exact tail, without simulation:
//   p = E[ P(chi2_n >= T(y, u)) | y ].
// It is conservative when n is little more than the number of parameters. Beside it stands the best fit's own tail,
//   P(chi2_(n - k) >= T(y, u*)),   k: directions that the data know (uq/posterior/fisher.hpp).
#include <Eigen/Dense>

#include "data/study.hpp"
#include "uq/findings/prediction_results.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

struct FitCheck {
  double chi2 = 0.0;  ///< at the best fit
  int dof = 0;        ///< n - k, at least 1
  double predictive_p = 0.0;
  double best_fit_p = 0.0;
};

/// `draws`: rows in u.
FitCheck check_fit(const CaseModel& model, const Eigen::MatrixXd& draws, const Eigen::VectorXd& best);

/// A measured number with its settings, in the study's units. Its prediction is still to be filled.
PredictivePoint observed_point(const data::Study& study, const RowOrigin& from);

/// Draws of the numbers' own errors, with these variances and links, from standard normal numbers.
Eigen::VectorXd own_errors(const Eigen::VectorXd& variance, const std::vector<LinkedErrors>& linked,
                           const Eigen::VectorXd& normal);

/// Posterior predictive of a repeated measurement at each own row: mean, 5 % and 95 % with measurement and surrogate
/// error.
std::vector<PredictivePoint> predictive_points(const data::Study& study, const CaseModel& model,
                                               const Eigen::MatrixXd& draws, std::uint64_t seed);

/// Bands of the model alone (surrogate error included; scale, gain and offset of the meter, but no measurement error
/// and no discrepancy) against the first control of each own set.
std::vector<PredictiveCurve> predictive_curves(const data::Study& study, const CaseModel& model,
                                               const Eigen::MatrixXd& draws, std::uint64_t seed);

/// The same curves at one point (all unknowns, u): the model's mean, without a band.
std::vector<PredictiveCurve> mean_curves(const data::Study& study, const CaseModel& model, const Eigen::VectorXd& u);

/// Replicate data of each draw (rows: draws, columns: the model's rows), SI.
Eigen::MatrixXd replicates(const CaseModel& model, const Eigen::MatrixXd& draws, std::uint64_t seed);

/// Mean over draws of the predicted means of all rows, SI.
Eigen::VectorXd mean_prediction(const CaseModel& model, const Eigen::MatrixXd& draws);

/// Whether the case itself observes a set (index in Study::observations), not one linked with it.
bool is_own_set(const data::Study& study, const CaseModel& model, std::size_t set);

/// At most `count` of the rows, evenly spaced.
Eigen::MatrixXd thinned(const Eigen::MatrixXd& draws, Eigen::Index count);

}  // namespace uq
