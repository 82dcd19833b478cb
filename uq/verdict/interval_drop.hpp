#pragma once
// The deviance at the ends of a 95 % profile interval, where the size of the data's errors is itself unknown.
//
// With known errors the deviance has chi-squared's law, and its 95 % value is deviance_95. With an unknown noise, or an
// unknown discrepancy, the law has longer tails: the best fit takes the errors that suit it best, which are too small.
// Given the spreads s (noise, the discrepancy's sd and length) parameter k has about the law N(b, v_k(s)), so that over
// the posterior of s it has a mixture of normal laws. The half-width q and the deviance D(q) that the profile reaches
// there are
//   mean over draws i of erfc(q / sqrt(2 v_k(s_i))) = 0.05
//   D(q) = 2 max_i l_i - 2 max_i (l_i - q^2 / (2 v_k(s_i))),      l_i = log L(b, s_i) and the spreads' priors
// v_k(s) = [(J' S(s)^-1 J + P)^-1]_kk, J the slopes of the data's mean at the best fit b, P the precisions of what
// other nuisances and cut parameters are known by. For n readings with an unknown sd and p parameters it is
// n log(1 + t^2 / (n - p)), t Student's 97.5 % point with n - p degrees of freedom: the exact interval. It is never
// less than that of known errors.
#include <Eigen/Dense>

#include "uq/posterior/case_model.hpp"

namespace uq {

/// Whether a nuisance acts on the spread of the data alone: a noise or a discrepancy of unknown size.
bool errors_unknown(const CaseModel& model);

/// The deviance at the interval's ends, per unknown. `best`: the most likely point; `draws` of the posterior, rows in
/// u; `drop`: the deviance where the errors are known.
Eigen::VectorXd interval_drops(const CaseModel& model, const Eigen::VectorXd& best, const Eigen::MatrixXd& draws,
                               double drop);

}  // namespace uq
