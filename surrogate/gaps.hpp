#pragma once
// The uncertainty between the values of an input that were run.
//
// Two levels of an input say nothing of the curvature between them. A fit is nevertheless certain there: a straight
// line explains all runs, length scales go to their bound, and leaving out single runs shows no error, since other runs
// of the same level stand in for them. A departure that is zero at every run is therefore added to the prior. Where
// input k was not run between the neighbouring values a and b, the function is the fit plus
//   delta_k ~ GP(0, s_k^2 b(x_k, x'_k) rho(x_-k, x'_-k)),
//   b(x, x') = c(x, x') - c(x, p) c(p, p)^-1 c(p, x'),   p = {a, b},
// a Matern 5/2 process c of length gap_length that is tied to zero at a and b. Departures in different gaps are
// independent. Beyond the outermost run the process is tied at one end. rho, Matern 5/2 of length gap_reach in the
// other inputs, lets the departure differ between their values. The departure's sd is
//   s_k = gap_share (effect_k + gap_floor) w(width),
// in units of the output's sd. effect_k is the root mean square, over the runs, of the range of the fitted mean as x_k
// alone goes through its values. gap_floor is what an input without influence at its levels may hide between them. w is
// 0 up to gap_narrow and 1 from gap_wide on: where the values lie close, their runs show how rough the function is. A
// gap at an end counts twice.
//
// The constants are chosen by coverage (surrogate/COVERAGE.md), not derived. The mean stays that of the fit, and only
// the covariance grows. Deviation from an ordinary prior: s_k comes from the fit.
#include "surrogate/gaussian_process.hpp"

namespace surrogate {

constexpr double gap_length = 0.5;  ///< unit cube
constexpr double gap_reach = 1.0;   ///< unit cube
constexpr double gap_share = 0.6;
constexpr double gap_floor = 0.1;    ///< sd of the output
constexpr double gap_narrow = 0.18;  ///< unit cube: six levels are close enough
constexpr double gap_wide = 0.7;     ///< unit cube: half of it lies between three levels

/// The gaps of every input, with the weight w of each as its sd.
std::vector<InputGap> find_gaps(const Standardised& data);

/// The range of the fitted mean as each active input alone goes through its values (root mean square over the runs), in
/// units of the output's sd.
Eigen::VectorXd input_effects(const GaussianProcess& process);

/// The covariance b of two places inside a gap.
double gap_covariance(const InputGap& gap, double a, double b);

/// Adds the departures' covariance (of z) of points in the unit cube, active inputs only, one per row.
void add_gaps(const std::vector<InputGap>& gaps, const Eigen::MatrixXd& points, Eigen::MatrixXd& covariance);

/// Adds the departures' covariance between two lots of points: rows of `covariance` for the rows of a, columns for
/// those of b.
void add_gaps_between(const std::vector<InputGap>& gaps, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                      Eigen::MatrixXd& covariance);

/// The departures' variance at one point.
double gap_variance(const std::vector<InputGap>& gaps, const Eigen::RowVectorXd& point);

/// Adds the derivative of the covariance to a common shift of one active input.
void add_gap_slopes(const std::vector<InputGap>& gaps, const Eigen::MatrixXd& points, int input,
                    Eigen::MatrixXd& slope);

/// The gaps after a run at `point`, which divides the gaps that it lies in.
std::vector<InputGap> parted(const std::vector<InputGap>& gaps, const Eigen::RowVectorXd& point);

}  // namespace surrogate
