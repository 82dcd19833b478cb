#pragma once
// What is not known between the values of an input that were run.
//
// A full factorial of two levels says nothing of the curvature between them, and yet a fit to it is certain: the runs
// agree with a straight line as with no other function, length scales go to their bound, and leaving single runs out
// sees nothing, since the others of the same level stand in for it. The prior must therefore hold a part that the runs
// cannot overrule, because it vanishes at all of them. Where input k was not run between the neighbouring values a and
// b, the function is the fit plus a departure
//   delta_k ~ GP(0, s_k^2 b(x_k, x'_k) rho(x_-k, x'_-k)),
//   b(x, x') = c(x, x') - c(x, p) c(p, p)^-1 c(p, x'),   p = {a, b},
// a Matern 5/2 process c of length gap_length that is tied to zero at a and b; independent from gap to gap. Beyond the
// outermost run it is tied at one end. rho, Matern 5/2 of length gap_reach in the other inputs, lets it differ between
// their values. Its sd is
//   s_k = gap_share (effect_k + gap_floor) w(width),
// effect_k the root mean square, over the runs, of the range of the fitted mean as x_k alone goes through its values,
// in units of the output's sd; gap_floor is what an input without influence at its levels may hide between them. w is
// 0 up to gap_narrow and 1 from gap_wide on: where the values lie close, their runs say themselves how rough the
// function is. A gap at an end counts twice.
//
// The constants are chosen by coverage (surrogate/COVERAGE.md), not derived.
//
// The mean stays that of the fit; only the covariance grows. Deviation from an ordinary prior: s_k comes from the fit.
#include "surrogate/gaussian_process.hpp"

namespace surrogate {

constexpr double gap_length = 0.5;  ///< unit cube
constexpr double gap_reach = 1.0;   ///< unit cube
constexpr double gap_share = 0.6;
constexpr double gap_floor = 0.1;    ///< sd of the output
constexpr double gap_narrow = 0.18;  ///< unit cube: six levels are close enough
constexpr double gap_wide = 0.7;     ///< unit cube: half of it lies between three levels

/// The gaps of every input; sd is w.
std::vector<InputGap> find_gaps(const Standardised& data);

/// The range of the fitted mean as each active input alone goes through its values (root mean square over the runs), in
/// units of the output's sd.
Eigen::VectorXd input_effects(const GaussianProcess& process);

/// b of two places inside a gap.
double gap_covariance(const InputGap& gap, double a, double b);

/// Adds the departures' covariance (of z) of points in the unit cube, active inputs only, one per row.
void add_gaps(const std::vector<InputGap>& gaps, const Eigen::MatrixXd& points, Eigen::MatrixXd& covariance);

/// Their variance at one point.
double gap_variance(const std::vector<InputGap>& gaps, const Eigen::RowVectorXd& point);

/// Adds the derivative of the covariance to a common shift of one active input.
void add_gap_slopes(const std::vector<InputGap>& gaps, const Eigen::MatrixXd& points, int input,
                    Eigen::MatrixXd& slope);

/// A run at `point` parts the gaps that it lies in.
std::vector<InputGap> parted(const std::vector<InputGap>& gaps, const Eigen::RowVectorXd& point);

}  // namespace surrogate
