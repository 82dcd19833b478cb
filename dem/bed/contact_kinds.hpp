#pragma once
// The kinds of contact in a bed, between two materials or between a material and a body: pull-off, damping, and the
// least duration of a contact of each kind, from which the time step follows.
//
// Durations, for the lightest spheres of the kind:
//   linear      pi / (w0 sqrt(1 - zeta^2)), w0 = sqrt(k / m*); m* = m/2 between equal spheres, m at a wall
//   hertz, jkr  the shortest of
//               - an elastic impact at the highest speed expected, of the tool's tip or of a fall through the fill,
//                 v = max(tip, sqrt(2 g depth)): 2 sqrt(pi) Gamma(7/5) / Gamma(9/10) overlap / v, overlap = (15 m* v^2
//                 / (16 E* sqrt(R*)))^(2/5) (H. Hertz, J. reine angew. Math. 92:156 (1881));
//               - half a period of a contact held by the attraction and the fill's weight: pi sqrt(m* / (2 E* a));
//               - 6 Rayleigh times of the smallest sphere, pi r sqrt(rho / G) / (0.1631 nu + 0.8766), so that at 30
//                 steps the time step is at most the usual fifth of one.
//
// With contact.restitution_at each kind has its own damping ratio: its mean spheres, meeting at that speed, come apart
// with the wanted restitution, the attraction and the dashpot's tension included (dem/contact/collision.hpp). Other
// sizes of the kind share the ratio. The duration is then at most that of this collision, and at most pi / (2 zeta w),
// w of the stiffest contact met, so that a dashpot of any strength is followed.
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dem/case/case.hpp"
#include "dem/contact/collision.hpp"
#include "dem/contact/laws.hpp"

namespace dem {

struct ContactKind {
  std::string first, second;            ///< materials, or material and body
  std::size_t material = 0, other = 0;  ///< their indices
  bool wall = false;                    ///< second is a body
  PairCoefficients law;
  double mass = 0.0, radius = 0.0;    ///< kg, m, reduced, of mean spheres
  double pull_off = 0.0;              ///< N, of mean spheres
  double bond = 0.0;                  ///< Bond number of the lighter of the mean spheres
  double load = 0.0;                  ///< N, that presses on the contact at rest at the bottom of the fill
  double rest_overlap = 0.0;          ///< share of a radius, under load and attraction
  double duration = 0.0;              ///< s, shortest duration, of the lightest spheres
  std::string duration_of;            ///< which motion has this duration
  std::optional<FoundDamping> found;  ///< the damping found where restitution_at is set
};

/// The conditions that the rig sets for every kind of contact.
struct Conditions {
  double depth = 0.0;  ///< m, of the fill
  double speed = 0.0;  ///< m/s, highest speed of impacts
};
Conditions conditions_of(const Case& c);

struct Contacts {
  BedCoefficients bed;  ///< with the damping found
  std::vector<ContactKind> kinds;
};
Contacts contacts_of(const Case& c, const Conditions& rig);

/// Restitution e of a linear spring-dashpot with dashpot tension: the inverse of damping_ratio (dem/bed/derived.hpp).
double restitution_of(double damping_ratio);

}  // namespace dem
