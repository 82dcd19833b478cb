#pragma once
// Texts of lengths and speeds of a rig, for the user.
#include <fmt/format.h>

#include <numbers>
#include <string>

#include "dem/walls/vec3.hpp"

namespace dem {

inline std::string mm(double length) { return fmt::format("{:.3g}", 1e3 * length); }
inline std::string mm(Vec3 at) {
  return fmt::format("({:.3g}, {:.3g}, {:.3g}) mm", 1e3 * at.x, 1e3 * at.y, 1e3 * at.z);
}
inline double rpm(double angular_velocity) { return angular_velocity * 30.0 / std::numbers::pi; }

}  // namespace dem
