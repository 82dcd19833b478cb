#pragma once
// A case in one sentence, for a reader who reads nothing else: what the measurement fixes, what it leaves open, and
// what to do next.
#include <string>

#include "uq/findings/case_results.hpp"
#include "uq/findings/wording.hpp"

namespace uq {

std::string headline(const CaseReport& result, Typography typography);

/// Whether an observation file of the case says at its head that it is synthetic.
bool is_synthetic(const CaseReport& result);

}  // namespace uq
