#pragma once
// Whether a case's priors let its model reach the measured values. Where they do not, and the parameters' ranges would,
// a posterior would be squeezed against the priors' ends and mean nothing.
#include "data/study.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

/// Throws data::InputError (78) where the priors alone put a measured value out of reach that the ranges would allow:
/// five standard deviations beyond all predictions. A value that the ranges do not reach either is a misfit, and
/// passes.
void refuse_excluding_priors(const data::Study& study, const CaseModel& model);

}  // namespace uq
