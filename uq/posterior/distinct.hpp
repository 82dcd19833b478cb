#pragma once
// Rows measured again and again at the same settings, as one row each: nothing is lost. With y_i = g + e_i for the n
// rows of one setting, g what they share (model, surrogate's error, meter's common errors), e_i ~ N(0, k^2 / w_i) their
// own,
//   sum_i (y_i - g)^2 w_i = W (ybar - g)^2 + sum_i (y_i - ybar)^2 w_i,   W = sum w_i,  ybar = sum w_i y_i / W
// so the likelihood is that of ybar with the variance k^2 / W, times what the scatter about ybar says of k:
//   log = -1/2 scatter / k^2 - (n - 1) log k + 1/2 (sum log w_i - log W - (n - 1) log 2 pi)
// Evaluations then cost the cube of the number of settings instead of the number of rows.
#include "uq/posterior/case_model.hpp"

namespace uq {

/// Sets model.distinct, when there are rows to pool. Called by build_case and with_data.
void pool_rows(CaseModel& model);

/// The pooled model where there is one, else the model itself.
const CaseModel& distinct_rows(const CaseModel& model);

/// The number of measured numbers; each reading that a row of a pooled model stands for is counted.
int number_count(const CaseModel& model);

/// Largest number of different settings of one output and material that a case may have. Above it data::InputError (65)
/// is thrown that says what to average.
inline constexpr int settings_max = 400;

/// The log density of the scatter of repeats about their means, with its slope along the noise's factor.
struct Scatter {
  double log_density = 0.0, chi_squared = 0.0;
  double slope = 0.0;  ///< derivative of the log density to u of the factor's unknown
};
Scatter scatter_of(const CaseModel& model, const Repeats& repeats, const Eigen::VectorXd& u);

}  // namespace uq
