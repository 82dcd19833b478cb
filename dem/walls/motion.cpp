#include "dem/walls/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dem {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;

double displacement(const Oscillation& o, double time) {
  return o.amplitude * std::sin(turn * o.frequency * std::max(time, 0.0) + o.phase);
}
double rate(const Oscillation& o, double time) {
  const double w = turn * o.frequency;
  return time > 0.0 ? o.amplitude * w * std::cos(w * time + o.phase) : 0.0;
}

double highest_speed(const Motion& motion) {
  double speed = 0.0;
  for (const SpeedPoint& p : motion.programme) speed = std::max(speed, std::abs(p.angular_velocity));
  return speed;
}

/// The rotation that does `first`, then `second`.
Rotation after(const Rotation& second, const Rotation& first) {
  const auto row = [&](Vec3 r) { return r.x * first.x + r.y * first.y + r.z * first.z; };
  return {row(second.x), row(second.y), row(second.z)};
}

}  // namespace

double programme_speed(const Motion& motion, double time) {
  const std::vector<SpeedPoint>& p = motion.programme;
  if (p.empty() || !(time > 0.0)) return 0.0;
  if (time <= p.front().time) return p.front().angular_velocity;
  for (std::size_t k = 1; k < p.size(); ++k) {
    if (time >= p[k].time) continue;
    const double share = (time - p[k - 1].time) / (p[k].time - p[k - 1].time);
    return p[k - 1].angular_velocity + share * (p[k].angular_velocity - p[k - 1].angular_velocity);
  }
  return p.back().angular_velocity;
}

double programme_angle(const Motion& motion, double time) {
  const std::vector<SpeedPoint>& p = motion.programme;
  if (p.empty() || !(time > 0.0)) return 0.0;
  double angle = p.front().angular_velocity * std::min(time, p.front().time);
  for (std::size_t k = 1; k < p.size() && time > p[k - 1].time; ++k) {
    const double length = std::min(time, p[k].time) - p[k - 1].time;
    const double speed_then = time < p[k].time ? programme_speed(motion, time) : p[k].angular_velocity;
    angle += 0.5 * (p[k - 1].angular_velocity + speed_then) * length;
  }
  if (time > p.back().time) angle += p.back().angular_velocity * (time - p.back().time);
  return angle;
}

Pose pose(const Motion& motion, double time) {
  Pose now{.point = motion.point};
  const double angle = programme_angle(motion, time);
  if (angle != 0.0) {
    now.turned = true;
    now.rotation = rotation_about(motion.axis, angle);
  }
  now.spin = programme_speed(motion, time) * motion.axis;
  for (const Oscillation& o : motion.oscillations) {
    if (o.kind == OscillationKind::along) {
      now.point += displacement(o, time) * o.axis;
      now.velocity += rate(o, time) * o.axis;
    } else {
      const Rotation by = rotation_about(o.axis, displacement(o, time));
      now.turned = true;
      now.rotation = after(by, now.rotation);
      now.spin = rate(o, time) * o.axis + rotate(by, now.spin);
    }
  }
  return now;
}

double travelled(const Motion& motion, double from, double to, const Reach& reach) {
  double way = std::abs(programme_angle(motion, to) - programme_angle(motion, from)) * reach.from_axis;
  for (const Oscillation& o : motion.oscillations) {
    const double change = std::abs(displacement(o, to) - displacement(o, from));
    way += o.kind == OscillationKind::along ? change : change * reach.from_point;
  }
  return way;
}

bool turns(const Motion& motion) {
  return highest_speed(motion) > 0.0 ||
         std::any_of(motion.oscillations.begin(), motion.oscillations.end(),
                     [](const Oscillation& o) { return o.kind == OscillationKind::about; });
}

bool moves(const Motion& motion) { return highest_speed(motion) > 0.0 || !motion.oscillations.empty(); }

double period(const Motion& motion) {
  if (const double speed = highest_speed(motion); speed > 0.0) return turn / speed;
  double longest = 0.0;
  for (const Oscillation& o : motion.oscillations) longest = std::max(longest, 1.0 / o.frequency);
  return longest;
}

}  // namespace dem
