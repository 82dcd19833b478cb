#include "uq/infer/log_density.hpp"

#include <cmath>
#include <numbers>

namespace uq {

Reference uniform_reference(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const double log_volume = (upper - lower).array().log().sum();
  return {.draw =
              [lower, upper](data::RandomStream& random) {
                Eigen::VectorXd x(lower.size());
                for (Eigen::Index k = 0; k < x.size(); ++k) x[k] = random.uniform(lower[k], upper[k]);
                return x;
              },
          .log_density =
              [lower, upper, log_volume](const Eigen::VectorXd& x) {
                const bool inside = (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
                return inside ? -log_volume : nowhere;
              }};
}

Reference normal_reference(const Eigen::VectorXd& mean, const Eigen::VectorXd& sd) {
  const double constant =
      -sd.array().log().sum() - 0.5 * static_cast<double>(sd.size()) * std::log(2.0 * std::numbers::pi);
  return {.draw =
              [mean, sd](data::RandomStream& random) {
                Eigen::VectorXd x(mean.size());
                for (Eigen::Index k = 0; k < x.size(); ++k) x[k] = mean[k] + sd[k] * random.normal();
                return x;
              },
          .log_density =
              [mean, sd, constant](const Eigen::VectorXd& x) {
                return constant - 0.5 * ((x - mean).array() / sd.array()).square().sum();
              }};
}

Eigen::VectorXd evaluate(const Target& target, const Eigen::MatrixXd& points) {
  Eigen::VectorXd values = Eigen::VectorXd::Constant(points.rows(), nowhere);
  std::vector<Eigen::Index> inside;
  inside.reserve(static_cast<std::size_t>(points.rows()));
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (target.contains(points.row(i).transpose())) inside.push_back(i);
  if (inside.empty()) return values;
  if (target.log_densities) {
    Eigen::MatrixXd kept(static_cast<Eigen::Index>(inside.size()), points.cols());
    for (std::size_t i = 0; i < inside.size(); ++i) kept.row(i) = points.row(inside[i]);
    const Eigen::VectorXd found = target.log_densities(kept);
    for (std::size_t i = 0; i < inside.size(); ++i) values[inside[i]] = found[i];
  } else {
    for (const Eigen::Index i : inside) values[i] = target.log_density(points.row(i).transpose());
  }
  for (double& value : values)
    if (std::isnan(value)) value = nowhere;
  return values;
}

}  // namespace uq
