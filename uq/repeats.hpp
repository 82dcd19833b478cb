#pragma once
// How sure a verdict is of its word: what the words would be if the measurement were made again.
//
// Repeats are drawn from the posterior predictive, y' = m(u') + S^1/2 z, u' a draw, S the covariance of the data at the
// best fit. The case is not sampled again. About each point i of a profile's path the model is taken as linear in the
// other unknowns; with residual r = L^-1 (y' - m_i), slopes A = L^-1 dm/du, L L' = S_i and the priors' widths as weak
// springs P about the path,
//   deviance'_i = |r|^2 - r' A (A' A + P)^-1 A' r + log |S_i|    (less its least over i).
// From it come the open sides, the parts, and the contraction: 1 - contraction changes as the variance of
// exp(-deviance' / 2) does. A hole that two of the surrogate's sds explain is none. What does not hang on the data's
// noise stays as found: influence, structure, a side that another parameter's range ends. An unknown at the end of its
// range on the path stays there.
#include <cstdint>
#include <vector>

#include "uq/case_model.hpp"
#include "uq/profile.hpp"
#include "uq/results.hpp"
#include "uq/verdict.hpp"

namespace uq {

struct RepeatOptions {
  int repeats = 200;
  int rows_max = 300;  ///< of data; beyond, nothing is repeated
  std::uint64_t seed = 1;
};

/// Facts of own parameter k, as found, with the draws' share.
struct FoundFacts {
  WordFacts facts;
  const Profile* profile = nullptr;
};

/// Per parameter, by falling probability; empty where there are too many rows.
std::vector<std::vector<WordProbability>> repeat_words(const CaseModel& model, const std::vector<FoundFacts>& found,
                                                       const Eigen::MatrixXd& draws, const Eigen::VectorXd& best,
                                                       const VerdictThresholds& thresholds,
                                                       const RepeatOptions& options);

}  // namespace uq
