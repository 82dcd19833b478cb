#pragma once
// The moves of the mixture sampler's chains (uq/infer/mixture_sampler.hpp, step 3). Nothing here adapts.
#include "uq/infer/draws.hpp"
#include "uq/infer/importance.hpp"

namespace uq {

/// The state of one chain between rounds.
struct Walker {
  data::RandomStream random;
  Eigen::VectorXd x;
  double log_density = nowhere, log_proposal = log_density;
  WeightRecord weights = {};
  std::int64_t evaluations = 0;
};

/// The density and the mixture, which all chains share and none changes.
struct Moves {
  const Target& target;
  const Mixture& mixture;
  const Eigen::MatrixXd& archive;
  double local_share;
  int per_draw;
};

/// Appends `draws` draws to a chain.
void extend(const Moves& moves, Walker& walker, Chain& chain, int draws);

}  // namespace uq
