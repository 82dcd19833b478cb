#pragma once
// Densities with known answers, for the tests of samplers and quadrature.
#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "uq/infer/log_density.hpp"

namespace densities {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Gaussian {
  VectorXd mean, sd;
  int dimension() const { return static_cast<int>(mean.size()); }
  double log_density(const VectorXd& x) const { return -0.5 * ((x - mean).array() / sd.array()).square().sum(); }
  uq::Evaluation log_density_gradient(const VectorXd& x) const {
    const VectorXd slope = -((x - mean).array() / sd.array().square()).matrix();
    return {.value = log_density(x), .gradient = slope};
  }
};

struct Nowhere {
  int dimension() const { return 1; }
  double log_density(const VectorXd&) const { return -std::numeric_limits<double>::infinity(); }
};

/// Rosenbrock-like, in [-4, 4] x [-2, 10].
struct Banana {
  int dimension() const { return 2; }
  double log_density(const VectorXd& x) const { return log_density_gradient(x).value; }
  uq::Evaluation log_density_gradient(const VectorXd& x) const {
    const double across = (x[1] - x[0] * x[0]) / 0.2;
    VectorXd slope(2);
    slope << -x[0] + 2.0 * x[0] * across / 0.2, -across / 0.2;
    return {.value = -0.5 * (x[0] * x[0] + across * across), .gradient = slope};
  }
};

/// A ridge of the given width from a corner bound: x + y = 0.6 on the unit square, with a slow fall along it.
struct Ridge {
  double width = 0.01;
  int dimension() const { return 2; }
  double log_density(const VectorXd& x) const { return log_density_gradient(x).value; }
  uq::Evaluation log_density_gradient(const VectorXd& x) const {
    const double across = (x[0] + x[1] - 0.6) / width;
    VectorXd slope(2);
    slope << -across / width, -across / width + 3.0;
    return {.value = -0.5 * across * across + 3.0 * x[1], .gradient = slope};
  }
};

/// A hyperbola: x y = 0.1 to the given width, on the unit square.
struct Product {
  double width = 0.01;
  int dimension() const { return 2; }
  double log_density(const VectorXd& x) const { return log_density_gradient(x).value; }
  uq::Evaluation log_density_gradient(const VectorXd& x) const {
    const double across = (x[0] * x[1] - 0.1) / width;
    VectorXd slope(2);
    slope << -across * x[1] / width, -across * x[0] / width;
    return {.value = -0.5 * across * across, .gradient = slope};
  }
};

inline constexpr double second_mode_share = 0.3;

struct TwoModes {
  int dimension() const { return 2; }
  double log_density(const VectorXd& x) const {
    const double sd = 0.03;
    const double first =
        std::log(1.0 - second_mode_share) - 0.5 * (x - VectorXd::Constant(2, 0.25)).squaredNorm() / (sd * sd);
    const double second =
        std::log(second_mode_share) - 0.5 * (x - VectorXd::Constant(2, 0.75)).squaredNorm() / (sd * sd);
    return std::max(first, second) + std::log1p(std::exp(-std::abs(first - second)));
  }
};

/// Equicorrelated standard normal, normalised.
struct Correlated {
  MatrixXd precision;
  double constant = 0.0;
  int dimension() const { return static_cast<int>(precision.rows()); }
  double log_density(const VectorXd& x) const { return constant - 0.5 * x.dot(precision * x); }
  uq::Evaluation log_density_gradient(const VectorXd& x) const {
    return {.value = log_density(x), .gradient = -precision * x};
  }
};

inline uq::Target on_box(const uq::LogDensity auto& density, const VectorXd& lower, const VectorXd& upper) {
  return uq::make_target(density, lower, upper, uq::uniform_reference(lower, upper));
}
inline uq::Target on_unit_square(const uq::LogDensity auto& density) {
  return on_box(density, VectorXd::Zero(2), VectorXd::Ones(2));
}

inline uq::Target banana() { return on_box(Banana{}, Eigen::Vector2d(-4.0, -2.0), Eigen::Vector2d(4.0, 10.0)); }
inline uq::Target ridge_at_bound(double width) { return on_unit_square(Ridge{width}); }
inline uq::Target product_ridge(double width) { return on_unit_square(Product{width}); }
inline uq::Target two_modes() { return on_unit_square(TwoModes{}); }
inline uq::Target correlated(int dimension, double correlation) {
  MatrixXd covariance = MatrixXd::Constant(dimension, dimension, correlation);
  covariance.diagonal().setOnes();
  const Eigen::LLT<MatrixXd> llt(covariance);
  const double log_determinant = 2.0 * MatrixXd(llt.matrixL()).diagonal().array().log().sum();
  const Correlated density{.precision = llt.solve(MatrixXd::Identity(dimension, dimension)),
                           .constant = -0.5 * (log_determinant + dimension * std::log(2.0 * std::numbers::pi))};
  const VectorXd infinite = VectorXd::Constant(dimension, std::numeric_limits<double>::infinity());
  return uq::make_target(density, -infinite, infinite,
                         uq::normal_reference(VectorXd::Zero(dimension), VectorXd::Constant(dimension, 5.0)));
}

}  // namespace densities
