#pragma once
// The gradient-free sampler: independent chains that mix global proposals with local ones; made for two to six
// dimensions and for ridges, bounds and several modes, where local moves alone give under a hundredth of an independent
// draw each. With more dimensions most of a proposal on a box would lie outside it (0.8^8 = 0.17), so bounded
// coordinates are sampled on the whole line then (uq/infer/unconstrained.hpp), where a flat one is a logistic density,
// which a Student-t fits.
//
// 1. Scouts are drawn from the reference (uq/infer/explore.hpp). Each chain tempers a population of its own from its
//    share of the scouts (uq/infer/tempering.hpp): over-dispersed starts.
// 2. The chains are two halves. For each half a proposal is adapted to the populations of its own chains and to their
//    scouts, weighted (uq/infer/proposal.hpp), so that one half may have a mode that the other lost. Maxima that a
//    search finds and the proposals do not know join both proposals, and stay: a fit to some thousand points loses a
//    mode that holds half a per cent. After this nothing adapts.
// 3. A chain starts at a point of its own population. Each move is, by chance, an independence proposal from the
//    mixture (Metropolis-Hastings ratio p(x') q(x) / p(x) q(x')) or a symmetric local step: along the difference of two
//    points of the populations, or of the shape of one of the mixture's components. Proposals of the mixture do not
//    depend on the chain's state, so they are evaluated in batches.
// 4. Draws go on until R-hat and effective sample sizes are met and the halves' means and spreads agree, or the largest
//    number of draws is reached, which is said. The evidence is the importance-sampling mean of p / q over all global
//    proposals made in step 3, with its standard error.
// 5. Second checks, which share no chain: a maximum that stays unknown, weights without a variance, or halves whose
//    evidences differ. The proposals are to blame for the latter two: each half's proposal is learnt anew from the
//    draws of its own chains, and 3 and 4 are done again, twice at most. A finding that is left ends as "not converged"
//    with its reason.
//
// A result depends on (seed, chain) alone, never on the number of threads.
#include <cstdint>
#include <functional>

#include "uq/infer/draws.hpp"
#include "uq/infer/log_density.hpp"
#include "uq/infer/proposal.hpp"
#include "uq/infer/tempering.hpp"

namespace uq {

struct MixtureSamplerOptions {
  int chains = 4;
  int draws = 1000;             ///< per chain in the first round; each further round doubles the number
  int draws_max = 32000;        ///< per chain, at which sampling stops without convergence
  int burn_in = 64;             ///< first draws of each chain, which are left out
  double local_share = 0.2;     ///< chance that a move is a local one
  double unknown_ratio = 30.0;  ///< p / (Z q) from which a place is unknown to a proposal
  double unknown_mass = 1e-4;   ///< share of the whole from which an unknown maximum joins the proposal
  double missing_mass = 2e-3;   ///< share of the whole that the draws may lack of the maxima found last
  int search_rounds = 3;        ///< rounds in which unknown maxima are added
  int learn_again = 2;          ///< times that the proposals may be learnt anew from the draws (step 5)
  double apart_max = 4.5;       ///< standard errors by which the halves may differ
  int unconstrained_from = 7;   ///< dimensions from which bounded coordinates are mapped to the whole line
  TemperingOptions tempering = {};
  ProposalOptions proposal = {};
  ExploreOptions explore = {};
  StopRule stop = {};
  int threads = 0;  ///< 0: as many as the machine has
  std::uint64_t seed = 1;
  /// Is told the share of the work done, counted by the time that the steps take; how many rounds of draws there will
  /// be is not known.
  std::function<void(double share)> progress = {};
};

Draws sample_mixture(const Target& target, const MixtureSamplerOptions& options = {});

}  // namespace uq
