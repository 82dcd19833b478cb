#pragma once
// The verdict on a surrogate in words: finding, consequence, remedy (used by validation.cpp).
#include "surrogate/validation.hpp"

namespace surrogate {

/// Verdict from the numbers of a validation, of which `predicted` runs were held out.
SurrogateVerdict judge(const Validation& validation, int predicted, const GaussianProcess& process,
                       const ValidationThresholds& thresholds);

/// Fills finding, consequence, remedy and more_runs.
void explain(Validation& validation, const TrainingSet& training, const FitOptions& options,
             const ValidationOptions& validation_options);

}  // namespace surrogate
