#pragma once
// A mixture of multivariate Student-t densities fitted to weighted points: the proposal of the global moves and of the
// importance-sampled evidence.
//
//   q(x) = sum_k w_k t_nu(x; m_k, s^2 C_k),   nu = 8,  s^2 = 1.1
// m_k, C_k, w_k are a Gaussian mixture's by expectation maximisation (Dempster, Laird, Rubin 1977), its number of
// components by the Bayesian information criterion. The t's heavier tails and the inflation s keep the ratio p / q
// bounded where a posterior has tails that the points did not reach; so does, beside several components, a wide one of
// a tenth of the weight over them all (T. Hesterberg, "Weighted average importance sampling and defensive mixture
// distributions", Technometrics 37 (1995) 185).
#include <Eigen/Dense>
#include <vector>

#include "data/random.hpp"

namespace uq {

struct MixtureComponent {
  double weight = 1.0;
  Eigen::VectorXd mean;
  Eigen::MatrixXd factor;     ///< lower Cholesky factor of s^2 C_k
  double log_constant = 0.0;  ///< log of weight times the t density's constant
};

struct Mixture {
  std::vector<MixtureComponent> components;
  int fitted = 0;  ///< components that were fitted; one more, if there is one, is the wide one
  double log_density(const Eigen::VectorXd& x) const;
  Eigen::VectorXd log_densities(const Eigen::MatrixXd& points) const;  ///< log density of each row
  Eigen::ArrayXXd log_terms(const Eigen::MatrixXd& points) const;      ///< points x components
  Eigen::VectorXd draw(data::RandomStream& random) const;
};

struct MixtureOptions {
  int components_max = 64;  ///< largest number of components tried
  int iterations = 60;      ///< iterations of expectation maximisation
  double tolerance = 1e-3;  ///< stop when the mean log density rises by less: a thousandth of a proposal's worth
};

/// Fits a mixture to the rows of `points` with non-negative `weights` (any scale). Given a mixture `before` that was
/// fitted to much the same points, it goes on from there, and tries no other number of components but the next larger
/// one.
Mixture fit_mixture(const Eigen::MatrixXd& points, const Eigen::VectorXd& weights, data::RandomStream& random,
                    const MixtureOptions& options = {}, const Mixture* before = nullptr);

/// The mixture with components at its end that no fit to points moves. Their weights are shares of the whole, at most
/// half of it.
Mixture with_kept(Mixture mixture, const std::vector<MixtureComponent>& kept);

/// The mixture with further components, whose weights are shares of the whole.
Mixture with_components(Mixture mixture, const std::vector<MixtureComponent>& added);

}  // namespace uq
