#pragma once
// The gradient-based sampler: the no-U-turn sampler with multinomial trajectories (Hoffman & Gelman, JMLR 15:1593
// (2014); Betancourt, arXiv:1701.02434 (2017), appendix A, with the generalised no-U-turn criterion and its two extra
// checks across subtrees), step size by dual averaging, and a dense mass matrix from the draws of growing windows, as
// in Stan. Any dimension.
//
//   H(z, p) = -log p(z) + 1/2 p' S p,   S the covariance of z, momentum p ~ N(0, S^-1), z unconstrained
//   (uq/infer/unconstrained.hpp)
// A trajectory whose energy rises by more than 1000 is a divergence, and is counted. Chains start from reference draws.
// A result depends on (seed, chain) alone. Log evidence: not given (NaN). Maxima that the chains
// missed end as "not converged" (uq/infer/second_check.hpp).
#include <cstdint>
#include <functional>

#include "uq/infer/draws.hpp"
#include "uq/infer/log_density.hpp"

namespace uq {

struct NutsOptions {
  int chains = 4;
  int warm_up = 600;        ///< iterations before anything is kept
  int draws = 1000;         ///< per chain in the first round; each further round doubles the number
  int draws_max = 16000;    ///< per chain
  double acceptance = 0.9;  ///< wanted mean acceptance statistic
  int depth_max = 10;       ///< depth of the trajectory's tree
  StopRule stop = {};
  int threads = 0;  ///< 0: as many as the machine has
  std::uint64_t seed = 1;
  /// Is told the share of the work done, 0 to 1 and never falling, by one call at a time from any thread. Rounds that
  /// are found to be needed are added to the work.
  std::function<void(double share)> progress = {};
};

/// Samples a target. It needs target.log_density_gradient.
Draws sample_nuts(const Target& target, const NutsOptions& options = {});

}  // namespace uq
