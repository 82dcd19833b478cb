#pragma once
// The proposal of a sampler's global moves, adapted by population Monte Carlo (O. Cappe, A. Guillin, J.-M. Marin,
// C. P. Robert, J. Comput. Graph. Stat. 13 (2004) 907): a mixture (uq/infer/student_mixture.hpp) is fitted to points of
// the density, then again and again to its own importance-weighted draws while these become better.
#include "uq/infer/explore.hpp"
#include "uq/infer/importance.hpp"

namespace uq {

struct ProposalOptions {
  int refits_max = 5;        ///< refits of the mixture to its own weighted draws
  int hard_refits_max = 12;  ///< refits where the proposal still is poor after those
  int refit_draws = 1024;    ///< proposals per refit; four times as many where it still is poor after three
  int points_max = 6000;     ///< points that a fit is made to
  double poor = 0.3;         ///< efficiency below which a proposal is poor
  MixtureOptions mixture = {};
};

/// A proposal while it is adapted.
struct Adaptation {
  Mixture current, best;
  double efficiency = 0.0;  ///< efficiency of the best mixture
  double log_evidence = nowhere;
  Eigen::MatrixXd points = {};  ///< points gathered so far, with their shares
  Eigen::VectorXd shares = {};
  std::vector<MixtureComponent> kept = {};  ///< modes that joined, which a fit to few points would lose again
  std::int64_t evaluations = 0;
};

/// Begins a proposal by a fit to points of equal weight.
Adaptation begin_proposal(const Eigen::MatrixXd& points, data::RandomStream& random, const ProposalOptions& options);
/// Begins a proposal by a fit to points of equal weight and to weighted draws of any proposal. The draws count as far
/// as they stand for the density.
Adaptation begin_proposal(const Eigen::MatrixXd& points, const Proposals& made, data::RandomStream& random,
                          const ProposalOptions& options);
/// Adapts the proposal to its own weighted draws.
void adapt(const Target& target, Adaptation& state, data::RandomStream& random, const ProposalOptions& options);
/// Puts a component at each mode; together they have `share` of the weight.
void add_modes(Adaptation& state, const std::vector<Peak>& modes, double share);

}  // namespace uq
