#pragma once
// The data from which a model that does not fit is farthest.
#include <string>
#include <vector>

#include "uq/findings/prediction_results.hpp"

namespace uq {

/// The points more than three sds of the predictive (measurement and surrogate error) from its mean, the worst three
/// first, in words: "Farthest off: cohesion_index 2.25 of drum, where the model gives 5.12 (23 sd)". Empty where there
/// are none. The posterior has already moved towards all data: a point still so far off is given by no value of the
/// parameters without missing others.
std::string farthest_off(const std::vector<PredictivePoint>& points);

}  // namespace uq
