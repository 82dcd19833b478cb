// The pair integrated by CVODE (dem/contact/collision.hpp) against closed forms, and the simulation against the pair.
// Closed forms: duration pi / (w0 sqrt(1 - zeta^2)) of the linear spring-dashpot; Hertz as in impact.cpp; clamped
// restitutions and sticking speeds f(e) F / sqrt(m* k) of the project's verification sheet, derived there.
#include "data/random.hpp"
#include "tests/dem/shot.hpp"

namespace {

dem::Encounter head_on(const dem::Case& c, double speed, bool on_wall = false) {
  dem::Encounter e;
  e.sphere = scene::ball(c.material.density, 0.5 * c.material.diameter);
  e.sphere.velocity.z = -speed;
  if (!on_wall) e.partner = scene::ball(c.material.density, 0.5 * c.material.diameter);
  return e;
}

dem::Collision reference(const dem::Case& c, const dem::Encounter& e) {
  return dem::collide(*dem::make_force_pass(scene::bed_for(c, e)), e);
}

/// Every law that can be composed from a normal part, with all that attracts and resists.
std::vector<std::pair<std::string, dem::Case>> families() {
  std::vector<std::pair<std::string, dem::Case>> all;
  for (const double e : {1.0, 0.8}) {
    dem::Case c;
    c.contact.restitution = e;
    all.emplace_back(fmt::format("linear, e {}", e), c);
    c.contact.hamaker = 2e-18;
    c.contact.resistance = dem::ResistanceLaw::constant;
    c.contact.rolling_friction = c.contact.twisting_friction = 0.1;
    all.emplace_back(fmt::format("linear, van der Waals, constant rolling, e {}", e), c);
    c.contact.hamaker = 0.0;
    c.contact.normal = dem::NormalLaw::hertz;
    c.contact.resistance = dem::ResistanceLaw::none;
    all.emplace_back(fmt::format("Hertz-Mindlin, e {}", e), c);
    c.contact.cohesion = dem::Cohesion::dmt;
    c.contact.work_of_adhesion = 0.005;
    c.contact.resistance = dem::ResistanceLaw::spring;
    all.emplace_back(fmt::format("Hertz-Mindlin, DMT, rolling spring, e {}", e), c);
    c.contact.normal = dem::NormalLaw::jkr;
    all.emplace_back(fmt::format("JKR, rolling spring, e {}", e), c);
    c.contact.resistance = dem::ResistanceLaw::none;
    all.emplace_back(fmt::format("JKR, e {}", e), c);
  }
  return all;
}

}  // namespace

TEST_CASE("the pair's equation has the closed form's restitution and duration, linear and Hertz", "[table]") {
  dem::Case c;
  c.material.density = 5000.0;
  c.contact.stiffness = 1000.0;
  c.contact.restitution = 0.5;
  scene::row("CVODE, linear, duration [us]", 83.3, 1e6 * reference(c, head_on(c, 0.1)).duration, {1e-3});
  for (const auto normal : {dem::NormalLaw::linear, dem::NormalLaw::hertz}) {
    c.contact.normal = normal;
    for (const double e : {1.0, 0.9, 0.5, 0.2}) {
      c.contact.restitution = e;
      for (const bool wall : {false, true}) {
        const dem::Collision r = reference(c, head_on(c, 0.1, wall));
        CHECK(r.end == dem::CollisionEnd::parted);
        CHECK(r.restitution == Approx(e).epsilon(1e-6));
      }
    }
  }
}

TEST_CASE("with the dashpot's tension clamped the pair has the clamped closed form", "[table]") {
  const double expected[][2] = {{0.9, 0.9020}, {0.7, 0.7182}, {0.5, 0.5503}, {0.3, 0.3971}};
  for (const auto& [e, clamped] : expected) {
    dem::Case c;
    c.contact.restitution = e;
    c.contact.tension = dem::DashpotTension::clamped;
    scene::row(fmt::format("CVODE, clamped, restitution {}", e), clamped, reference(c, head_on(c, 0.1)).restitution,
               {2e-4});
  }
}

TEST_CASE("the pair sticks below the sticking speed, whose factor is that of the closed form", "[table]") {
  const double expected[][3] = {{0.9, 0.713, 0.713}, {0.7, 1.615, 1.612}, {0.5, 2.954, 2.900}, {0.3, 5.918, 5.332}};
  for (const auto& [e, allowed, clamped] : expected) {
    for (const auto tension : {dem::DashpotTension::allowed, dem::DashpotTension::clamped}) {
      double factor[2];
      for (int k = 0; k < 2; ++k) {
        dem::Case c;
        c.contact.restitution = e;
        c.contact.tension = tension;
        c.contact.stiffness = k == 0 ? 100.0 : 400.0;
        c.contact.hamaker = 1e-18;
        c.contact.cut_off = c.contact.minimum_separation = 1.5e-13;  // in contact only, as in the closed form
        c.contact.hamaker *= 1e-8;
        const dem::Derived d = dem::derive(c);
        const double unit = d.pull_off / std::sqrt(0.5 * d.mass * c.contact.stiffness);
        double low = 0.3, high = 10.0;
        for (int j = 0; j < 14; ++j) {
          const double middle = 0.5 * (low + high);
          const auto end = reference(c, head_on(c, middle * unit)).end;
          REQUIRE(end != dem::CollisionEnd::never_touched);
          (end == dem::CollisionEnd::sticks ? low : high) = middle;
        }
        factor[k] = 0.5 * (low + high);
      }
      const bool may_pull = tension == dem::DashpotTension::allowed;
      scene::row(fmt::format("sticking speed factor, restitution {}, tension {}", e, may_pull ? "allowed" : "clamped"),
                 may_pull ? allowed : clamped, factor[0], {2e-3});
      CHECK(factor[1] == Approx(factor[0]).epsilon(2e-3));
    }
  }
}

