// The eight impact tests of Y. C. Chung and J. Y. Ooi, Granular Matter 13:643 (2011), Hertz-Mindlin, through the whole
// Simulation at the default time step, a thirtieth of the contact. Closed forms of gross sliding (rigid-body impact):
// velocities tangential to the wall follow from the impulse mu (1+e) m V_n. Tests 1 and 2: F_max = 4/3 E* sqrt(R*)
// d^1.5, d = (15 m* V^2 / 16 E* sqrt(R*))^(2/5), duration 2.868 (m*^2 / R* E*^2 V)^(1/5) (K. Johnson, Contact
// Mechanics, 1985). Digitised: the curves of the paper that Kratos DEMApplication compares with.
//
// Two of our conventions show. A wall's friction acts at the distance of the wall, overlap included: the spin of test
// 5, whose sphere sinks in by 1 %, falls short of the rigid body's by the overlap weighted with the force, B(7/5, 1/2)
// / 2 of the largest. And a dashpot that may pull takes away from the normal impulse at the end, where friction has
// stopped: tests 6 to 8 clamp the tension, with the damping that so gives the wanted restitution.
#include "tests/dem/shot.hpp"

namespace {

struct Solid {
  double young_modulus, poisson_ratio, density;  // Pa, -, kg/m3
};

dem::Case hertz(Solid solid, double radius, double restitution, double friction) {
  dem::Case c;
  c.material.diameter = 2.0 * radius;
  c.material.density = solid.density;
  c.contact.normal = dem::NormalLaw::hertz;
  c.contact.young_modulus = solid.young_modulus;
  c.contact.poisson_ratio = solid.poisson_ratio;
  c.contact.wall_young_modulus = std::numeric_limits<double>::infinity();
  c.contact.restitution = restitution;
  c.contact.friction = friction;
  return c;
}

dem::Encounter onto_wall(const dem::Case& c, dem::Vec3 velocity, dem::Vec3 spin = {}) {
  dem::Encounter e;
  e.sphere = scene::ball(c.material.density, 0.5 * c.material.diameter);
  e.sphere.velocity = velocity;
  e.sphere.spin = spin;
  return e;
}

/// Seconds: the duration of the head-on contact.
double contact_duration(const dem::Case& c, dem::Encounter e) {
  e.sphere.velocity.x = e.sphere.velocity.y = 0.0;
  e.sphere.spin = {};
  if (e.partner) e.partner->velocity.x = e.partner->velocity.y = 0.0;
  if (e.partner) e.partner->spin = {};
  return dem::collide(*dem::make_force_pass(scene::bed_for(c, e)), e).duration;
}

dem::Collision shot(const dem::Case& c, const dem::Encounter& e, double steps = 30.0) {
  return scene::shoot(scene::bed_for(c, e), e, {contact_duration(c, e) / steps, 0.5});
}

/// Tension clamped, with the damping that so gives the case's restitution.
dem::Collision clamped_shot(dem::Case c, const dem::Encounter& e, double speed) {
  c.contact.tension = dem::DashpotTension::clamped;
  dem::BedCoefficients bed = scene::bed_for(c, e);
  const dem::FoundDamping found = dem::damping_for({c.contact.restitution, speed}, bed, e);
  bed.grain[0].damping_ratio = bed.wall[0].damping_ratio = found.damping_ratio.value();
  return scene::shoot(bed, e, {found.collision.duration / 30.0, 0.5});
}

constexpr Solid glass{48e9, 0.20, 2800.0}, aluminium{70e9, 0.30, 2699.0}, oxide{380e9, 0.23, 4000.0};

}  // namespace

TEST_CASE("Chung & Ooi 1: two glass spheres head on, elastic, have the force, overlap and duration of Hertz",
          "[table]") {
  const dem::Case c = hertz(glass, 10e-3, 1.0, 0.35);
  dem::Encounter e = onto_wall(c, {0.0, 0.0, -10.0});
  e.partner = scene::ball(2800.0, 10e-3);
  e.partner->velocity.z = 10.0;
  const dem::Collision r = shot(c, e);
  scene::row("C&O 1 largest force [N]", 10697.0, r.largest_push, {0.005});
  scene::row("C&O 1 largest overlap [um]", 274.1, 1e6 * r.largest_overlap, {0.005});
  scene::row("C&O 1 duration [us]", 40.34, 1e6 * r.duration, {0.005});
  scene::row("C&O 1 restitution", 1.0, r.restitution, {0.005});
}

