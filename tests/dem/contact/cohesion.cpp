// The attraction of Tanaka et al., PARTICLES 2011, eq. (1) and the coarse-grain rule eq. (2).
#include <catch2/catch.hpp>

#include "dem/contact/forces/compose.hpp"
#include "tests/dem/scene.hpp"

TEST_CASE("the Bond number at 2.0e-18 J on 0.8 mm zirconia is 52, 8.3 and 0.5 for h_min 0.4, 1 and 4 nm") {
  const double expected[][2] = {{0.4e-9, 52.0}, {1.0e-9, 8.3}, {4.0e-9, 0.52}};
  for (const auto& [separation, bond] : expected) {
    dem::Case c;
    c.contact.hamaker = 2.0e-18;
    c.contact.minimum_separation = separation;
    CHECK(dem::derive(c).bond == Approx(bond).epsilon(0.01));
    c.contact.hamaker = 9.0e-18;
    CHECK(dem::derive(c).bond == Approx(4.5 * bond).epsilon(0.01));
  }
}

TEST_CASE(
    "spheres a gap h apart attract each other with H L / (12 h^2), not beyond the cut-off, and no closer than h_min") {
  dem::Case c;
  c.contact.hamaker = 3e-18;
  const double size = c.material.diameter;
  const auto force = [&](double gap) {
    const dem::Simulation s(scene::box(c, {{0.0, 0.0, 0.0}, {size + gap, 0.0, 0.0}}, {}));
    return s.state().load[scene::row_of(s, 0)].force.x;
  };
  for (const auto scale : {dem::LengthScale::diameter, dem::LengthScale::radius}) {
    c.contact.length_scale = scale;
    const double l = scale == dem::LengthScale::diameter ? size : 0.5 * size;
    for (const double h : {3e-9, 10e-9, 90e-9}) CHECK(force(h) == Approx(3e-18 * l / (12.0 * h * h)).epsilon(1e-6));
    CHECK(force(0.5e-9) == Approx(dem::derive(c).pull_off));
    CHECK(force(101e-9) == 0.0);
  }
}

TEST_CASE("a wall attracts as a grain does by eq. (1), or twice that by Derjaguin, with its own constant") {
  dem::Case c;
  c.contact.hamaker = 3e-18;
  const double size = c.material.diameter;
  const auto force = [&] {
    dem::Setup setup = scene::box(c, {{0.0, 0.0, 0.5 * size + 10e-9}}, {});
    setup.bodies.push_back(scene::floor(5.0 * size));
    return -dem::Simulation(std::move(setup)).state().load[0].force.z;
  };
  const double as_grain = 3e-18 * size / (12.0 * 1e-16);
  CHECK(force() == Approx(as_grain).epsilon(1e-6));
  c.contact.wall_attraction = dem::WallAttraction::derjaguin;
  CHECK(force() == Approx(2.0 * as_grain).epsilon(1e-6));
  c.contact.wall_hamaker = 1e-18;
  CHECK(force() == Approx(2.0 / 3.0 * as_grain).epsilon(1e-6));
  c.contact.hamaker = 0.0;
  CHECK(force() == Approx(2.0 / 3.0 * as_grain).epsilon(1e-6));
}

TEST_CASE("H* = l^3 H: the simulation's constant is given, or follows from the original grain's") {
  dem::Case c;
  c.contact.hamaker = 2.0e-18;
  c.material.coarse_graining = 8.0;
  CHECK(dem::derive(c).hamaker == 2.0e-18);
  CHECK(dem::derive(c).original_hamaker == Approx(3.9e-21).epsilon(0.01));
  c.contact.hamaker_of = dem::HamakerOf::original;
  CHECK(dem::derive(c).hamaker == Approx(512.0 * 2.0e-18));
}

TEST_CASE("the power of l decides what enlarged grains keep: at 1 the pull-off force goes with their area") {
  // With L the diameter of the simulated sphere, the force is H* L / (24 h^2): l^(n + 1) times that of the original
  // grain.
  dem::Case original, enlarged;
  for (dem::Case* c : {&original, &enlarged}) {
    c->contact.hamaker = 4e-21;
    c->contact.hamaker_of = dem::HamakerOf::original;
  }
  original.material.diameter = 0.1e-3;
  enlarged.material.diameter = 0.8e-3;
  enlarged.material.coarse_graining = 8.0;
  for (const double power : {1.0, 2.0, 3.0}) {
    enlarged.contact.hamaker_power = power;
    CHECK(dem::derive(enlarged).pull_off / dem::derive(original).pull_off == Approx(std::pow(8.0, power + 1.0)));
    CHECK(dem::derive(enlarged).original_hamaker == Approx(4e-21));
  }
}

TEST_CASE("the adhesive load enters the Coulomb limit as the cap option says") {
  // A sphere pressed on a wall by repulsion N against attraction A slides under mu max(0, N + b A).
  const double n = 3e-3, a = 1e-3, mu = 0.5;
  const auto friction = [&](dem::FrictionCap cap) {
    dem::Case c;
    c.contact.cap = cap;
    c.contact.friction = mu;
    c.contact.hamaker = 1e-18;
    c.contact.hamaker *= a / dem::derive(c).pull_off;
    using Law = dem::ContactLaw<dem::LinearNormal, dem::LinearTangential, dem::NoResistance, dem::ShortRangeAttraction>;
    const dem::Derived d = dem::derive(c);
    const auto law = dem::make_law<Law>(dem::make_bed(c, 0).grain[0]).at(0.5 * d.mass, 0.25 * c.material.diameter);
    dem::History<double> stretched;
    stretched.slip.x = 1.0;  // N, far beyond any cap
    return -law({.normal = {0.0, 0.0, 1.0}, .overlap = n / c.contact.stiffness}, stretched, 1e-6).tangential.x;
  };
  CHECK(friction(dem::FrictionCap::net) == Approx(mu * (n - a)));
  CHECK(friction(dem::FrictionCap::repulsion) == Approx(mu * n));
  CHECK(friction(dem::FrictionCap::thornton) == Approx(mu * (n + a)));
}
