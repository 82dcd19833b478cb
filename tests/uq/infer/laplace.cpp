// Laplace's approximation where it is exact.
#include "uq/infer/laplace.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/uq/infer/adversaries.hpp"

using namespace uq;

TEST_CASE("a normal's Laplace mass and covariance are its own, whatever its tilt", "[uq]") {
  Eigen::Matrix3d root;
  root << 0.02, 0, 0, 0.019, 0.003, 0, -0.01, 0.001, 0.05;
  const Eigen::Matrix3d covariance = root * root.transpose(), precision = covariance.inverse();
  const Eigen::Vector3d centre(0.3, 0.6, 0.5);
  struct Tilted {
    Eigen::Matrix3d precision;
    Eigen::Vector3d centre;
    int dimension() const { return 3; }
    double log_density(const Eigen::VectorXd& x) const { return -0.5 * (x - centre).dot(precision * (x - centre)); }
  };
  const Target target =
      adversaries::on_box(Tilted{precision, centre}, Eigen::VectorXd::Zero(3), Eigen::VectorXd::Ones(3));
  const Peak mode = laplace(target, centre, Eigen::VectorXd::Constant(3, 0.25));
  CHECK((mode.covariance - covariance).norm() < 1e-6 * covariance.norm());
  const double exact = 1.5 * std::log(2.0 * std::numbers::pi) + root.diagonal().array().log().sum();
  CHECK(mode.log_mass == Approx(exact).margin(1e-6));
}
