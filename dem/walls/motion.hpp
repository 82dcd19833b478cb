#pragma once
// Rigid motion of a body, in closed form, so that any time gives the same bits however a run came there.
//
//   x(t) = p + d(t) + R(t) (x0 - p),  R = R_k ... R_1 R_0
// p a point on the axis; R_0 the rotation about the axis by the integral of a piecewise linear speed; each oscillation
// adds a shift along its axis to d, or a rotation R_i about its axis through p, by amplitude * sin(2 pi f t + phase).
// Velocity of p: d'; angular velocity: w = w_k + R_k (w_(k-1) + R_(k-1) (...)). Before t = 0 the body rests as at t =
// 0.
#include <vector>

#include "dem/walls/vec3.hpp"

namespace dem {

/// A point of a speed programme: the speed is linear between points and constant beyond them.
struct SpeedPoint {
  double time = 0.0;              ///< s
  double angular_velocity = 0.0;  ///< rad/s
};

enum class OscillationKind { along, about };
struct Oscillation {
  OscillationKind kind = OscillationKind::along;
  Vec3 axis{0.0, 0.0, 1.0};  ///< unit
  double amplitude = 0.0;    ///< m along the axis, rad about it
  double frequency = 0.0;    ///< Hz
  double phase = 0.0;        ///< rad
};

struct Motion {
  Vec3 point;                         ///< m, on the axis of rotation
  Vec3 axis{1.0, 0.0, 0.0};           ///< unit
  std::vector<SpeedPoint> programme;  ///< times ascending; empty: no rotation
  std::vector<Oscillation> oscillations;
};

struct Pose {
  Rotation rotation;
  bool turned = false;  ///< false: there is no rotation
  Vec3 point;           ///< m, where the motion's point is now
  Vec3 velocity;        ///< m/s, of that point
  Vec3 spin;            ///< rad/s
};

/// Angle of the speed programme at `time` [s], in rad.
double programme_angle(const Motion& motion, double time);
/// Speed of the programme at `time` [s], in rad/s.
double programme_speed(const Motion& motion, double time);

Pose pose(const Motion& motion, double time);

/// Farthest that points of the body lie from the axis and from the point [m].
struct Reach {
  double from_axis = 0.0, from_point = 0.0;
};
/// How far a point within reach came between two times, at most [m].
double travelled(const Motion& motion, double from, double to, const Reach& reach);

/// Whether the body ever turns, and whether it ever moves.
bool turns(const Motion& motion);
bool moves(const Motion& motion);

/// Duration of a turn at the programme's highest speed, or of the slowest oscillation when it never turns; 0 at rest
/// [s].
double period(const Motion& motion);

}  // namespace dem
