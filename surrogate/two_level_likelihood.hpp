#pragma once
// Likelihood of the high level's runs, shared by two_level.cpp and two_level_fit.cpp only.
#include "surrogate/two_level.hpp"

namespace surrogate {

constexpr double longest_discrepancy = 1.0;  ///< unit cube: its length scales at q = 1 are the low level's up to this

/// Correlations of the discrepancy between the rows of `a` and `b`.
Eigen::MatrixXd discrepancy_correlations(const GaussianProcess& low, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                         double length_factor);

/// Generalised least squares of the high runs for one setting.
struct HighFit {
  bool ok = false;
  double log_likelihood = 0.0;
  double jitter = 0.0;  ///< relative to the mean variance of a run
  Eigen::MatrixXd factor, whitened_basis, basis_factor;
  Eigen::VectorXd weights, coefficients;
};

HighFit fit_high(const GaussianProcess& low, const Prediction& low_at_high, const TrainingSet& high, MeanBasis mean,
                 const TwoLevelParameters& parameters);

}  // namespace surrogate
