#pragma once
// Draws of a sampler and measures of their quality.
#include <Eigen/Dense>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace uq {

/// One chain after warm-up.
struct Chain {
  Eigen::MatrixXd x;            ///< draws x dimension
  Eigen::VectorXd log_density;  ///< log density of each draw
  Eigen::VectorXd acceptance;   ///< acceptance statistic of each draw
  Eigen::VectorXd energy;       ///< Hamiltonian of each draw (NUTS); empty otherwise
  std::vector<int> tree_depth;  ///< NUTS; empty otherwise
  std::vector<bool> diverged;   ///< NUTS; empty otherwise
};

struct Draws {
  std::vector<Chain> chains;
  std::string sampler;  ///< "mixture" or "nuts"
  bool converged = false;
  std::string reason;                        ///< when not converged: the rule that was missed
  Eigen::VectorXd rhat, ess_bulk, ess_tail;  ///< per coordinate
  int divergences = 0;
  double log_evidence = 0.0;         ///< log integral of the density; NaN when the sampler does not give it
  double log_evidence_error = 0.0;   ///< standard error of the log evidence
  double proposal_efficiency = 0.0;  ///< share of an independent draw that one proposal of the mixture is worth
  double pareto_shape = std::numeric_limits<double>::quiet_NaN();  ///< k-hat of the evidence's weights
  int scouts = 0;                ///< reference draws among which unknown maxima were looked for
  int searched_starts = 0;       ///< places from which unknown maxima were looked for
  int found_modes = 0;           ///< maxima that the search added to the proposal
  std::int64_t evaluations = 0;  ///< evaluations of the log density, warm-up included

  int dimension() const { return chains.empty() ? 0 : static_cast<int>(chains.front().x.cols()); }
  /// Draws of one coordinate as iterations x chains, for the diagnostics.
  Eigen::MatrixXd coordinate(int k) const;
  /// All draws, chain after chain.
  Eigen::MatrixXd pooled() const;
  Eigen::VectorXd pooled_log_density() const;
};

/// The rule by which a sampler may stop.
struct StopRule {
  double rhat_max = 1.01;        ///< R-hat of every coordinate
  double ess_per_chain = 100.0;  ///< effective sample size, bulk and tail, of every coordinate
  double ess_bulk = 1000.0;      ///< effective sample size over all chains, of every coordinate
};

/// Fills rhat, ess_bulk, ess_tail, converged and reason.
void assess(Draws& draws, const StopRule& rule);

}  // namespace uq
