#pragma once
// Training data of one output, standardised and with its replicates pooled.
//
// Scale. With g(y) = y (linear) or log y (log), z = (g(y) - shift) / unit, where shift is the mean of g(y) (or 0, for a
// process whose mean is zero) and unit its root mean square about shift: whatever the unit of y, z is of order one. The
// noise variance of z is var / unit^2 (linear), and var / (y unit)^2 (log, first order): it is divided by the variance
// of the data and never multiplied by a fitted variance.
//
// Replicates. Runs i at the same point, each with known noise variance d_i and its own draw of the nugget g (run-to-run
// scatter), enter the likelihood exactly through w_i = 1 / (d_i + g):
//   m = sum w_i z_i / sum w_i,   v = 1 / sum w_i,
//   prod_i N(z_i | f, 1/w_i) = N(m | f, v) exp(E),
//   E = 1/2 sum log w_i - 1/2 sum w_i (z_i - m)^2 + 1/2 log v - (r - 1)/2 log(2 pi).
// A column of x that never changes is left out of the process (active lists the others).
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "data/texts.hpp"

namespace surrogate {

enum class OutputScale { linear, log };
using data::to_text;

/// The value of g(y) at which z is zero.
enum class Centre { data_mean, zero };

struct TrainingSet {
  Eigen::MatrixXd x;                    ///< n x d, each input scaled to the unit cube by its training range
  Eigen::VectorXd y;                    ///< n, any unit
  Eigen::VectorXd noise_variance;       ///< n, unit^2 of y: known variance of each run's mean; empty: none
  std::vector<std::string> names = {};  ///< d, names of the inputs for messages; empty: "input 1", ...

  std::string name_of(Eigen::Index input) const;
};

/// A stretch of one input without runs, in which the function may leave the fit (gaps.hpp).
struct InputGap {
  int input = 0;                 ///< index among the active inputs
  double low = 0.0, high = 0.0;  ///< unit cube; -infinity, infinity: nothing beyond the outermost run
  double sd = 0.0;               ///< sd of z, of the departure far from runs
};

struct Standardised {
  OutputScale scale = OutputScale::linear;
  double shift = 0.0;              ///< g(y) = shift + unit z
  double unit = 1.0;               ///< unit of g(y)
  double log_jacobian = 0;         ///< log |dz/dy| summed over runs
  Eigen::VectorXd z;               ///< n
  Eigen::VectorXd noise;           ///< n, variance of z
  Eigen::MatrixXd points;          ///< distinct points, active inputs only
  std::vector<int> active;         ///< indices of the inputs that vary
  Eigen::VectorXd low, high;       ///< d, range of every input over the runs
  std::vector<int> point_of_run;   ///< n, row of `points`
  std::vector<int> runs_of_point;  ///< how many runs each point has
  std::vector<InputGap> gaps;      ///< none: the process speaks for itself between the runs, too
};

/// Throws data::InputError (65) where the data cannot be a training set: sizes that differ, values that are not finite,
/// a negative variance, y <= 0 on the log scale, fewer than two runs.
Standardised standardise(const TrainingSet& training, OutputScale scale, Centre centre = Centre::data_mean);

/// For each row the number of its point, equal rows sharing one, in the order of their first row.
std::vector<int> points_of_rows(const Eigen::MatrixXd& x);

/// Values of an input of the unit cube that are closer than this are one level.
constexpr double same_level = 1e-6;

/// Sorted levels of one input.
std::vector<double> levels_of(const Eigen::VectorXd& column);

/// Which of the runs to learn from where they are more than `most`: whole points (replicates stay together), chosen at
/// random, in order. A fit costs the cube of their number and each prediction its square.
std::vector<int> thin(const TrainingSet& training, int most, std::uint64_t seed);

/// The runs of these numbers.
TrainingSet chosen(const TrainingSet& training, const std::vector<int>& runs);

/// What pooling makes of the runs, for one nugget variance, with derivatives with respect to the nugget.
struct Pooled {
  Eigen::VectorXd mean, variance;              ///< m, v of each distinct point
  Eigen::VectorXd mean_slope, variance_slope;  ///< dm/dg, dv/dg
  double log_likelihood = 0.0;                 ///< sum of E
  double log_likelihood_slope = 0.0;
};

Pooled pool(const Standardised& data, double nugget_variance);

}  // namespace surrogate

template <>
inline constexpr std::array data::texts_of<surrogate::OutputScale> = {"linear", "log"};