TEST_CASE(
    "the damping found for a wanted restitution gives it, with attraction, and none is found where the pair sticks",
    "[table]") {
  dem::Case c;
  const dem::Encounter e = head_on(c, 0.1);
  CHECK(dem::damping_for({0.7, 0.1}, scene::bed_for(c, e), e).damping_ratio.value() ==
        Approx(dem::damping_ratio(0.7)).epsilon(1e-5));
  c.contact.hamaker = 9e-18;
  for (const auto normal : {dem::NormalLaw::linear, dem::NormalLaw::jkr}) {
    c.contact.normal = normal;
    c.contact.work_of_adhesion = 0.05;
    const dem::FoundDamping found = dem::damping_for({0.5, 0.1}, scene::bed_for(c, e), e);
    REQUIRE(found.damping_ratio);
    CHECK(found.collision.restitution == Approx(0.5).epsilon(1e-6));
    dem::BedCoefficients bed = scene::bed_for(c, e);
    bed.grain[0].damping_ratio = *found.damping_ratio;
    const double simulated = scene::over_phases(bed, e, found.collision.duration / 300.0, 0.5).mean;
    scene::row(fmt::format("restitution with attraction by the damping found, {}",
                           normal == dem::NormalLaw::linear ? "van der Waals" : "JKR"),
               0.5, simulated, {0.003});
  }
  c.contact.work_of_adhesion = 5.0;
  const dem::FoundDamping none = dem::damping_for({0.5, 0.02}, scene::bed_for(c, e), e);
  CHECK(!none.damping_ratio);
  CHECK(none.collision.end == dem::CollisionEnd::sticks);
}

TEST_CASE("a JKR pair of any radii has the damping for its restitution, or none since adhesion takes more") {
  // Which radii met a root function of exactly zero hung on their last digits.
  data::RandomStream random(3, data::Purpose::test);
  const auto between = [&](double low, double high) { return low * std::pow(high / low, random.uniform()); };
  int found_count = 0;
  for (int k = 0; k < 40; ++k) {
    dem::Case c;
    c.contact.normal = dem::NormalLaw::jkr;
    c.contact.young_modulus = between(1e6, 1e8);
    c.contact.work_of_adhesion = between(1e-3, 0.2);
    dem::Encounter e;
    e.sphere = scene::ball(c.material.density, between(0.3e-3, 0.6e-3));
    e.partner = scene::ball(c.material.density, between(0.3e-3, 0.6e-3));
    const double speed = between(0.05, 0.5);
    CAPTURE(k, c.contact.young_modulus, c.contact.work_of_adhesion, e.sphere.radius, e.partner->radius, speed);
    dem::FoundDamping found;
    REQUIRE_NOTHROW(found = dem::damping_for({0.7, speed}, scene::bed_for(c, e), e));
    if (found.damping_ratio)
      CHECK(found.collision.restitution == Approx(0.7).epsilon(1e-6));
    else
      CHECK(found.collision.restitution < 0.7);
    found_count += found.damping_ratio.has_value();
  }
  CHECK(found_count > 20);
}

TEST_CASE("the simulated collision goes to CVODE's as the time step is refined, under every law, head on and oblique",
          "[table]") {
  for (const auto& [name, c] : families()) {
    for (const bool wall : {false, true}) {
      for (const double slip : {0.0, 0.04, 0.3}) {
        dem::Encounter e = head_on(c, 0.1, wall);
        e.sphere.velocity.x = slip;
        e.sphere.spin = {20.0, -10.0, 30.0};
        CAPTURE(name, wall, slip);
        const dem::Collision exact = reference(c, e);
        REQUIRE(exact.end == dem::CollisionEnd::parted);
        const double radius = e.sphere.radius, speed = std::hypot(0.1, slip);
        double error[2] = {};
        for (int fine = 0; fine < 2; ++fine) {
          for (const double phase : {0.2, 0.7}) {
            const dem::Collision r =
                scene::shoot(scene::bed_for(c, e), e, {exact.duration / (fine ? 400.0 : 50.0), phase});
            error[fine] = std::max({error[fine], dem::length(r.velocity - exact.velocity) / speed,
                                    radius * dem::length(r.spin - exact.spin) / speed});
          }
        }
        INFO(name << (wall ? ", wall" : ", spheres") << ", slip " << slip << ": " << error[0] << ", " << error[1]);
        // First order: within the error of the coarser step over the ratio of steps, or small.
        CHECK(error[0] < 0.03);
        CHECK(error[1] < 0.004);
      }
    }
  }
}
