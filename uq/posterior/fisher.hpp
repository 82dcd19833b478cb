#pragma once
// Local sensitivities at one point. J = dm/du of the parameters, each column times its prior's sd; S the covariance of
// the data at the point, that of the nuisances under their priors included:
//   F = J' S^-1 J          eigenvalues: how many prior sds (squared, inverse) each direction is known to
//   collinearity 1 / sqrt(smallest eigenvalue of the Gram matrix of S^-1/2 J's unit columns)   (Brun et al. 2001)
// An eigenvalue below 1 is a direction of which the data say less than the prior. It is local, and misleads on curved
// ridges: the verdicts come from profiles.
#include <Eigen/Dense>

#include "uq/posterior/case_model.hpp"

namespace uq {

struct FisherSpectrum {
  Eigen::VectorXd eigenvalues;  ///< rising
  Eigen::MatrixXd directions;   ///< columns, in units of prior sds
  double condition = 0.0;       ///< largest over smallest eigenvalue; infinite when the smallest is zero to rounding
  double collinearity = 1.0;
  int known_directions = 0;  ///< of all unknowns, nuisances too: eigenvalues above 1
};

FisherSpectrum fisher_spectrum(const CaseModel& model, const Eigen::VectorXd& u);

}  // namespace uq
