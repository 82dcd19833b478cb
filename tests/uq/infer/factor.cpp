#include "uq/infer/factor.hpp"

#include <catch2/catch.hpp>

using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST_CASE(
    "the root of a covariance is one of what it is but for its rounding, and a covariance that is none is a defect") {
  // Rank two of sixty, with rounding of a millionth that makes eigenvalues negative.
  const VectorXd x = VectorXd::LinSpaced(60, -1.0, 1.0);
  const MatrixXd smooth = VectorXd::Ones(60) * VectorXd::Ones(60).transpose() + x * x.transpose();
  MatrixXd rounding = MatrixXd::Random(60, 60);
  rounding = 1e-6 * (rounding + rounding.transpose().eval());
  for (const MatrixXd& covariance : {smooth, MatrixXd(smooth + rounding), MatrixXd(MatrixXd::Zero(60, 60))}) {
    const MatrixXd root = uq::semidefinite_root(covariance, "a test");
    CHECK((root * root.transpose() - covariance).cwiseAbs().maxCoeff() < 5e-5);
  }
  CHECK_THROWS_AS(uq::semidefinite_root(smooth - 0.5 * MatrixXd::Identity(60, 60), "a test"), std::domain_error);
  CHECK_THROWS_AS(uq::semidefinite_root(MatrixXd::Constant(2, 2, NAN), "a test"), std::domain_error);
}
