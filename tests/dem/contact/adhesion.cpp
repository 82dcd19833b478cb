// Pulling two spheres, or a sphere and a plane, apart slowly. JKR: pull-off force F = 3/2 pi w R*; with the distance
// imposed the contact tears 3/4 (pi^2 w^2 R* / E*^2)^(1/3) beyond touching, at 5/9 F (K. Johnson, K. Kendall, A.
// Roberts, Proc. R. Soc. A 324:301 (1971); K. Johnson, Contact Mechanics, 1985). DMT: 2 pi w R* in contact, nothing
// beyond (B. Derjaguin, V. Muller, Y. Toporov, J. Colloid Interface Sci. 53:314 (1975)).
#include "tests/dem/shot.hpp"

namespace {

struct Pull {
  double largest = 0.0;  ///< N
  double at_tear = 0.0;  ///< N, the last before the contact broke
  double torn_at = 0.0;  ///< m, gap
};

/// The wall comes off a frozen sphere, at a speed so low that nothing but the distance matters.
Pull pull_off_wall(const dem::Case& c) {
  const double radius = 0.5 * c.material.diameter, sink = 2e-4 * radius, speed = 1e-3;
  dem::Setup s = scene::box(c, {{0.0, 0.0, radius - sink}}, {});
  s.spheres.frozen = {1};
  s.bodies.push_back(scene::floor(10.0 * radius));
  // Down by an oscillation whose quarter period is long: the wall's shift is amplitude * sin(2 pi f t).
  const double amplitude = 0.1 * radius, frequency = speed / (2.0 * std::numbers::pi * amplitude);
  s.bodies[0].motion.oscillations = {{dem::OscillationKind::along, {0.0, 0.0, -1.0}, amplitude, frequency, 0.0}};
  s.time_step = sink / speed / 4000.0;
  dem::Simulation sim(std::move(s));
  Pull p;
  bool touched = false;
  for (int k = 0; k < 200000; ++k) {
    const bool touching = sim.sums().wall_contacts > 0;
    const double pull = -sim.state().load[0].force.z;
    if (touched && !touching) break;
    touched = touching;
    p.largest = std::max(p.largest, pull);
    p.at_tear = pull;
    p.torn_at = amplitude * std::sin(2.0 * std::numbers::pi * frequency * sim.time()) - sink;
    sim.step();
  }
  return p;
}

dem::Case sticky(dem::NormalLaw normal) {
  dem::Case c;
  c.contact.normal = normal;
  c.contact.cohesion = dem::Cohesion::dmt;
  c.contact.work_of_adhesion = 0.02;
  c.contact.restitution = 1.0;  // no dashpot in a quasi-static pull
  return c;
}

}  // namespace

TEST_CASE("JKR: a sphere comes off a plane at 3/2 pi w R*, and tears at its distance with 5/9 of that", "[table]") {
  const dem::Case c = sticky(dem::NormalLaw::jkr);
  const dem::PairCoefficients wall = dem::make_bed(c, 1).wall[0];
  const double radius = 0.5 * c.material.diameter, w = wall.adhesion, modulus = wall.young_modulus;
  const double pull_off = 1.5 * std::numbers::pi * w * radius;
  const double tear = 0.75 * std::cbrt(std::pow(std::numbers::pi * w / modulus, 2) * radius);
  const Pull p = pull_off_wall(c);
  scene::row("JKR pull-off [uN]", 1e6 * pull_off, 1e6 * p.largest, {1e-3});
  scene::row("JKR tear distance [um]", 1e6 * tear, 1e6 * p.torn_at, {0.01});
  scene::row("JKR force at tear / pull-off", 5.0 / 9.0, p.at_tear / pull_off, {0.05});
}

TEST_CASE("JKR: the contact radius solves its equation from break-off on, as closely as the distance is known") {
  const double b = dem::JkrNormal::break_root;
  for (double e = 1e-7; e < 30.0; e *= 1.3) {
    const double y = b + e;
    const double d = y * (y * y * y - 2.0 / 3.0);
    const double slope = 4.0 * y * y * y - 2.0 / 3.0;
    INFO("y - b = " << e);
    CHECK(std::abs(dem::JkrNormal::At<double>::root(d) - y) < 1e-13 * y + 4e-16 * (std::abs(d) + 0.5 * b) / slope);
  }
}

TEST_CASE("DMT: a sphere comes off a plane at 2 pi w R*, and is free beyond touching", "[table]") {
  const dem::Case c = sticky(dem::NormalLaw::hertz);
  const Pull p = pull_off_wall(c);
  const double pull_off = 2.0 * std::numbers::pi * c.contact.work_of_adhesion * 0.5 * c.material.diameter;
  scene::row("DMT pull-off [uN]", 1e6 * pull_off, 1e6 * p.largest, {1e-3});
  CHECK(std::abs(p.torn_at) < 1e-6 * c.material.diameter);
}

TEST_CASE("JKR between spheres: the pull-off force is that of the reduced radius", "[table]") {
  const dem::Case c = sticky(dem::NormalLaw::jkr);
  dem::Encounter e;
  e.sphere = scene::ball(c.material.density, 0.4e-3);
  e.partner = scene::ball(c.material.density, 0.1e-3);
  const auto laws = dem::make_force_pass(scene::bed_for(c, e));
  const double reduced = 0.08e-3;
  const dem::Who who{dem::Partner::sphere, 0, 0, 1e-9, reduced};
  dem::History<double> held;
  held.radius = 1.0;
  double largest = 0.0;
  for (int k = 0; k <= 20000; ++k) {
    const double overlap = laws->holds(who) * (-1.0 + k / 5000.0);
    largest = std::max(largest, -laws->react(who, {{0.0, 0.0, 1.0}, overlap, {}, {}}, held, 1e-6).push);
  }
  scene::row("JKR pull-off, radii 0.4 and 0.1 mm [uN]", 1e6 * 1.5 * std::numbers::pi * 0.02 * reduced, 1e6 * largest,
             {1e-4});
}
