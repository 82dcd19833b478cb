// contact.restitution_at: the damping that gives a restitution with the attraction included. What CVODE found is tried
// in the simulation, whose integrator knows nothing of it.
#include <catch2/catch.hpp>

#include <cmath>

#include "dem/reading/prepare.hpp"
#include "dem/reading/target.hpp"
#include "tests/dem/scene.hpp"

namespace {

/// Mean over phases of the touch within a time step.
double simulated_restitution(const dem::Case& c, double speed) {
  const dem::Derived d = dem::derive(c);
  dem::Case plain = c;  // for the box, whose law and time step are then replaced
  plain.contact.restitution_at.reset();
  const double size = c.material.diameter;
  double mean = 0.0;
  constexpr int phases = 40;
  for (int k = 0; k < phases; ++k) {
    const double gap = c.contact.cut_off + speed * d.time_step * (2.0 + k / static_cast<double>(phases));
    dem::Setup setup = scene::box(plain, {{-0.5 * (size + gap), 0.0, 0.0}, {0.5 * (size + gap), 0.0, 0.0}},
                                  {{0.5 * speed, 0.0, 0.0}, {-0.5 * speed, 0.0, 0.0}});
    setup.laws = dem::make_force_pass(d.bed);
    setup.time_step = d.time_step;
    dem::Simulation s(std::move(setup));
    const auto apart = [&] { return dem::length(scene::position_of(s, 1) - scene::position_of(s, 0)) - size; };
    while (apart() > 0.0) s.step();
    for (int step = 0; step < 100000 && apart() < 2.0 * gap; ++step) s.step();
    mean += (scene::motion_of(s, 1).velocity.x - scene::motion_of(s, 0).velocity.x) / speed / phases;
  }
  return mean;
}

}  // namespace

TEST_CASE("the restitution of a damping ratio is the inverse of the damping ratio of a restitution") {
  for (const double e : {0.01, 0.3, 0.7, 0.99}) CHECK(dem::restitution_of(dem::damping_ratio(e)) == Approx(e));
  CHECK(dem::restitution_of(0.0) == 1.0);
}

TEST_CASE("with restitution_at spheres that attract part with the wanted restitution at that speed") {
  dem::Case c;
  c.contact.restitution = 0.6;
  double without = 0.0;
  SECTION("linear with van der Waals") {
    c.contact.hamaker = 9e-18;
    c.run.steps_per_contact = 100.0;
    without = simulated_restitution(c, 0.08);
  }
  SECTION("Hertz with DMT") {
    c.contact.normal = dem::NormalLaw::hertz;
    c.contact.cohesion = dem::Cohesion::dmt;
    c.contact.work_of_adhesion = 0.05;
    without = simulated_restitution(c, 0.08);
  }
  SECTION("the dashpot's tension clamped, without attraction") {
    c.contact.tension = dem::DashpotTension::clamped;
    without = simulated_restitution(c, 0.08);
  }
  c.contact.restitution_at = 0.08;
  REQUIRE(dem::problems(c).empty());
  CHECK(std::abs(without - 0.6) > 0.02);
  CHECK(simulated_restitution(c, 0.08) == Approx(0.6).epsilon(0.005));
}

TEST_CASE("where spheres stick whatever the damping, restitution_at says so with the speed and the pair") {
  dem::Case c;
  c.contact.normal = dem::NormalLaw::jkr;
  c.contact.young_modulus = 2e6;
  c.contact.work_of_adhesion = 0.05;
  c.contact.restitution_at = 1e-3;
  const std::vector<data::Problem> found = dem::problems(c);
  REQUIRE_FALSE(found.empty());
  CHECK(found[0].place == "contact.restitution_at");
  CHECK_THAT(found[0].what, Catch::Contains("stick") && Catch::Contains("grain"));
  c.contact.restitution_at = 1.0;
  CHECK(dem::problems(c).empty());
}

TEST_CASE("the time step follows the dashpot that a low restitution with clamped tension needs") {
  dem::Case c;
  c.contact.tension = dem::DashpotTension::clamped;
  c.contact.restitution = 0.05;
  c.contact.restitution_at = 0.1;
  const dem::Derived d = dem::derive(c);
  const dem::ContactKind& k = d.kinds[0];
  CHECK(k.law.damping_ratio > dem::damping_ratio(0.05));
  // 2 zeta w0 dt: the share of the velocity that the dashpot takes in a step.
  CHECK(2.0 * k.law.damping_ratio * std::sqrt(k.law.stiffness / k.mass) * d.time_step < 0.2);
  CHECK(simulated_restitution(c, 0.1) == Approx(0.05).margin(0.01));
}

TEST_CASE("the damping sought is found to within CVODE's tolerance, over restitutions, speeds and laws") {
  dem::Case c;
  for (const auto normal : {dem::NormalLaw::linear, dem::NormalLaw::hertz}) {
    c.contact.normal = normal;
    c.contact.cohesion = normal == dem::NormalLaw::linear ? dem::Cohesion::van_der_waals : dem::Cohesion::dmt;
    c.contact.hamaker = normal == dem::NormalLaw::linear ? 4e-18 : 0.0;
    c.contact.work_of_adhesion = normal == dem::NormalLaw::linear ? 0.0 : 0.02;
    for (const double e : {0.1, 0.5, 0.9}) {
      for (const double speed : {0.08, 0.4}) {
        c.contact.restitution = e;
        c.contact.restitution_at = speed;
        for (const dem::ContactKind& kind : dem::derive(c).kinds) {
          CAPTURE(e, speed, kind.second);
          REQUIRE(kind.found);
          if (!kind.found->damping_ratio) continue;  // the attraction alone takes more
          CHECK(std::abs(kind.found->collision.restitution - e) < 2e-8);
        }
      }
    }
  }
}
