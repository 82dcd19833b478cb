#pragma once
// Why a parameter is not known: from the evidence of its verdict to a reason, its clause, and what brings the width about.
// The table of reasons, and what can be done about each, is in verdict_words.hpp.
#include <optional>
#include <string>

#include "uq/verdict/verdict.hpp"

namespace uq {

/// Why a word other than "identified" or "several values"; nothing for these two.
std::optional<Reason> find_reason(const ParameterEvidence& parameter, Verdict verdict);

/// The clause that ends a parameter's sentence: "; the measurement's noise hides it".
std::string because(Reason reason, const ParameterEvidence& parameter);

/// What the shares of a width are, given the reason.
WidthShares find_shares(const ParameterEvidence& parameter, std::optional<Reason> reason);

}  // namespace uq