TEST_CASE("Chung & Ooi 2: a sphere on a rigid wall, elastic, has the force, overlap and duration of Hertz", "[table]") {
  const dem::Case c = hertz(aluminium, 0.1, 1.0, 0.0);
  const dem::Collision r = shot(c, onto_wall(c, {0.0, 0.0, -0.2}));
  scene::row("C&O 2 largest force [N]", 11370.0, r.largest_push, {0.005});
  scene::row("C&O 2 largest overlap [um]", 49.72, 1e6 * r.largest_overlap, {0.005});
  scene::row("C&O 2 duration [us]", 731.6, 1e6 * r.duration, {0.005});
}

TEST_CASE("Chung & Ooi 3: a sphere rebounds from a wall with the restitution that was put in", "[slow][table]") {
  for (const double e : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    const dem::Case c = hertz(oxide, 2.5e-3, e, 0.0);
    const dem::Encounter shot_at = onto_wall(c, {0.0, 0.0, -3.9});
    const double duration = contact_duration(c, shot_at);
    double worst[2];
    for (const int fine : {0, 1}) {
      const int steps = fine ? 120 : 30;
      const scene::Phases p = scene::over_phases(scene::bed_for(c, shot_at), shot_at, duration / steps, e);
      scene::row(fmt::format("C&O 3 restitution {}, duration/{}, mean of 40 phases (worst {:.2f} %)", e, steps,
                             100.0 * p.worst),
                 e, p.mean,
                 {fine       ? 0.002
                  : e >= 0.7 ? 0.005
                             : 0.03});
      worst[fine] = p.worst;
    }
    // First order in the step: a quarter of it has a quarter of the worst miss.
    if (e < 1.0) CHECK(worst[1] < 0.35 * worst[0]);
  }
}

TEST_CASE("Chung & Ooi 4: oblique impact at 3.9 m/s, sliding by the closed form and sticking near the measured curve",
          "[table]") {
  const double mu = 0.092, e = 0.98, speed = 3.9, radius = 2.5e-3;
  const dem::Case c = hertz(oxide, radius, e, mu);
  const auto coming = [&](double degrees) {
    const double theta = degrees * std::numbers::pi / 180.0;
    return onto_wall(c, {speed * std::sin(theta), 0.0, -speed * std::cos(theta)});
  };
  for (const double degrees : {40.02, 50.00, 59.98, 69.96, 85.01}) {
    const double theta = degrees * std::numbers::pi / 180.0;
    const dem::Collision r = shot(c, coming(degrees));
    scene::row(fmt::format("C&O 4 tangential restitution at {} deg", degrees), 1.0 - mu * (1.0 + e) / std::tan(theta),
               r.velocity.x / (speed * std::sin(theta)), {0.002});
    scene::row(fmt::format("C&O 4 spin at {} deg [rad/s]", degrees),
               2.5 * mu * (1.0 + e) * speed * std::cos(theta) / radius, r.spin.y, {0.005});
    const double slip = r.velocity.x - radius * r.spin.y;
    scene::row(fmt::format("C&O 4 rebound angle of the contact at {} deg [deg]", degrees),
               std::atan((std::tan(theta) - 3.5 * mu * (1.0 + e)) / e) * 180.0 / std::numbers::pi,
               std::atan2(slip, r.velocity.z) * 180.0 / std::numbers::pi, {0.005, 0.1});
  }
  const double digitised[][2] = {{5.17, 0.948},  {10.16, 0.687}, {14.99, 0.624},
                                 {20.06, 0.616}, {25.05, 0.634}, {30.12, 0.684}};
  for (const auto& [degrees, f] : digitised) {
    const dem::Encounter e0 = coming(degrees);
    const double exact =
        dem::collide(*dem::make_force_pass(scene::bed_for(c, e0)), e0).velocity.x / e0.sphere.velocity.x;
    const auto with = [&](double steps) { return shot(c, e0, steps).velocity.x / e0.sphere.velocity.x; };
    const double coarse = with(30.0), fine = with(300.0);
    const std::string what = fmt::format("C&O 4 tangential restitution at {} deg, sticking, ", degrees);
    // At the smallest angle the law itself, integrated exactly, is 10 % off the curve: no step mends it.
    scene::row(what + "digitised against CVODE", f, exact, {degrees < 10.0 ? 0.11 : 0.03});
    scene::row(what + "CVODE against duration/30", exact, coarse, {0.01});
    scene::row(what + "CVODE against duration/300", exact, fine, {0.0005});
  }
}

