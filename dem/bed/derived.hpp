#pragma once
// What follows from a case: the resolved coefficients of the contact laws, pull-off forces, Bond numbers, time step.
//
// Coarse graining, Tanaka et al. eq. (2): H* = l^3 H. L is the length of the simulated sphere (its diameter or radius,
// as chosen; of unequal spheres 4 R* or 2 R*). Bond number = pull-off force / weight of the lighter sphere.
//
// The time step is the shortest duration of any kind of contact in the bed (dem/bed/contact_kinds.hpp) divided by
// run.steps_per_contact.
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "dem/bed/contact_kinds.hpp"
#include "dem/case/case.hpp"
#include "dem/contact/laws.hpp"
#include "dem/rig/rig.hpp"

namespace dem {

struct Derived {
  std::size_t spheres = 0;
  double mass = 0.0;                           ///< kg, mass of a sphere; the mean where spheres differ
  double weight = 0.0;                         ///< N, mean weight of a sphere
  double diameter = 0.0;                       ///< m, diameter of a sphere of that mass
  double smallest = 0.0, largest = 0.0;        ///< m, diameters of the smallest and the largest sphere
  double length_scale = 0.0;                   ///< m, L of eq. (1), of a sphere of that diameter
  double hamaker = 0.0, wall_hamaker = 0.0;    ///< J, H* in use
  double original_hamaker = 0.0;               ///< J, H* / l^n
  double pull_off = 0.0, wall_pull_off = 0.0;  ///< N, between the first component and itself, and the first body
  double bond = 0.0, wall_bond = 0.0;
  double damping_ratio = 0.0;  ///< zeta of the first kind of contact
  Conditions conditions;       ///< conditions that the rig sets
  BedCoefficients bed;         ///< with the rig's bodies, and the damping that restitution_at asks for
  std::vector<ContactKind> kinds;
  double contact_duration = 0.0;  ///< s, duration of the shortest contact
  std::string duration_of;        ///< which contact that is
  double time_step = 0.0;         ///< s
  double skin = 0.0;              ///< m
};

Derived derive(const Case& c);

/// A case that was looked through and found without problems, and what follows from it. Only `prepare`
/// (dem/reading/prepare.hpp) makes one, so that nothing runs, or is foretold, unchecked.
class PreparedCase {
 public:
  const Case& given() const { return case_; }
  const Derived& derived() const { return derived_; }

 private:
  friend PreparedCase prepare(Case c);
  PreparedCase(Case c, Derived d) : case_(std::move(c)), derived_(std::move(d)) {}
  Case case_;
  Derived derived_;
};

/// Attraction, time step and damping as lines for the user.
std::vector<std::string> describe(const Case& c, const Derived& d);

/// The coefficients of this case for bodies with these labels (rig.hpp), or for a number of equal bodies. The damping
/// is that of a collision without attraction.
BedCoefficients make_bed(const Case& c, const std::vector<BodyLabel>& bodies);
BedCoefficients make_bed(const Case& c, std::size_t bodies);

/// The elastic moduli of a grain or a wall, of which those of a pair are made (dem/bed/bed.cpp).
struct Elastic {
  double young_modulus = 0.0;  ///< Pa
  double poisson_ratio = 0.0;
  double softened = 0.0;  ///< Pa, stands against contact.true_young_modulus
  double flexible() const { return (1.0 - poisson_ratio * poisson_ratio) / young_modulus; }
  double shearing() const { return 2.0 * (2.0 - poisson_ratio) * (1.0 + poisson_ratio) / young_modulus; }
};
Elastic elastic(const Case& c, const Material& m);
/// Those of a wall where it meets a grain: of the bed's component of that name, or the walls' modulus, or the grain's.
Elastic elastic(const Case& c, const Material& grain, const BodyLabel& body);

/// zeta of a linear spring-dashpot with dashpot tension for a restitution in (0, 1].
double damping_ratio(double restitution);

/// H* [J] of a constant that is given as hamaker_of says.
double hamaker_in_use(const Case& c, double given);

}  // namespace dem
