#pragma once
// The objective of a fit and its local maximisers.
#include <Eigen/Core>

#include "surrogate/fit.hpp"

namespace surrogate {

/// Log likelihood (plus log prior) over u with its box.
struct Objective {
  Likelihood& likelihood;
  Eigen::VectorXd low, high;                    ///< box of u
  Eigen::VectorXd prior_mean, prior_precision;  ///< of u; precision 0: flat
};

Objective make_objective(Likelihood& likelihood, const FitOptions& options);
LikelihoodGradient evaluate(const Objective& objective, const Eigen::VectorXd& u);
/// The objective's value without its gradient, at half the cost; -infinity where the covariance cannot be factorised.
double evaluate_value(const Objective& objective, const Eigen::VectorXd& u);

/// Maximises by damped Newton steps on the average information, then by L-BFGS if they did not converge.
StartOutcome maximise(const Objective& objective, const Eigen::VectorXd& start, const FitOptions& options);
StartOutcome maximise_lbfgs(const Objective& objective, const Eigen::VectorXd& start, const FitOptions& options);

}  // namespace surrogate
