#pragma once
// A plan in words: the terminal's table and the part of the page about what to measure next.
#include <string>

#include "uq/findings/plan_results.hpp"

namespace uq {

/// A table of the best candidates, the batches and the training runs; at most 96 columns where names allow.
std::string plan_text(const std::string& case_name, const PlanReport& plan);

/// "identified 82 %, weakly identified 18 %"; empty where the words were not asked.
std::string words_text(const PlannedParameter& parameter);

/// The number of readings in words: "4", "never: ...", or "" where it was not asked.
std::string readings_text(const PlannedParameter& parameter);

/// The parameter that the plan ranks by, in a list; throws std::out_of_range where it is missing.
const PlannedParameter& asked(const PlanReport& plan, const std::vector<PlannedParameter>& parameters);

}  // namespace uq
