#pragma once
// One collision of two spheres, or of a sphere and a plane, under any composed law, as an ordinary differential
// equation solved by CVODE to its tolerance. It is the reference that does not know the simulation's time step, and it
// finds the damping for a wanted restitution where attraction leaves no closed form.
//
//   x' = v, v' = F / m*, w_i' = M_i / I_i, I = 2/5 m r^2; x, v relative, F and M of dem/contact/contact_law.hpp
//   h' = (what the law remembers of h after a short step e - h) / e, e = 1e-6 of the collision's time scale: the spring
//   that follows the slip, cut to the slider's cap within e (stiff, hence BDF). F is the law's over the same step.
// The right-hand side jumps where a contact is made or broken and where an attraction begins: roots of the overlap,
// found by CVODE, at which the solver starts anew on the other side. Between them the law is continued smoothly.
//
// Both start `range` of the law apart (or touching) and move freely until then. A contact that is pulled back while it
// comes apart has too little energy to break ever after: it sticks. Speeds are those far apart.
//
// A. Hindmarsh et al., SUNDIALS, ACM Trans. Math. Softw. 31:363 (2005).
#include <cstddef>
#include <optional>

#include "dem/contact/force_pass.hpp"
#include "dem/contact/laws.hpp"

namespace dem {

struct Ball {
  double mass = 0.0;         ///< kg
  double radius = 0.0;       ///< m
  std::size_t material = 0;  ///< index into the tables of laws
  Vec3 velocity;             ///< m/s
  Vec3 spin;                 ///< rad/s
};

/// The sphere comes from +z onto the partner, or onto a plane of the body.
struct Encounter {
  Ball sphere;
  std::optional<Ball> partner;
  std::size_t body = 0;
};

enum class CollisionEnd { parted, sticks, never_touched };

struct Collision {
  CollisionEnd end = CollisionEnd::never_touched;
  double restitution = 0.0;      ///< normal speed after / before; 0 when it sticks
  double duration = 0.0;         ///< s from touch to release; 0 when it sticks
  double largest_overlap = 0.0;  ///< m
  double largest_push = 0.0;     ///< N
  Vec3 velocity, partner_velocity;
  Vec3 spin, partner_spin;
};

/// Throws std::runtime_error if CVODE fails.
Collision collide(const ForcePass& laws, const Encounter& encounter);

struct WantedRestitution {
  double restitution = 0.7;
  double speed = 0.1;  ///< m/s, of approach
};

struct FoundDamping {
  std::optional<double> damping_ratio;  ///< none: no damping gives as much, since the attraction alone takes more
  Collision collision;                  ///< the collision with this damping; where there is none, with zero damping
};

/// The damping ratio zeta of this pair that gives the wanted restitution head on, within 1e-8. The damping ratio in
/// `bed` is not read. Radii and masses of the pair are those of the encounter; its velocities are not read.
FoundDamping damping_for(const WantedRestitution& wanted, const BedCoefficients& bed, Encounter encounter);

}  // namespace dem
