#pragma once
// Cholesky factors whose status is looked at. A covariance that is singular to rounding gets a jitter on its diagonal,
// from 1e-14 to 1e-6 of it; what still has no factor, or holds a number that is not finite, is a defect and is thrown.
#include <Eigen/Dense>

namespace uq {

struct Factor {
  Eigen::LLT<Eigen::MatrixXd> llt;
  double jitter = 0.0;  ///< share of the diagonal that was added to it
};

/// The Cholesky factor of a covariance. Throws std::domain_error that names `what`.
Factor factor(Eigen::MatrixXd covariance, const char* what);

/// A root R of a covariance that may be singular, or zero: R R' = covariance, by LDL'. A covariance that is negative
/// somewhere by rounding gets as little of its largest variance added as makes it positive, at most a ten thousandth.
/// Beyond this it throws as above.
Eigen::MatrixXd semidefinite_root(const Eigen::MatrixXd& covariance, const char* what);

/// The factor of a covariance with a ridge that grows until there is a factor; the diagonal's roots where there is
/// none. It is for covariances that only shape a proposal, where no result depends on them.
Eigen::MatrixXd factor_for_proposal(Eigen::MatrixXd covariance);

}  // namespace uq
