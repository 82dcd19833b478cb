#pragma once
// The second check of a sampler that has no proposal of its own to search beside (NUTS). A mixture is fitted to its
// draws, and maxima that this mixture does not know (uq/infer/explore.hpp) must have draws nearby, about as many as
// their Laplace mass asks for. Chains that all sit in one of two modes agree with each other; this check sees the other
// mode.
#include <string>

#include "uq/infer/draws.hpp"
#include "uq/infer/explore.hpp"

namespace uq {

struct SecondCheckOptions {
  double mass = 0.01;          ///< share of the whole from which a maximum without draws matters
  double ratio = 30.0;         ///< p / (Z q) from which a place is unknown to the fitted mixture
  Eigen::Index fitted = 1500;  ///< draws that the mixture is fitted to
  ExploreOptions explore = {};
  std::uint64_t seed = 1;
};

/// The maxima that were missed, in words; empty where none was. Counts what was searched into `draws`.
std::string missed_maxima(const Target& target, Draws& draws, const SecondCheckOptions& options = {});

}  // namespace uq
