#pragma once
// One reading that lies far from what all others say, where the size of the errors is unknown. Such a case always fits:
// the noise, or the discrepancy, grows until it does, and one wrong reading widens every value.
//
// With the model linear about a best fit, r the residuals and S the data's covariance, what can move the mean
// integrated out, reading i lies e_i = [S^-1 r]_i / [S^-1]_ii from what the others predict, to a variance of
// 1 / [S^-1]_ii. The reading with the largest e_i over its sd is replaced by what the others say of it, the errors'
// size is found again, and so on until neither moves. Its distance over its sd, times the square root of
// (n - 1 - p) / n for n readings and p parameters, since a best fit's noise is too small, is Student's t with
// n - 1 - p degrees of freedom: the outlier test of R. D. Cook and S. Weisberg, Residuals and Influence in
// Regression (1982), 2.2.2. The chance is that of the largest of n (Bonferroni).
#include <Eigen/Dense>
#include <optional>

#include "data/study.hpp"
#include "uq/findings/thresholds.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

struct OutlyingReading {
  RowOrigin origin;
  double errors = 0.0;    ///< distance from what the others say, in errors as large as the others'
  double chance = 1.0;    ///< chance of a reading as far off among so many
  double widening = 1.0;  ///< factor by which this reading widens the errors' size
};

/// The reading that lies so far off. None where the errors' size is known, or fewer than two degrees of freedom are
/// left, or the chance is not below thresholds.outlying_chance. `best`: the best fit to all.
std::optional<OutlyingReading> outlying_reading(const CaseModel& model, const Eigen::VectorXd& best,
                                                const VerdictThresholds& thresholds);

}  // namespace uq
