#pragma once
// Parameters that are traded against each other, and the combination of them that the data know.
//
// Of the parameters that have influence and are not known as separate values, subsets are tried from pairs upwards,
// each with at least one that is not identified. A subset is traded when the posterior knows a combination of it
// (combination.hpp) much better than any of its terms, or when it fills so little of its room that its values hang
// together on a curve. A larger subset is only looked at where no smaller one inside it is traded, and a pair only
// where the pairs found before do not tie it already. The combination's value and error are its mean and sd over the
// draws.
#include <Eigen/Dense>
#include <string>
#include <vector>

#include "uq/findings/case_results.hpp"
#include "uq/findings/thresholds.hpp"
#include "uq/posterior/case_model.hpp"
#include "uq/verdict/profile.hpp"

namespace uq {

/// Traded sets of the case's own parameters, the best known first. `draws`: rows in u. `verdicts`: per own parameter.
std::vector<TradedPair> find_traded_pairs(const CaseModel& model, const Eigen::MatrixXd& draws, const Profiles& all,
                                          const std::vector<Verdict>& verdicts, const VerdictThresholds& thresholds);

}  // namespace uq
