#pragma once
// Which of the data a model that does not fit is farthest from.
#include <string>
#include <vector>

#include "uq/findings/results.hpp"

namespace uq {

/// "Farthest off: cohesion_index 2.25 of drum, where the model gives 5.12 (23 sd)": the points more than three sds of
/// the predictive (measurement and surrogate error) from its mean, the worst three first; empty where there are none.
/// The posterior has already moved towards all data: what it still misses by so much, no value of the parameters gives
/// without missing others.
std::string farthest_off(const std::vector<PredictivePoint>& points);

}  // namespace uq
