#pragma once
// What follows from a case: the resolved coefficients of the contact laws, pull-off forces, Bond numbers, time step.
//
// Coarse graining, Tanaka et al. eq. (2): H* = l^3 H. L is that of the simulated sphere (its diameter or radius, as
// chosen). Bond number = pull-off force / weight of a sphere. Contact duration of the linear spring-dashpot: pi / (w0
// sqrt(1 - zeta^2)), w0 = sqrt(k / m*); m* = m/2 between spheres and m at a wall.
#include <cstddef>

#include "dem/case.hpp"
#include "dem/laws.hpp"

namespace dem {

struct Derived {
  std::size_t spheres = 0;
  double mass = 0.0;          ///< kg, one sphere
  double weight = 0.0;        ///< N
  double length_scale = 0.0;  ///< m, L of eq. (1)
  double wall_friction = 0.0;
  double wall_stiffness = 0.0;                 ///< N/m
  double hamaker = 0.0, wall_hamaker = 0.0;    ///< J, H* in use
  double original_hamaker = 0.0;               ///< J, H* / l^3
  double pull_off = 0.0, wall_pull_off = 0.0;  ///< N
  double bond = 0.0, wall_bond = 0.0;
  double damping_ratio = 0.0;     ///< zeta
  double contact_duration = 0.0;  ///< s, of the stiffest pair
  double time_step = 0.0;         ///< s
  double skin = 0.0;              ///< m
};

Derived derive(const Case& c);

/// The coefficients of this case, for spheres and a number of bodies alike.
BedCoefficients make_bed(const Case& c, std::size_t bodies);

/// zeta of a linear spring-dashpot with dashpot tension for a restitution in (0, 1].
double damping_ratio(double restitution);

}  // namespace dem
