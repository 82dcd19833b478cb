// The deepest contact of a step, named when it is deeper than the contact laws are meant for.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "dem/engine/simulation.hpp"

namespace dem {
namespace {

struct Deepest {
  double overlap = 0.0;  ///< overlap as a share of a radius
  std::string who;
  Vec3 at;                ///< m
  double approach = 0.0;  ///< m/s, positive while it deepens
};

}  // namespace

/// Only asked for once, so that it looks at every contact anew.
void Simulation::report_overlap() const {
  const State& s = state_;
  Deepest deepest;
  s.each_in_range([&](std::size_t, std::uint32_t slot) {
    const Pair p = s.pair[slot];
    const auto sphere = [&](std::uint32_t row) {
      return s.id[row < s.particles() ? row : s.ghost[row - s.particles()].owner];
    };
    const PositionRow &a = s.position[p.i], &b = s.position[p.j];
    const Vec3 apart = a.at - b.at;
    const double sum = a.radius + b.radius, distance = length(apart), relative = 2.0 * (sum - distance) / sum;
    if (relative <= deepest.overlap) return;
    deepest = {relative, fmt::format("spheres {} and {}", sphere(p.i), sphere(p.j)), b.at + (b.radius / sum) * apart,
               -dot(s.motion[p.i].velocity - s.motion[p.j].velocity, apart) / std::max(distance, 1e-300)};
  });
  const std::vector<Frame> bodies = frames();
  Touches touches;
  for (const WallSlot& slot : s.wall) {
    const PositionRow& at = s.position[slot.particle];
    const Frame& frame = bodies[slot.body];
    find_touches(surface_[slot.body], {s.features.data() + slot.feature_first, slot.feature_count},
                 frame.point + rotate_back(frame.now.rotation, at.at - frame.now.point), at.radius, touches);
    for (int t = 0; t < touches.count; ++t) {
      const double relative = (at.radius - touches.touch[t].distance) / at.radius;
      if (relative <= deepest.overlap) continue;
      const Vec3 normal = rotate(frame.now.rotation, touches.touch[t].normal), arm = at.at - frame.now.point;
      const Vec3 of_wall = frame.now.velocity + cross(frame.now.spin, arm);
      deepest = {relative, fmt::format("sphere {} and {}", s.id[slot.particle], setup_.bodies[slot.body].name),
                 at.at - touches.touch[t].distance * normal, -dot(s.motion[slot.particle].velocity - of_wall, normal)};
    }
  }
  throw Fault(fmt::format(
      "{} overlap by {:.3g} of a radius at ({:.4g}, {:.4g}, {:.4g}) m at {:.6g} s, {} at {:.3g} m/s; the limit is "
      "{:.3g} (run.overlap_limit). Likely {}",
      deepest.who, deepest.overlap, deepest.at.x, deepest.at.y, deepest.at.z, time(),
      deepest.approach > 0.0 ? "approaching" : "parting", std::abs(deepest.approach), setup_.overlap_limit,
      "the contact is too soft for the load or the speed (raise contact.stiffness or contact.young_modulus), or a "
      "sphere is pinched in a gap narrower than itself"));
}

}  // namespace dem
