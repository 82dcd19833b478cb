#pragma once
// The gradient-free sampler: independent chains that mix global proposals with local ones; made for two to six
// dimensions and for ridges, bounds and several modes, where local moves alone give under a hundredth of an independent
// draw each.
//
// 1. Each chain tempers a population of its own from reference draws (uq/tempering.hpp): over-dispersed starts.
// 2. A Student-t mixture (uq/mixture.hpp), cut at the support, is fitted to all populations, then refitted to its own
//    importance-weighted draws while that helps (population Monte Carlo; Cappe et al. 2004). After this nothing adapts.
// 3. A chain starts at a point of its own population. Each move is, by chance, an independence proposal from the
// mixture
//    (Metropolis-Hastings ratio p(x') q(x) / p(x) q(x')) or a differential-evolution step from the frozen populations
//    (symmetric). Proposals of the mixture do not depend on the chain's state, so they are evaluated in batches.
// 4. Draws go on until R-hat and effective sample sizes are met, or the largest number of draws is reached, which is
// said. The evidence is the importance-sampling mean of p / q over all global proposals made in step 3, with its
// standard error.
//
// A result depends on (seed, chain) alone, never on the number of threads.
#include <cstdint>

#include "uq/draws.hpp"
#include "uq/log_density.hpp"
#include "uq/mixture.hpp"
#include "uq/tempering.hpp"

namespace uq {

struct MixtureSamplerOptions {
  int chains = 4;
  int draws = 1000;          ///< per chain in the first round; each further round doubles the number
  int draws_max = 32000;     ///< per chain, at which sampling stops without convergence
  int burn_in = 64;          ///< draws of each chain that are left out
  double local_share = 0.2;  ///< chance that a move is a local one
  int refits_max = 5;        ///< of the mixture to its own weighted draws
  int refit_draws = 1024;    ///< proposals per refit
  TemperingOptions tempering = {};
  MixtureOptions mixture = {};
  StopRule stop = {};
  int threads = 0;  ///< 0: as many as the machine has
  std::uint64_t seed = 1;
};

Draws sample_mixture(const Target& target, const MixtureSamplerOptions& options = {});

}  // namespace uq
