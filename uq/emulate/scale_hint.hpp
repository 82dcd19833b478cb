#pragma once
// Controls that a surrogate might learn better on a log scale.
#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "data/study.hpp"
#include "uq/emulate/emulator.hpp"

namespace uq {

/// The highest over the lowest value of the runs, from which an input on the linear scale is named. A response that
/// goes with a power of the control bends most at its low end, and there a stationary process is wrong first.
inline constexpr double wide_control = 5.0;

/// A sentence that says for which controls, by what the runs cover of each [SI], a log scale is worth a try; empty where
/// there is none.
std::string scale_hint(const data::Study& study, const std::map<std::size_t, std::pair<double, double>>& covered);

/// What might let the surrogate bend at one end of an input: its log scale, if that is its low end and it covers a wide
/// range on the linear one; else more runs. A sentence.
std::string bend_hint(const data::Study& study, const EmulatorInput& input, std::pair<double, double> covered,
                      bool low);

}  // namespace uq
