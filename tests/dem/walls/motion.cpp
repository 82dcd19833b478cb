// Rigid motions: closed forms against differences and quadrature, and a sphere carried by a moving floor.
#include <catch2/catch.hpp>

#include <numbers>

#include "tests/dem/scene.hpp"

namespace {

using std::numbers::pi;

/// Everything at once: a speed programme, an orbit, and a swing about another axis.
dem::Motion busy() {
  dem::Motion m;
  m.point = {0.1, -0.2, 0.3};
  m.axis = dem::unit({1.0, 2.0, -0.5});
  m.programme = {{0.1, 0.0}, {0.3, 5.0}, {0.4, -2.0}};
  m.oscillations = {{dem::OscillationKind::along, {1.0, 0.0, 0.0}, 0.01, 7.0, 0.3},
                    {dem::OscillationKind::about, dem::unit({0.0, 1.0, 1.0}), 0.4, 3.0, 1.0}};
  return m;
}

dem::Vec3 place(const dem::Motion& m, double time, dem::Vec3 x) {
  const dem::Pose p = dem::pose(m, time);
  return p.point + dem::rotate(p.rotation, x - m.point);
}

}  // namespace

TEST_CASE("a pose's velocity and spin are the time derivative of where it takes a point") {
  const dem::Motion m = busy();
  const dem::Vec3 x{0.4, 0.1, -0.2};
  const double h = 1e-6;
  for (const double t : {0.05, 0.15, 0.2, 0.35, 0.7, 3.0}) {
    const dem::Vec3 difference = (0.5 / h) * (place(m, t + h, x) - place(m, t - h, x));
    const dem::Pose p = dem::pose(m, t);
    const dem::Vec3 velocity = p.velocity + dem::cross(p.spin, place(m, t, x) - p.point);
    CHECK(dem::length(velocity - difference) < 1e-7);
  }
}

TEST_CASE("the angle of a speed programme is the integral of its speed") {
  const dem::Motion m = busy();
  double sum = 0.0;
  const double dt = 1e-5;
  for (int k = 0; k < 100000; ++k) sum += dt * dem::programme_speed(m, (k + 0.5) * dt);
  CHECK(dem::programme_angle(m, 1.0) == Approx(sum).epsilon(1e-6));
  CHECK(dem::programme_angle(m, 1.0) == Approx(0.5 * 0.2 * 5.0 + 0.5 * 0.1 * 3.0 - 0.6 * 2.0));
}

TEST_CASE("a motion keeps distances, rests before its start, and goes no farther than it says") {
  const dem::Motion m = busy();
  const dem::Vec3 a{0.4, 0.1, -0.2}, b{-0.1, 0.7, 0.2};
  const dem::Reach reach{dem::length(dem::cross(m.axis, a - m.point)), dem::length(a - m.point)};
  for (double t = 0.0; t < 1.0; t += 0.013) {
    CHECK(dem::length(place(m, t, a) - place(m, t, b)) == Approx(dem::length(a - b)).epsilon(1e-12));
    const double way = dem::length(place(m, t + 0.01, a) - place(m, t, a));
    CHECK(way <= dem::travelled(m, t, t + 0.01, reach) * (1.0 + 1e-12));
  }
  const dem::Pose before = dem::pose(m, -1.0), start = dem::pose(m, 0.0);
  CHECK(dem::length(before.point - start.point) == 0.0);
  CHECK(dem::length(before.velocity) + dem::length(before.spin) == 0.0);
}

TEST_CASE("a sphere on a floor that oscillates upwards is carried, and leaves it when the floor falls faster than it") {
  dem::Case c;
  c.contact.stiffness = 2000.0;
  const dem::Derived d = dem::derive(c);
  const double radius = 0.5 * c.material.diameter, frequency = 30.0;
  for (const double gamma : {0.8, 1.3}) {  // peak acceleration / gravity
    const double amplitude = gamma * 9.81 / std::pow(2.0 * pi * frequency, 2);
    dem::Setup setup = scene::box(c, {{0.0, 0.0, radius - d.weight / c.contact.stiffness}}, {});
    setup.bodies.push_back(scene::floor(5e-3));
    setup.bodies[0].motion.oscillations = {
        {dem::OscillationKind::along, {0.0, 0.0, 1.0}, amplitude, frequency, -0.5 * pi}};  // starts at the bottom
    setup.spheres.position[0].z -= amplitude;
    setup.gravity = {0.0, 0.0, -9.81};
    dem::Simulation s(std::move(setup));
    int airborne = 0, steps = 0;
    double highest = -1.0;
    while (s.time() < 1.0 / frequency) {
      s.step();
      ++steps;
      airborne += s.sums().wall_contacts == 0;
      highest = std::max(highest, s.state().position[0].at.z - radius);
    }
    INFO("peak acceleration " << gamma << " g, in the air " << airborne << " of " << steps << " steps");
    if (gamma < 1.0) {
      CHECK(airborne == 0);
      CHECK(highest == Approx(amplitude).epsilon(1e-3));
    } else {
      CHECK(airborne > steps / 20);
      CHECK(highest > 1.01 * amplitude);
    }
  }
}

TEST_CASE("a floor that slides to and fro under a resting sphere drags it with the friction's limit") {
  dem::Case c;
  c.contact.friction = 0.2;
  const dem::Derived d = dem::derive(c);
  dem::Setup setup = scene::box(c, {{0.0, 0.0, 0.5 * c.material.diameter - d.weight / c.contact.stiffness}}, {});
  setup.bodies.push_back(scene::floor(20e-3));
  setup.bodies[0].motion.oscillations = {{dem::OscillationKind::along, {1.0, 0.0, 0.0}, 5e-3, 20.0, 0.0}};
  setup.gravity = {0.0, 0.0, -9.81};
  dem::Simulation s(std::move(setup));
  while (s.time() < 5e-3) s.step();  // the floor's speed is 0.63 m/s at first: the sphere slides all the while
  CHECK(s.motion(0).velocity.x == Approx(0.2 * 9.81 * 5e-3).epsilon(0.01));
  CHECK(s.motion(0).spin.y == Approx(-2.5 * 0.2 * 9.81 * 5e-3 / (0.5 * c.material.diameter)).epsilon(0.01));
}
