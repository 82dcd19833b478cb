#pragma once
// Unknowns that belong to a measurement rather than to a case: whatever case uses the measurement has them.
#include <vector>

#include "data/study.hpp"

namespace uq {

/// The unknowns of one observation set, each known by its parameter's name:
///   the machine's scale, where the set is of the machine and [rig] scale is a prior
///   METER_OUTPUT_gain    normal about 1, sd the relative common error of a named meter: one for all of its sets
///   METER_OUTPUT_offset  normal about 0, sd the absolute one
///   SET_CONTROL          the true value of a control whose uncertainty is sampled, normal about the stated value
/// The common error of a set that names no meter needs no unknown (uq/posterior/measurement.hpp integrates it out).
std::vector<data::Nuisance> set_unknowns(const data::Study& study, const data::ObservationSet& set);

/// The unknown of set_unknowns that is a control's true value.
data::Nuisance setting_unknown(const data::Study& study, const data::ObservationSet& set,
                               const data::SettingError& error);

}  // namespace uq
