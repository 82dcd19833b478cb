#pragma once
// The answer of a plan as a sentence, and remarks beside it.
#include <string>
#include <vector>

#include "data/study.hpp"
#include "uq/findings/plan_results.hpp"
#include "uq/plan/plan_basis.hpp"

namespace uq::plan {

/// The answer: what to measure, what it gives, and what gives more. The candidates are ranked.
std::string sentence_of(const PlanBasis& basis, const PlanReport& report);

/// Assumptions of the ranking that the user should know.
std::vector<std::string> notes_of(const PlanBasis& basis, const PlanReport& report);

/// The error that a reading of the candidate is taken to have: "2 % and 0.1 mN m".
std::string error_text(const data::Study& study, const Candidate& candidate);

}  // namespace uq::plan
