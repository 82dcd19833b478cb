#pragma once
// A posterior confirmed by the simulation itself: runs at points of the posterior, that no surrogate has seen, beside
// what the surrogate said there. With m, C the surrogate's mean and covariance at the n points, g the scatter of a run
// beyond its stated error, e its standard error, y its value, D = diag(g^2 + e^2):
//   z_i  = (y_i - m_i) / sqrt(C_ii + D_ii)
//   chi2 = (y - m)' (C + D)^-1 (y - m), chi-squared with n degrees of freedom where the surrogate is right
// They agree when P(chi2_n >= chi2) is at least `least_p` and no |z_i| exceeds the value that n independent normal ones
// exceed with probability `least_p`.
#include <string>
#include <vector>

#include "data/run_table.hpp"
#include "data/study.hpp"
#include "uq/emulate/surrogates.hpp"
#include "uq/findings/prediction_results.hpp"

namespace uq {

inline constexpr double least_p = 0.01;

/// A run made for verification: its row, and what it stands for ("draw 3", "equivalent point 2").
struct VerificationRun {
  data::RunRow row;
  std::string label;
};

/// Compares the runs with the surrogates, which must not have seen them.
VerificationReport verify(const data::Study& study, const std::vector<FittedSurrogate>& surrogates,
                          const std::vector<VerificationRun>& runs);

/// The outcome in one sentence or two: that the runs confirm the posterior, or where they do not.
std::string verification_sentence(const VerificationReport& report, const std::string& simulation);

}  // namespace uq