TEST_CASE("Chung & Ooi 5: oblique elastic impact in gross sliding: x - 7 and -5", "[table]") {
  const double mu = 0.3, normal = 5.0, radius = 10e-6;
  const dem::Case c = hertz(glass, radius, 1.0, mu);
  for (const double x : {8.0, 10.0, 14.0}) {
    for (const double slow : {1.0, 0.01}) {
      const double normal_speed = slow * normal;
      const dem::Collision r = shot(c, onto_wall(c, {x * mu * normal_speed, 0.0, -normal_speed}));
      const double spin = radius * r.spin.y / (mu * normal_speed), slip = r.velocity.x / (mu * normal_speed) - spin;
      const double shorter = std::beta(1.4, 0.5) / 2.0 * r.largest_overlap / radius;
      const std::string at = fmt::format(" after, x = {}, {} m/s", x, normal_speed);
      scene::row("C&O 5 spin" + at + (slow == 1.0 ? ", arm less overlap" : ""),
                 5.0 * (slow == 1.0 ? 1.0 - shorter : 1.0), spin, {0.005});
      scene::row("C&O 5 slip" + at + (slow == 1.0 ? ", arm less overlap" : ""),
                 x - 7.0 + (slow == 1.0 ? 5.0 * shorter : 0.0), slip, {0.005});
    }
  }
}

TEST_CASE("Chung & Ooi 6: a spinning sphere dropped on a wall: beta = x - 1 while it slides", "[table]") {
  const double mu = 0.4, e = 0.5, normal = 0.2, radius = 0.1;
  const dem::Case c = hertz(aluminium, radius, e, mu);
  for (const double x : {0.2, 0.4, 0.6}) {
    const double slip = 3.5 * mu * (1.0 + e) * normal / x;
    const dem::Encounter shot_at = onto_wall(c, {0.0, 0.0, -normal}, {0.0, -slip / radius, 0.0});
    const auto beta = [&](const dem::Collision& r) { return -(r.velocity.x - radius * r.spin.y) / slip; };
    const dem::Collision r = clamped_shot(c, shot_at, normal);
    scene::row(fmt::format("C&O 6 tangential restitution of the contact, x = {}", x), x - 1.0, beta(r),
               {0.0, 0.005 * x});
    const double exact = beta(dem::collide(*dem::make_force_pass(scene::bed_for(c, shot_at)), shot_at));
    scene::row(fmt::format("C&O 6 with tension allowed, by CVODE, x = {}", x), exact, beta(shot(c, shot_at)), {0.005});
  }
}

TEST_CASE("Chung & Ooi 7: counter-spinning spheres do not slip, co-spinning ones follow beta = x - 1", "[table]") {
  const double mu = 0.4, e = 0.5, normal = 0.2, radius = 0.1;
  const dem::Case c = hertz(aluminium, radius, e, mu);
  dem::Encounter shot_at = onto_wall(c, {0.0, 0.0, -0.5 * normal});
  shot_at.partner = scene::ball(2699.0, radius);
  shot_at.partner->velocity.z = 0.5 * normal;
  shot_at.sphere.spin.y = 3.0;
  shot_at.partner->spin.y = -3.0;  // surfaces that meet move alike
  const dem::Collision counter = shot(c, shot_at);
  scene::row("C&O 7 counter-spin kept [rad/s]", 3.0, counter.spin.y, {1e-9});
  scene::row("C&O 7 counter-spin, tangential velocity [m/s]", 0.0, counter.velocity.x, {0.0, 1e-12});
  for (const double x : {0.2, 0.4, 0.6}) {
    const double slip = 3.5 * mu * (1.0 + e) * normal / x;
    shot_at.sphere.spin.y = shot_at.partner->spin.y = -0.5 * slip / radius;
    const dem::Collision r = clamped_shot(c, shot_at, normal);
    const double after = r.velocity.x - r.partner_velocity.x - radius * (r.spin.y + r.partner_spin.y);
    scene::row(fmt::format("C&O 7 co-spin, tangential restitution, x = {}", x), x - 1.0, -after / slip,
               {0.0, 0.005 * x});
  }
}

