#pragma once
// Laplace's approximation of a density about a point that is about a maximum of it.
//
//   p(x + s) ~ p(x) exp(-s' H s / 2),   mass  p(x) (2 pi)^(d/2) |H|^(-1/2)
//
// H comes from differences over steps along which the log density falls by about a half, one conditional standard
// deviation each. No direction is flatter than the width given. Each axis of the ellipsoid is shortened to where p
// still is of the maximum's order, so that on a curved ridge the mass is that of a straight piece.
#include <Eigen/Dense>

#include "uq/infer/log_density.hpp"

namespace uq {

struct Peak {
  Eigen::VectorXd x;
  double log_density = 0.0;
  Eigen::MatrixXd covariance;  ///< covariance of Laplace's approximation
  double log_mass = 0.0;       ///< log of the mass by Laplace's approximation
};

/// Laplace's approximation at x; `width` bounds its standard deviations.
Peak laplace(const Target& target, const Eigen::VectorXd& x, const Eigen::VectorXd& width);

}  // namespace uq
