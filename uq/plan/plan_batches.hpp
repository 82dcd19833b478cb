#pragma once
// Batches: candidates that are measured together.
#include <vector>

#include "uq/findings/plan_results.hpp"
#include "uq/plan/plan_basis.hpp"

namespace uq::plan {

/// The best set of each size up to PlanOptions::batch: per cost, as candidates are ranked, or, under a budget, of the
/// sets that it allows. Candidates are picked one after the other, then each is exchanged for a better one beside the
/// others, twice at most. The exchanged set counts only where it is better by all of the draws, since the search uses
/// only some of them.
std::vector<PlanBatch> batches_of(const PlanBasis& basis);

}  // namespace uq::plan
