#pragma once
// A target on the whole space. Each bounded coordinate is mapped there, and the map's Jacobian enters the density.
//   both ends finite  x = l + (h - l) s(z),  s = 1 / (1 + exp(-z)),  log dx/dz = log(h - l) + log s + log(1 - s)
//   one end finite    x = l + exp(z)  or  x = h - exp(z),            log dx/dz = z
//   neither           x = z
#include <Eigen/Dense>

#include "uq/infer/log_density.hpp"

namespace uq {

Eigen::VectorXd to_unconstrained(const Target& target, const Eigen::VectorXd& x);
Eigen::VectorXd from_unconstrained(const Target& target, const Eigen::VectorXd& z);

/// Log density of z and its gradient. Needs target.log_density_gradient.
Evaluation unconstrained_density(const Target& target, const Eigen::VectorXd& z);

/// Log of the map's Jacobian |dx/dz|.
double log_jacobian(const Target& target, const Eigen::VectorXd& z);

/// The density of z as a target of its own, for samplers that know nothing of the map. Its reference has a log density
/// where the target's has one.
Target unconstrained_target(const Target& target);

}  // namespace uq
