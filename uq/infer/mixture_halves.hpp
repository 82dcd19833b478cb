#pragma once
// The halves of the mixture sampler's chains and their proposals (uq/infer/mixture_sampler.hpp, step 2).
#include <string>
#include <vector>

#include "uq/infer/mixture_sampler.hpp"

namespace uq {

/// Chains that share a proposal, which was adapted to their own populations alone.
struct Half {
  std::vector<std::size_t> chains;
  data::RandomStream random;
  Eigen::MatrixXd archive;  ///< populations of the half's chains
  Adaptation proposal;
  Evidence evidence = {};
};

/// Makes two halves, or one where there are fewer than four chains.
std::vector<Half> make_halves(const std::vector<Population>& populations, const MixtureSamplerOptions& options);

/// Begins the proposals with what the scouts found. Each half takes the scouts of its own chains.
void begin_halves(const Target& target, const Scouts& scouts, std::vector<Half>& halves,
                  const MixtureSamplerOptions& options);

/// Begins the proposals, or goes on with them after modes were added.
void adapt_halves(const Target& target, std::vector<Half>& halves, const MixtureSamplerOptions& options);

/// A maximum that joined the proposals last, with no search after it. Its share is the mass near it over the whole.
struct LastMaximum {
  Peak peak;
  double share = 0.0;
};

/// Maxima that the proposals do not know join them, until none that matters is left or the rounds are over; then those
/// of the last round. `best`: the population with the highest density. Counts what was searched into `result`.
std::vector<LastMaximum> find_unknown(const Target& target, const Scouts& scouts, const Population& best,
                                      std::vector<Half>& halves, const MixtureSamplerOptions& options, Draws& result);

}  // namespace uq
