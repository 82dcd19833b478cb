#pragma once
// The Fisher information at one point, in units of the prior: F = J' S^-1 J.
// J holds the slopes of the predicted data, dm/du, each column times its parameter's prior sd. S is the data's
// covariance, that of the nuisances under their priors included. An eigenvalue of F is the prior variance along its
// direction over the variance that the data alone would leave. Below 1 the data say less than the prior.
// The collinearity of the columns is 1 / sqrt(smallest eigenvalue of the Gram matrix of S^-1/2 J's unit columns)
// (Brun et al. 2001).
// These numbers are local, and mislead on curved ridges: the verdicts come from profiles.
#include <Eigen/Dense>

#include "uq/posterior/case_model.hpp"

namespace uq {

struct FisherSpectrum {
  Eigen::VectorXd eigenvalues;  ///< rising
  Eigen::MatrixXd directions;   ///< columns, in units of prior sds
  double condition = 0.0;       ///< largest over smallest eigenvalue; infinite when the smallest is zero to rounding
  double collinearity = 1.0;
  int known_directions = 0;  ///< number of eigenvalues above 1, of all unknowns, nuisances too
};

FisherSpectrum fisher_spectrum(const CaseModel& model, const Eigen::VectorXd& u);

/// Adds to a covariance of the data, SI^2, what the unknowns can move about u: parameters nearly freely, nuisances as
/// far as their priors let them. Of residuals, what a best fit could take away then counts for nothing.
void add_free_unknowns(const CaseModel& model, const Eigen::VectorXd& u, Eigen::MatrixXd& covariance);

}  // namespace uq
