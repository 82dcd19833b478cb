#include "dem/rig/drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace dem {

double drive_sign(const Motion& motion, const RunControl& run) {
  double fastest = 0.0;
  for (const SpeedPoint& p : motion.programme) fastest = std::max(fastest, std::abs(p.angular_velocity));
  const double turned = programme_angle(motion, run.longest) - programme_angle(motion, run.start_up);
  return turned > 1e-9 * fastest * run.longest ? -1.0 : 1.0;
}

bool drive_sign_corrected(const Case& c) {
  if (!c.rig.stl || c.rig.stl->meshes.empty()) return false;
  const StlRig& rig = *c.rig.stl;
  return std::any_of(rig.measured.begin(), rig.measured.end(), [&](std::size_t k) {
    const Motion motion = motion_of(rig.meshes[k], c.rig.angular_velocity);
    const double at_last = programme_speed(motion, std::numeric_limits<double>::max()) > 0.0 ? -1.0 : 1.0;
    return drive_sign(motion, c.run) != at_last;
  });
}

double turn_of(const Case& c) {
  if (c.rig.stl && !c.rig.stl->meshes.empty()) {
    const StlRig& rig = *c.rig.stl;
    if (const double own = period(motion_of(rig.meshes[rig.measured.front()], c.rig.angular_velocity)); own > 0.0)
      return own;
    double slowest = 0.0, slowest_swing = 0.0;
    for (const RigMesh& m : rig.meshes) {
      const Motion motion = motion_of(m, c.rig.angular_velocity);
      double& longest = motion.programme.empty() ? slowest_swing : slowest;
      longest = std::max(longest, period(motion));
    }
    return slowest > 0.0 ? slowest : slowest_swing;
  }
  const double speed = std::abs(c.rig.angular_velocity);
  return speed > 0.0 ? 2.0 * std::numbers::pi / speed : 0.0;
}

}  // namespace dem
