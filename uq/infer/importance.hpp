#pragma once
// Importance sampling of a density p by draws of a mixture q that is cut at p's support.
//
//   Z = integral p dx = mean of w over all tries,  w = p(x) / q(x), zero outside the support
//   efficiency = (sum w)^2 / (n sum w^2),          the share of an independent draw that one proposal is worth
//   k-hat: shape of the generalised Pareto law of the largest weights, fitted as by J. Zhang, M. A. Stephens,
//          Technometrics 51 (2009) 316. Above 0.7 neither Z nor its error can be trusted: A. Vehtari, D. Simpson,
//          A. Gelman, Y. Yao, J. Gabry, "Pareto smoothed importance sampling", J. Mach. Learn. Res. 25 (2024) 72.
#include <Eigen/Dense>
#include <limits>
#include <vector>

#include "uq/infer/log_density.hpp"
#include "uq/infer/student_mixture.hpp"

namespace uq {

inline constexpr double pareto_shape_max = 0.7;

/// Draws from the mixture inside the support. `tries` counts the draws outside, too.
struct Proposals {
  Eigen::MatrixXd x;
  Eigen::VectorXd log_density, log_proposal;
  double tries = 0.0;
};
Proposals propose(const Target& target, const Mixture& mixture, int count, data::RandomStream& random);

/// Weights of proposals relative to the largest.
struct Weights {
  Eigen::VectorXd values;
  double efficiency = 0.0;
  double log_evidence = nowhere;
};
Weights importance_weights(const Proposals& made);

/// The log weights, collected as they come, for the evidence that is made of them.
struct WeightRecord {
  std::vector<double> log_weights;  ///< log weights of the proposals inside the support
  double tries = 0.0;
  void add(const WeightRecord& other);
};
struct Evidence {
  double log_value = std::numeric_limits<double>::quiet_NaN();
  double error = std::numeric_limits<double>::quiet_NaN();         ///< standard error of log_value
  double pareto_shape = std::numeric_limits<double>::quiet_NaN();  ///< k-hat
  double largest_share = 0.0;                                      ///< share of the largest weight in the sum of all
  /// Whether the evidence is doubtful: the tail is heavy, and one of its draws counts. Without such a draw the tail's
  /// shape is a guess, and k-hat alone exceeds its bound in one of a hundred posteriors that are sampled rightly.
  bool doubtful() const { return pareto_shape > pareto_shape_max && largest_share > 0.03; }
};
Evidence evidence_of(const WeightRecord& record);

/// k-hat of weights given by their logarithms; NaN with fewer than 25 of them.
double pareto_shape(std::vector<double> log_weights);

}  // namespace uq
