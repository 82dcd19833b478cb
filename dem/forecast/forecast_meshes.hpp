#pragma once
// The forecast of a rig of the user's meshes: what no dimension says is found out from the meshes themselves.
#include <cstdint>

#include "dem/forecast/forecast.hpp"

namespace dem {

/// `f`, which knows the spheres, with all that the meshes say.
Forecast forecast_of_meshes(const Case& c, std::uint64_t seed, Forecast f);

}  // namespace dem
