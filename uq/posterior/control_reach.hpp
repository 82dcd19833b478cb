#pragma once
#include <utility>

#include "data/study.hpp"

namespace uq {

/// The distance beyond the runs of a material, as a share of a control's range, at which a reading may lie. A scrambled
/// design of a few dozen runs stops several percent short of its range's ends, and the surrogate's variance covers
/// that; further out it extrapolates.
inline constexpr double control_reach = 0.1;

/// Whether a value lies within this reach of runs that span `runs` [SI].
inline bool within_reach(const data::Control& control, double value, const std::pair<double, double>& runs) {
  const data::Axis axis = control.axis();
  const double u = axis.to_unit(value);
  return u >= axis.to_unit(runs.first) - control_reach && u <= axis.to_unit(runs.second) + control_reach;
}

}  // namespace uq
