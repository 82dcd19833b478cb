#include "dem/case/stl_rig.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dem {

std::vector<Vec3> periods(const StlRig& rig) {
  const Vec3 size = rig.high - rig.low;
  std::vector<Vec3> found;
  if (rig.periodic[0]) found.push_back({size.x, 0.0, 0.0});
  if (rig.periodic[1]) found.push_back({0.0, size.y, 0.0});
  if (rig.periodic[2]) found.push_back({0.0, 0.0, size.z});
  return found;
}

bool same_line(const Motion& one, const Motion& other, double tolerance) {
  const Vec3 apart = other.point - one.point;
  return length(cross(one.axis, other.axis)) < 1e-6 && length(apart - dot(apart, one.axis) * one.axis) <= tolerance;
}

Motion motion_of(const RigMesh& mesh, double angular_velocity) {
  Motion motion = mesh.motion;
  if (mesh.speed_ratio != 0.0) motion.programme = {{0.0, mesh.speed_ratio * angular_velocity}};
  return motion;
}

double mesh_speed(const StlRig& rig, double angular_velocity) {
  double fastest = 0.0;
  for (const RigMesh& m : rig.meshes) {
    const Motion motion = motion_of(m, angular_velocity);
    double from_axis = 0.0, from_point = 0.0;
    for (const Vec3 v : m.mesh.vertices) {
      from_axis = std::max(from_axis, length(cross(motion.axis, v - motion.point)));
      from_point = std::max(from_point, length(v - motion.point));
    }
    double speed = 0.0;
    for (const SpeedPoint& p : motion.programme) speed = std::max(speed, std::abs(p.angular_velocity) * from_axis);
    for (const Oscillation& o : motion.oscillations) {
      const double arm = o.kind == OscillationKind::along ? 1.0 : from_point;
      speed += 2.0 * std::numbers::pi * o.frequency * std::abs(o.amplitude) * arm;
    }
    fastest = std::max(fastest, speed);
  }
  return fastest;
}

}  // namespace dem
