#include "dem/rig/drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "dem/rig/rig.hpp"

namespace dem {

double drive_sign(const Motion& motion, const RunControl& run) {
  double fastest = 0.0;
  for (const SpeedPoint& p : motion.programme) fastest = std::max(fastest, std::abs(p.angular_velocity));
  const double turned = programme_angle(motion, run.longest) - programme_angle(motion, run.start_up);
  return turned > 1e-9 * fastest * run.longest ? -1.0 : 1.0;
}

bool drive_sign_corrected(const Case& c) {
  const std::vector<RigBody> bodies = rig_bodies(c);
  const std::vector<std::size_t> measured = measured_bodies(c);
  return std::any_of(measured.begin(), measured.end(), [&](std::size_t k) {
    const Motion& motion = bodies[k].motion;
    const double at_last = programme_speed(motion, std::numeric_limits<double>::max()) > 0.0 ? -1.0 : 1.0;
    return drive_sign(motion, c.run) != at_last;
  });
}

double turn_of(const Case& c) {
  const std::vector<RigBody> bodies = rig_bodies(c);
  const std::vector<std::size_t> measured = measured_bodies(c);
  if (measured.empty()) {
    const double speed = std::abs(c.rig.angular_velocity);
    return speed > 0.0 ? 2.0 * std::numbers::pi / speed : 0.0;
  }
  if (const double own = period(bodies[measured.front()].motion); own > 0.0) return own;
  double slowest = 0.0, slowest_swing = 0.0;
  for (const RigBody& body : bodies) {
    double& longest = body.motion.programme.empty() ? slowest_swing : slowest;
    longest = std::max(longest, period(body.motion));
  }
  return slowest > 0.0 ? slowest : slowest_swing;
}

}  // namespace dem
