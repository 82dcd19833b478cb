#pragma once
// The warnings of a case's report: draws that do not agree, data and priors that contradict each other, priors cut
// short.
#include "uq/calibrate/calibrate.hpp"
#include "uq/calibrate/case_words.hpp"

namespace uq {

/// Adds the warnings of a case whose fit, doubt and bands are known.
void add_warnings(CaseReport& report, DoubtOf of, const SampledCase& sampled);

/// Warns of a posterior between a prior and data that contradict each other: a compromise that neither of them
/// supports.
void add_prior_conflicts(CaseReport& report, const SampledCase& sampled, const std::vector<PriorConflict>& conflicts);

}  // namespace uq
