#include "uq/infer/factor.hpp"

#include <stdexcept>
#include <string>

namespace uq {
namespace {

// The largest jitter that may be added to all variances, as a share of the largest one. It is the rounding of what is
// left of a prior a million times as wide.
constexpr double rounding_most = 1e-4;

}  // namespace

Factor factor(Eigen::MatrixXd covariance, const char* what) {
  const Eigen::VectorXd diagonal = covariance.diagonal();
  if (covariance.allFinite())
    for (double jitter = 0.0; jitter < 1.1e-6; jitter = jitter == 0.0 ? 1e-14 : 10.0 * jitter) {
      Eigen::MatrixXd raised = covariance;
      raised.diagonal() += jitter * diagonal;
      Factor found{.llt = Eigen::LLT<Eigen::MatrixXd>(raised), .jitter = jitter};
      if (found.llt.info() == Eigen::Success) return found;
    }
  throw std::domain_error(std::string("the covariance of ") + what + " is not positive definite");
}

Eigen::MatrixXd semidefinite_root(const Eigen::MatrixXd& covariance, const char* what) {
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(covariance);
  const Eigen::VectorXd parts = ldlt.vectorD();
  const double scale = covariance.diagonal().cwiseAbs().maxCoeff();
  const std::string defect = std::string("the covariance of ") + what + " is not positive semidefinite";
  if (!covariance.allFinite()) throw std::domain_error(defect);
  if (ldlt.info() != Eigen::Success || !(parts.minCoeff() >= -1e-8 * scale)) {
    for (double share = 1e-8; share < 1.1 * rounding_most; share *= 10.0) {
      const Eigen::LLT<Eigen::MatrixXd> llt(covariance +
                                            share * scale * Eigen::MatrixXd::Identity(parts.size(), parts.size()));
      if (llt.info() == Eigen::Success) return llt.matrixL();
    }
    throw std::domain_error(defect);
  }
  const Eigen::MatrixXd lower = ldlt.matrixL();
  return ldlt.transpositionsP().transpose() * Eigen::MatrixXd(lower * parts.cwiseMax(0.0).cwiseSqrt().asDiagonal());
}

Eigen::MatrixXd factor_for_proposal(Eigen::MatrixXd covariance) {
  const Eigen::VectorXd diagonal = covariance.diagonal().cwiseMax(1e-300);
  for (double ridge = 1e-10; ridge < 1.0; ridge *= 10.0) {
    const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
    if (llt.info() == Eigen::Success && llt.matrixLLT().diagonal().minCoeff() > 0.0) return llt.matrixL();
    covariance.diagonal() += ridge * diagonal;
  }
  return diagonal.cwiseSqrt().asDiagonal();
}

}  // namespace uq
