#pragma once

namespace uq {

/// How far beyond the runs of a material, as a share of a control's range, a reading may lie. A scrambled design of a few
/// dozen runs stops several percent short of its range's ends, and the surrogate's variance covers that; further out it
/// extrapolates.
inline constexpr double control_reach = 0.1;

}  // namespace uq
