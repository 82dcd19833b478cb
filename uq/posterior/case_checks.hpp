#pragma once
// Checks of a case against its runs, made while its model is built (uq/posterior/case_model.hpp).
#include <vector>

#include "data/error.hpp"
#include "data/study.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

/// Whether half of the shorter set's readings stand in the other to the last digit: at the same controls, or, in one
/// file, at whatever controls the study gives them. Sets that measure no common output never do.
bool hold_the_same(const data::ObservationSet& a, const data::ObservationSet& b);

/// Contradictions of the case or its material with every run of the material: a parameter fixed at another value or
/// free, a control measured elsewhere; and readings at controls that the runs do not reach.
std::vector<data::Problem> against_the_runs(const data::Study& study, const data::CalibrationCase& item,
                                            const data::ObservationSet& set, const Emulator& emulator);

/// Throws data::InputError (65) where the case has measurements of one output at more than `settings_max` settings:
/// each evaluation costs the cube of their number.
void refuse_too_many_settings(const data::Study& study, const CaseModel& model);

}  // namespace uq
