#pragma once
// The forecast of a rig of the user's meshes. It is found from the meshes, as no dimensions say it.
#include <cstdint>

#include "dem/forecast/forecast.hpp"

namespace dem {

/// Adds to `f`, which knows the spheres, all that the meshes say.
Forecast forecast_of_meshes(const Case& c, std::uint64_t seed, Forecast f);

}  // namespace dem
