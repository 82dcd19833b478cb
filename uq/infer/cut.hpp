#pragma once
// Draws of a cut posterior: no feedback (M. Plummer, "Cuts in Bayesian graphical models", Stat. Comput. 25:37 (2015)).
//   p_cut(phi, theta) = p(phi | y1) p(theta | phi, y2)
// phi keeps the law that its own data y1 gave it; y2 only moves theta. In two stages: each draw of phi from the
// source's chains is held, and theta follows by `sweeps` sweeps of slice sampling (R. M. Neal, Ann. Stat. 31:705
// (2003)) of p(theta | phi, y2), along the axes of theta's covariance at the first phi, starting from the theta of the
// draw of phi before. That the sweeps forget their start is an approximation of the two-stage law; a test compares with
// a closed form. Evidence: not given (NaN).
#include <cstdint>
#include <vector>

#include "uq/infer/draws.hpp"
#include "uq/infer/log_density.hpp"

namespace uq {

/// Unknowns that are given, and their draws.
struct GivenDraws {
  std::vector<int> unknowns;            ///< of the target
  std::vector<Eigen::MatrixXd> chains;  ///< draws x unknowns, per chain
};

struct CutOptions {
  int draws = 500;    ///< per chain at least, evenly spaced in the given chain; doubled until the stop rule is met
  int sweeps = 8;     ///< per draw
  int burn_in = 150;  ///< sweeps at the first draw
  StopRule stop = {};
  int threads = 0;  ///< 0: as many as the machine has
  std::uint64_t seed = 1;
};

/// `target`: joint density of all unknowns under the case's own data.
Draws sample_cut(const Target& target, const GivenDraws& given, const CutOptions& options = {});

}  // namespace uq
