#pragma once
// Likelihood of the high level's runs, shared by two_level.cpp and two_level_fit.cpp only.
#include "surrogate/two_level.hpp"

namespace surrogate {

constexpr double longest_discrepancy = 1.0;  ///< unit cube: its length scales at q = 1 are the low level's up to this

/// Length scales of the discrepancy at q = 1, unit cube.
Eigen::VectorXd discrepancy_lengths(const GaussianProcess& low);

/// Points (one per row) in units of these lengths.
Eigen::MatrixXd scaled_points(const Eigen::MatrixXd& points, const Eigen::VectorXd& lengths);

/// Correlations of the discrepancy, c(r / q), from the square distances r^2 at q = 1.
void discrepancy_correlations(Kernel kernel, const Eigen::MatrixXd& squares, double length_factor,
                              Eigen::MatrixXd& scratch, Eigen::MatrixXd& value);

/// The high runs and the low level's predictions of them.
struct HighProblem {
  Kernel kernel;
  const TrainingSet& runs;
  MeanBasis mean;
  Prediction low_at_high;
  Eigen::MatrixXd squares;  ///< square distances of the runs at q = 1
};
HighProblem high_problem(const GaussianProcess& low, const TrainingSet& high, MeanBasis mean);

/// Generalised least squares of the high runs for one setting.
struct HighFit {
  bool ok = false;
  double log_likelihood = 0.0;
  double jitter = 0.0;  ///< relative to the mean variance of a run
  Eigen::MatrixXd factor, whitened_basis, basis_factor;
  Eigen::VectorXd weights, coefficients;
};

HighFit fit_high(const HighProblem& problem, const TwoLevelParameters& parameters);

}  // namespace surrogate
