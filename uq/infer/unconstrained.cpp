#include "uq/infer/unconstrained.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace uq {
namespace {

enum class Ends { none, low, high, both };

Ends ends(const Target& target, Eigen::Index k) {
  const bool low = std::isfinite(target.lower[k]), high = std::isfinite(target.upper[k]);
  return low ? (high ? Ends::both : Ends::low) : (high ? Ends::high : Ends::none);
}

double sigmoid(double z) { return z >= 0.0 ? 1.0 / (1.0 + std::exp(-z)) : std::exp(z) / (1.0 + std::exp(z)); }

}  // namespace

Eigen::VectorXd to_unconstrained(const Target& target, const Eigen::VectorXd& x) {
  Eigen::VectorXd z(x.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const double low = target.lower[k], high = target.upper[k];
    switch (ends(target, k)) {
      case Ends::both: {
        const double share = std::clamp((x[k] - low) / (high - low), 1e-12, 1.0 - 1e-12);
        z[k] = std::log(share / (1.0 - share));
        break;
      }
      case Ends::low:
        z[k] = std::log(std::max(x[k] - low, 1e-300));
        break;
      case Ends::high:
        z[k] = std::log(std::max(high - x[k], 1e-300));
        break;
      case Ends::none:
        z[k] = x[k];
        break;
    }
  }
  return z;
}

Eigen::VectorXd from_unconstrained(const Target& target, const Eigen::VectorXd& z) {
  Eigen::VectorXd x(z.size());
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    const double low = target.lower[k], high = target.upper[k];
    switch (ends(target, k)) {
      case Ends::both:
        x[k] = std::clamp(low + (high - low) * sigmoid(z[k]), low, high);
        break;
      case Ends::low:
        x[k] = low + std::exp(z[k]);
        break;
      case Ends::high:
        x[k] = high - std::exp(z[k]);
        break;
      case Ends::none:
        x[k] = z[k];
        break;
    }
  }
  return x;
}

double log_jacobian(const Target& target, const Eigen::VectorXd& z) {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < z.size(); ++k) switch (ends(target, k)) {
      case Ends::both:
        // log s + log(1 - s) = -|z| - 2 log(1 + exp(-|z|))
        sum +=
            std::log(target.upper[k] - target.lower[k]) - std::abs(z[k]) - 2.0 * std::log1p(std::exp(-std::abs(z[k])));
        break;
      case Ends::low:
      case Ends::high:
        sum += z[k];
        break;
      case Ends::none:
        break;
    }
  return sum;
}

Evaluation unconstrained_density(const Target& target, const Eigen::VectorXd& z) {
  Evaluation found = target.log_density_gradient(from_unconstrained(target, z));
  found.value += log_jacobian(target, z);
  for (Eigen::Index k = 0; k < z.size(); ++k) switch (ends(target, k)) {
      case Ends::both: {
        const double width = target.upper[k] - target.lower[k], share = sigmoid(z[k]);
        found.gradient[k] = found.gradient[k] * width * share * (1.0 - share) + 1.0 - 2.0 * share;
        break;
      }
      case Ends::low:
      case Ends::high:
        found.gradient[k] = found.gradient[k] * (ends(target, k) == Ends::low ? 1.0 : -1.0) * std::exp(z[k]) + 1.0;
        break;
      case Ends::none:
        break;
    }
  return found;
}

Target unconstrained_target(const Target& target) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Target whole{.dimension = target.dimension,
               .lower = Eigen::VectorXd::Constant(target.dimension, -infinity),
               .upper = Eigen::VectorXd::Constant(target.dimension, infinity)};
  whole.reference.draw = [target](data::RandomStream& random) {
    return to_unconstrained(target, target.reference.draw(random));
  };
  whole.reference.log_density = [target](const Eigen::VectorXd& z) {
    return target.reference.log_density(from_unconstrained(target, z)) + log_jacobian(target, z);
  };
  whole.log_density = [target](const Eigen::VectorXd& z) {
    return target.log_density(from_unconstrained(target, z)) + log_jacobian(target, z);
  };
  if (target.log_density_gradient)
    whole.log_density_gradient = [target](const Eigen::VectorXd& z) { return unconstrained_density(target, z); };
  whole.log_densities = [target](const Eigen::MatrixXd& points) {
    Eigen::MatrixXd x(points.rows(), points.cols());
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      x.row(i) = from_unconstrained(target, points.row(i).transpose()).transpose();
    Eigen::VectorXd values = evaluate(target, x);
    for (Eigen::Index i = 0; i < points.rows(); ++i) values[i] += log_jacobian(target, points.row(i).transpose());
    return values;
  };
  return whole;
}

}  // namespace uq