TEST_CASE("Chung & Ooi 8: unequal spheres follow the same line beta = x - 1 while they slide", "[table]") {
  const double mu = 0.4, e = 0.5, normal = 0.2, radius = 0.1;
  const dem::Case c = hertz(aluminium, radius, e, mu);
  for (const double other : {0.05, 0.5}) {
    for (const double x : {0.3, 0.6}) {
      dem::Encounter shot_at = onto_wall(c, {0.0, 0.0, -normal});
      shot_at.partner = scene::ball(2699.0, other);
      const double slip = 3.5 * mu * (1.0 + e) * normal / x;
      shot_at.sphere.spin.y = -slip / radius;
      const dem::Collision r = clamped_shot(c, shot_at, normal);
      const double after = r.velocity.x - r.partner_velocity.x - radius * r.spin.y - other * r.partner_spin.y;
      scene::row(fmt::format("C&O 8 tangential restitution, radii 0.1 and {} m, x = {}", other, x), x - 1.0,
                 -after / slip, {0.0, 0.005 * x});
    }
  }
}

TEST_CASE("an elastic oblique collision is within 0.2 % on average, and second order where it does not slide",
          "[table]") {
  struct Tried {
    dem::NormalLaw normal;
    double friction;
    const char* name;
  };
  // Of a linear spring that never slides the force ends with a jump, at whatever phase of a step that is.
  for (const auto& [normal, friction, name] : {Tried{dem::NormalLaw::linear, 1.0, "linear, sliding at last"},
                                               Tried{dem::NormalLaw::hertz, 1.0, "Hertz-Mindlin, sliding at last"},
                                               Tried{dem::NormalLaw::hertz, 10.0, "Hertz-Mindlin, sticking"}}) {
    dem::Case c = hertz(glass, 2.5e-3, 1.0, friction);
    c.contact.normal = normal;
    for (const bool wall : {true, false}) {
      dem::Encounter e = onto_wall(c, {0.15, 0.0, -0.3}, {5.0, 10.0, 15.0});
      if (!wall) e.partner = scene::ball(c.material.density, 1.5e-3);
      const dem::Collision exact = dem::collide(*dem::make_force_pass(scene::bed_for(c, e)), e);
      const double speed = dem::length(e.sphere.velocity);
      constexpr int phases = 10;
      double mean[2] = {};
      for (int fine = 0; fine < 2; ++fine) {
        const double steps = fine == 0 ? 30.0 : 120.0;
        double worst = 0.0;
        dem::Vec3 velocity, spin;
        for (int k = 0; k < phases; ++k) {
          const dem::Collision r =
              scene::shoot(scene::bed_for(c, e), e, {exact.duration / steps, k / static_cast<double>(phases)});
          const dem::Vec3 v = r.velocity - exact.velocity, w = e.sphere.radius * (r.spin - exact.spin);
          worst = std::max({worst, dem::length(v) / speed, dem::length(w) / speed});
          velocity += (1.0 / phases) * v;
          spin += (1.0 / phases) * w;
        }
        mean[fine] = std::max(dem::length(velocity), dem::length(spin)) / speed;
        scene::row(
            fmt::format("elastic, oblique, {}, {}: miss / speed at duration/{}, mean of {} phases (worst {:.2f} %)",
                        name, wall ? "wall" : "spheres", steps, phases, 100.0 * worst),
            0.0, mean[fine], {0.0, 0.002});
      }
      CHECK(mean[1] < mean[0] / (friction > 1.0 ? 12.0 : 6.0));
    }
  }
}
