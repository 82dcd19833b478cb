#pragma once
// Runs that are another's multiple: a part of the table in another unit, a block with a factor forgotten.
//
// A tenth of the runs or more, all wrong by one factor, are no lone outliers: a surrogate takes them for scatter, and
// none of them stands out from it. On the logarithm of the output they are shifted together, which a regression that
// minimises absolute errors (it passes through the majority) leaves to be seen: a second heap of its residuals.
#include <optional>
#include <vector>

#include "surrogate/fit.hpp"

namespace uq {

/// Least number of runs in such a group.
inline constexpr int scaled_least = 3;

/// Runs that may be a multiple of what the others say: suspects, to be confirmed without them. Sorted; fewer than half
/// of the runs. None where an output is 0 or outputs differ in sign, or where the runs are too few to see it.
std::vector<int> scaled_runs(const surrogate::TrainingSet& training);

/// A factor by which runs differ from what is expected of them.
struct CommonFactor {
  double factor = 0.0;
  int runs = 0;  ///< that differ by it, within a fifth
};

/// The factor that three quarters of these, three at least, have in common.
std::optional<CommonFactor> common_factor(const std::vector<double>& observed, const std::vector<double>& expected);

}  // namespace uq
