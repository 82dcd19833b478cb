#pragma once
// The verdict on a surrogate in words: finding, consequence, remedy (used by validation.cpp).
#include "surrogate/held_out.hpp"

namespace surrogate {

/// Verdict from the numbers of a validation, of which `predicted` runs were held out.
SurrogateVerdict judge(const Validation& validation, int predicted, const FitDiagnostics& diagnostics,
                       const ValidationThresholds& thresholds);

/// Fills finding, consequence, remedy and more_runs; the model gives the learning curve that more_runs rests on.
void explain(Validation& validation, const TrainingSet& training, const HeldOutModel& model,
             const ValidationThresholds& thresholds);

}  // namespace surrogate
