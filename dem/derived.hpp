#pragma once
// What follows from a case: the resolved coefficients of the contact laws, pull-off forces, Bond numbers, time step.
//
// Coarse graining, Tanaka et al. eq. (2): H* = l^3 H. L is that of the simulated sphere (its diameter or radius, as
// chosen; of unequal spheres 4 R* or 2 R*). Bond number = pull-off force / weight of the lighter sphere.
//
// The time step is the shortest contact duration of any kind of contact in the bed, between its lightest spheres,
// divided by run.steps_per_contact:
//   linear      pi / (w0 sqrt(1 - zeta^2)), w0 = sqrt(k / m*); m* = m/2 between equal spheres, m at a wall
//   hertz, jkr  the shortest of
//               - an elastic impact at the highest speed expected, that of the tool's tip or of a fall through the
//               fill,
//                 v = max(tip, sqrt(2 g depth)): 2 sqrt(pi) Gamma(7/5) / Gamma(9/10) overlap / v, overlap = (15 m* v^2
//                 / (16 E* sqrt(R*)))^(2/5) (H. Hertz, J. reine angew. Math. 92:156 (1881));
//               - half a period of a contact held by the attraction and the fill's weight: pi sqrt(m* / (2 E* a));
//               - 6 Rayleigh times of the smallest sphere, pi r sqrt(rho / G) / (0.1631 nu + 0.8766), so that at 30
//                 steps the time step is at most the usual fifth of one.
// With restitution_at the duration is also no longer than that of the collision it was found from (dem/collision.hpp).
#include <cstddef>
#include <string>
#include <vector>

#include "dem/case.hpp"
#include "dem/laws.hpp"
#include "dem/rig.hpp"

namespace dem {

/// One kind of contact in the bed.
struct ContactKind {
  std::string first, second;  ///< materials, or material and body
  bool wall = false;          ///< second is a body
  PairCoefficients law;
  double mass = 0.0, radius = 0.0;  ///< kg, m, reduced, of mean spheres
  double pull_off = 0.0;            ///< N, of mean spheres
  double bond = 0.0;                ///< of the lighter of them
  double load = 0.0;                ///< N, that presses on it at rest at the bottom of the fill
  double rest_overlap = 0.0;        ///< of a radius, under load and attraction
  double duration = 0.0;            ///< s, shortest, of the lightest spheres
  std::string duration_of;          ///< what that is the duration of
};

struct Derived {
  std::size_t spheres = 0;
  double mass = 0.0;                           ///< kg, one sphere; the mean where they differ
  double weight = 0.0;                         ///< N, alike
  double diameter = 0.0;                       ///< m, of that mass
  double smallest = 0.0, largest = 0.0;        ///< m
  double length_scale = 0.0;                   ///< m, L of eq. (1), of that sphere
  double hamaker = 0.0, wall_hamaker = 0.0;    ///< J, H* in use
  double original_hamaker = 0.0;               ///< J, H* / l^3
  double pull_off = 0.0, wall_pull_off = 0.0;  ///< N, of the first component with itself and the first body
  double bond = 0.0, wall_bond = 0.0;
  double damping_ratio = 0.0;  ///< zeta, alike
  double impact_speed = 0.0;   ///< m/s, highest expected
  std::vector<ContactKind> kinds;
  double contact_duration = 0.0;  ///< s, of the shortest
  std::string duration_of;        ///< which that is
  double time_step = 0.0;         ///< s
  double skin = 0.0;              ///< m
};

Derived derive(const Case& c);

/// Attraction, time step and damping as lines for the user.
std::vector<std::string> describe(const Case& c, const Derived& d);

/// The coefficients of this case for bodies so labelled (rig.hpp), or for a number of bodies alike.
BedCoefficients make_bed(const Case& c, const std::vector<BodyLabel>& bodies);
BedCoefficients make_bed(const Case& c, std::size_t bodies);

/// zeta of a linear spring-dashpot with dashpot tension for a restitution in (0, 1].
double damping_ratio(double restitution);

/// H* of a constant given as hamaker_of says [J].
double hamaker_in_use(const Case& c, double given);

}  // namespace dem
