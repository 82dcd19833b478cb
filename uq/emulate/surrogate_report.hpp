#pragma once
// The judgement of a fitted surrogate, in the study's names and units.
#include "uq/emulate/surrogates.hpp"

namespace uq {

/// The options of one surrogate's fit.
surrogate::FitOptions options_for(const data::Study& study, const TrainingRows& rows, const SurrogateOptions& options);

/// Validates the surrogate (its `report` is not looked at).
SurrogateReport report_of(const data::Study& study, const FittedSurrogate& fitted, const SurrogateOptions& options);

}  // namespace uq
