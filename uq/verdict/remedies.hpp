#pragma once
// What can be done about parameters that are not known: one function for each row of the table in verdict_words.hpp.
#include <string>
#include <vector>

#include "uq/verdict/case_facts.hpp"

namespace uq {

/// Sentences, the first to be done first: that of the largest share of the widths. None where all is known.
std::vector<std::string> find_remedies(const CaseFacts& facts, const SortedParameters& sorted);

/// How errors that repeated readings share are found by themselves: "calibrate the meter (the gain g)"; empty for none.
std::string remedy_of(const std::vector<CommonError>& errors);

}  // namespace uq
