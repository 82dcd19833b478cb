#pragma once
// The view that the samplers, the quadrature and the optimiser have of a posterior: a log density on a box, and a
// reference distribution from which chains start. They know nothing of DEM, surrogates or studies, so any density can
// be sampled.
//
//   log density   log p(x) + const on lower <= x <= upper, minus infinity outside
//   reference     a normalised density on the same box, wider than p: the prior of a posterior. Chains start from its
//                 draws and are tempered from it, log p_b = (1 - b) log reference + b log p
// The evidence is the integral of p over the box.
#include <Eigen/Dense>
#include <concepts>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "data/random.hpp"

namespace uq {

/// The log density outside of the support.
inline constexpr double nowhere = -std::numeric_limits<double>::infinity();

struct Evaluation {
  double value = nowhere;
  Eigen::VectorXd gradient;
};

/// Any type with a dimension and a log density.
template <class D>
concept LogDensity = requires(const D& density, const Eigen::VectorXd& x) {
  { density.dimension() } -> std::convertible_to<int>;
  { density.log_density(x) } -> std::convertible_to<double>;
};

/// A log density that also knows its gradient.
template <class D>
concept DifferentiableLogDensity = LogDensity<D> && requires(const D& density, const Eigen::VectorXd& x) {
  { density.log_density_gradient(x) } -> std::convertible_to<Evaluation>;
};

/// A log density that evaluates many points (rows) faster than one by one.
template <class D>
concept BatchLogDensity = LogDensity<D> && requires(const D& density, const Eigen::MatrixXd& points) {
  { density.log_densities(points) } -> std::convertible_to<Eigen::VectorXd>;
};

/// The distribution from which chains start.
struct Reference {
  std::function<Eigen::VectorXd(data::RandomStream&)> draw;
  std::function<double(const Eigen::VectorXd&)> log_density = {};  ///< normalised
};

/// Uniform on a finite box.
Reference uniform_reference(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

/// Independent normals.
Reference normal_reference(const Eigen::VectorXd& mean, const Eigen::VectorXd& sd);

/// A density with its type erased, its support and its reference. Callable from several threads at once.
struct Target {
  int dimension = 0;
  Eigen::VectorXd lower = {}, upper = {};  ///< support; may be infinite
  Reference reference = {};
  std::function<double(const Eigen::VectorXd&)> log_density = {};
  std::function<Evaluation(const Eigen::VectorXd&)> log_density_gradient = {};  ///< empty when there is none
  std::function<Eigen::VectorXd(const Eigen::MatrixXd&)> log_densities = {};  ///< of each row; empty when there is none

  bool contains(const Eigen::VectorXd& x) const {
    return (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
  }
};

/// Log densities of all rows of `points`; minus infinity outside the support and where the density is not a number.
Eigen::VectorXd evaluate(const Target& target, const Eigen::MatrixXd& points);

/// Wraps any density; `density` is copied. Use std::ref-like wrappers of your own for heavy ones.
template <LogDensity D>
Target make_target(const D& density, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                   const Reference& reference) {
  Target target{.dimension = density.dimension(), .lower = lower, .upper = upper, .reference = reference};
  target.log_density = [density](const Eigen::VectorXd& x) -> double { return density.log_density(x); };
  if constexpr (DifferentiableLogDensity<D>)
    target.log_density_gradient = [density](const Eigen::VectorXd& x) -> Evaluation {
      return density.log_density_gradient(x);
    };
  if constexpr (BatchLogDensity<D>)
    target.log_densities = [density](const Eigen::MatrixXd& points) -> Eigen::VectorXd {
      return density.log_densities(points);
    };
  return target;
}

}  // namespace uq
