#pragma once
// The reason why a parameter is not known: from the evidence of its verdict to a reason, its clause, and the sources of
// the width. The table of reasons, and what can be done about each, is in verdict_words.hpp.
#include <optional>
#include <string>

#include "uq/verdict/verdict.hpp"

namespace uq {

/// The reason for a word other than "identified" or "several values"; nothing for these two.
std::optional<Reason> find_reason(const ParameterEvidence& evidence, Verdict verdict);

/// The clause that ends a parameter's sentence: "; the measurement's noise hides it".
std::string because(Reason reason, const ParameterEvidence& evidence);

/// The shares of the sources of a width, given the reason.
WidthShares find_shares(const ParameterEvidence& evidence, std::optional<Reason> reason);

}  // namespace uq
