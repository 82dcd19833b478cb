#pragma once
// Remedies for parameters that are not known: one function for each row of the table in verdict_words.hpp.
#include <string>
#include <vector>

#include "uq/verdict/case_facts.hpp"

namespace uq {

/// The remedies as sentences, the first to be done first, which is that of the largest share of the widths. None where
/// all is known.
std::vector<std::string> find_remedies(const CaseFacts& facts, const SortedParameters& sorted);

/// The remedy that finds errors which repeated readings share by themselves: "calibrate the meter (the gain g)"; empty
/// for no errors.
std::string remedy_of(const std::vector<CommonError>& errors);

}  // namespace uq
