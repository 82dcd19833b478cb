#pragma once
// The words of a posterior that lies where no run speaks.
#include <string>

#include "uq/posterior/support.hpp"

namespace uq {

/// What is not supported, the greatest share first. `empty`: the inputs in whose plane there are no runs, "friction and
/// rpm".
std::string support_sentence(const SupportReport& report, const SupportThresholds& thresholds,
                             const std::string& empty);

}  // namespace uq
