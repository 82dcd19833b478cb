#include "uq/infer/laplace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace uq {
namespace {

/// The target about the point of an approximation.
struct Surroundings {
  const Target& target;
  const Eigen::VectorXd& x;
  double top;  ///< log density at x
};

double value_at(const Target& target, const Eigen::VectorXd& x) {
  if (!target.contains(x)) return nowhere;
  const double found = target.log_density(x);
  return std::isnan(found) ? nowhere : found;
}

/// How far the log density falls at a step along coordinate k, a mean over the sides that lie inside the support.
struct Fall {
  double mean = std::numeric_limits<double>::infinity();
  bool at_bound = false;  ///< a side lies outside
};

Fall fall_along(const Surroundings& about, Eigen::Index k, double step) {
  double sum = 0.0;
  int sides = 0;
  for (const double sign : {-1.0, 1.0}) {
    Eigen::VectorXd at = about.x;
    at[k] += sign * step;
    if (!about.target.contains(at)) continue;
    sum += about.top - value_at(about.target, at);
    ++sides;
  }
  Fall fall{.at_bound = sides < 2};
  if (sides > 0) fall.mean = sum / sides;
  return fall;
}

/// Steps along which the log density falls by about a half: one conditional standard deviation.
Eigen::VectorXd half_fall_steps(const Surroundings& about, const Eigen::VectorXd& width) {
  Eigen::VectorXd step = 0.1 * width;
  for (Eigen::Index k = 0; k < step.size(); ++k)
    for (int i = 0; i < 30; ++i) {
      const double fall = fall_along(about, k, step[k]).mean;
      if (fall > 0.2 && fall < 1.0) break;
      if (!(fall > 1e-4) && step[k] >= width[k]) break;
      step[k] *= std::clamp(fall > 0.0 ? std::sqrt(0.5 / fall) : 3.0, 0.05, 3.0);
      step[k] = std::min(step[k], width[k]);
    }
  return step;
}

/// Minus the mixed second difference along coordinates k and l, in units of the steps.
double mixed_difference(const Surroundings& about, const Eigen::VectorXd& step, Eigen::Index k, Eigen::Index l) {
  double mixed = 0.0;
  for (const double a : {-0.5, 0.5})
    for (const double b : {-0.5, 0.5}) {
      Eigen::VectorXd at = about.x;
      at[k] += a * step[k];
      at[l] += b * step[l];
      mixed -= (a * b > 0.0 ? 1.0 : -1.0) * value_at(about.target, at);
    }
  return mixed;
}

/// Minus the second derivatives, in units of the steps. A coordinate at a bound is related to no other.
Eigen::MatrixXd curvature_in_steps(const Surroundings& about, const Eigen::VectorXd& step) {
  const Eigen::Index d = step.size();
  Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(d, d);
  std::vector<bool> at_bound;
  for (Eigen::Index k = 0; k < d; ++k) {
    const Fall fall = fall_along(about, k, step[k]);
    curvature(k, k) = std::max(2.0 * std::min(fall.mean, 4.0), 0.0);
    at_bound.push_back(fall.at_bound);
  }
  for (Eigen::Index k = 0; k < d; ++k)
    for (Eigen::Index l = 0; l < k; ++l) {
      if (at_bound[k] || at_bound[l]) continue;
      const double mixed = mixed_difference(about, step, k, l);
      if (std::isfinite(mixed)) curvature(k, l) = curvature(l, k) = mixed;
    }
  return curvature;
}

/// The normal law of an approximation: its covariance is root root'.
struct Ellipsoid {
  Eigen::MatrixXd root;
  Eigen::VectorXd variance;  ///< along the axes, in units of the steps
};

/// The inverse of the curvature, no flatter than the width allows.
Ellipsoid inverse_of(const Eigen::MatrixXd& curvature, const Eigen::VectorXd& step, const Eigen::VectorXd& width) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(curvature);
  Ellipsoid found{.root = {}, .variance = Eigen::VectorXd(step.size())};
  for (Eigen::Index k = 0; k < step.size(); ++k) {
    const Eigen::VectorXd direction = step.cwiseProduct(solver.eigenvectors().col(k));
    const double flattest = direction.cwiseQuotient(width).squaredNorm();  // (length in widths)^2 of one unit
    found.variance[k] = 1.0 / std::max(solver.eigenvalues()[k], flattest);
  }
  found.root = step.asDiagonal() * solver.eigenvectors() * found.variance.cwiseSqrt().asDiagonal();
  return found;
}

/// The ellipsoid with each axis shortened to where the log density falls by 2 at most.
Ellipsoid shortened(const Surroundings& about, Ellipsoid ellipsoid) {
  for (Eigen::Index k = 0; k < ellipsoid.root.cols(); ++k)
    for (int i = 0; i < 20; ++i) {
      const Eigen::VectorXd there = about.x + ellipsoid.root.col(k), back = about.x - ellipsoid.root.col(k);
      const double least = about.top - std::max(value_at(about.target, there), value_at(about.target, back));
      if (least <= 2.0) break;
      ellipsoid.root.col(k) *= 0.7;
      ellipsoid.variance[k] *= 0.49;
    }
  return ellipsoid;
}

}  // namespace

Peak laplace(const Target& target, const Eigen::VectorXd& x, const Eigen::VectorXd& width) {
  const Surroundings about{.target = target, .x = x, .top = value_at(target, x)};
  const Eigen::VectorXd step = half_fall_steps(about, width);
  const Ellipsoid found = shortened(about, inverse_of(curvature_in_steps(about, step), step, width));
  return {.x = x,
          .log_density = about.top,
          .covariance = found.root * found.root.transpose(),
          .log_mass = about.top + 0.5 * static_cast<double>(x.size()) * std::log(2.0 * std::numbers::pi) +
                      0.5 * found.variance.array().log().sum() + step.array().log().sum()};
}

}  // namespace uq
