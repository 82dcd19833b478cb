// A sphere on a plane: sliding into rolling, rolling and sliding on an incline, and a path that does not know the
// triangles.
#include <catch2/catch.hpp>
#include <numbers>

#include "tests/dem/shot.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// One sphere resting on z = 0 with a stiff, frictional floor.
dem::Setup resting(const dem::Case& c, dem::Vec3 velocity, int nx, int ny) {
  const dem::Derived d = dem::derive(c);
  const double sink = d.weight / c.contact.stiffness;
  dem::Setup s = scene::box(c, {{0.0, 0.0, 0.5 * c.material.diameter - sink}}, {velocity});
  s.bodies.push_back(scene::floor(20.0 * c.material.diameter, nx, ny));
  s.gravity = {0.0, 0.0, -c.run.gravity};
  return s;
}

dem::Case ball() {
  dem::Case c;
  c.material.diameter = 1e-3;
  c.material.density = 2500.0;
  c.contact.stiffness = 1000.0;
  c.contact.friction = 0.4;
  return c;
}

}  // namespace

TEST_CASE("a sliding sphere rolls after 2 v / (7 mu g), at 5/7 of its speed: 7.281 ms and 0.624 mm", "[table]") {
  // Closed form; MFIX's validation of the same case reaches 0.57 % in time and 0.017 % in speed.
  dem::Simulation s(resting(ball(), {0.1, 0.0, 0.0}, 1, 1));
  const double radius = 0.5e-3;
  double rolls_at = 0.0, distance = 0.0;
  while (s.time() < 0.02) {
    s.step();
    const dem::MotionRow m = s.motion(0);
    const double slip = m.velocity.x - radius * m.spin.y;
    if (rolls_at == 0.0 && slip < 1e-3 * 0.1) {
      rolls_at = s.time();
      distance = s.state().position[0].at.x;
    }
  }
  INFO("rolls after " << rolls_at << " s and " << distance << " m, at " << s.motion(0).velocity.x << " m/s");
  scene::row("slip to roll: time [ms]", 7.281, 1e3 * rolls_at, {0.0057});
  scene::row("slip to roll: distance [mm]", 0.624, 1e3 * distance, {0.01});
  scene::row("slip to roll: final speed [m/s]", 0.1 * 5.0 / 7.0, s.motion(0).velocity.x, {0.001});
}

TEST_CASE("on an incline a sphere rolls at 5/7 g sin up to tan = 3.5 mu, and slides at g (sin - mu cos) beyond",
          "[table]") {
  for (const double angle : {0.3, 0.9, 1.1}) {
    dem::Case c = ball();
    dem::Setup setup = resting(c, {}, 1, 1);
    const double g = 9.81, mu = 0.4;
    setup.gravity = {g * std::sin(angle), 0.0, -g * std::cos(angle)};
    dem::Simulation s(std::move(setup));
    while (s.time() < 5e-3) s.step();  // the contact settles
    const dem::MotionRow before = s.motion(0);
    const double t = s.time();
    while (s.time() < 30e-3) s.step();
    const double a = (s.motion(0).velocity.x - before.velocity.x) / (s.time() - t);
    const double alpha = (s.motion(0).spin.y - before.spin.y) / (s.time() - t);
    const bool rolls = std::tan(angle) <= 3.5 * mu;
    INFO("angle " << angle << " acceleration " << a << " angular " << alpha);
    scene::row(fmt::format("incline of {} rad: acceleration [m/s2]", angle),
               rolls ? 5.0 / 7.0 * g * std::sin(angle) : g * (std::sin(angle) - mu * std::cos(angle)), a, {0.002});
    scene::row(fmt::format("incline of {} rad: angular acceleration [rad/s2]", angle),
               rolls ? a / 0.5e-3 : 5.0 * mu * g * std::cos(angle) / (2.0 * 0.5e-3), alpha, {0.002});
  }
}

TEST_CASE("a sphere rolls over 2, 200 and 20,000 triangles on the same path, to 1e-9 of a radius") {
  std::vector<dem::Vec3> ends;
  for (const int n : {1, 10, 100}) {
    dem::Setup setup = resting(ball(), {0.07, 0.043, 0.0}, n, n);
    setup.spheres.position[0].x = -1.03e-3;
    dem::Simulation s(std::move(setup));
    while (s.time() < 0.05) s.step();
    CHECK(s.sums().wall_contacts == 1);
    ends.push_back(s.state().position[0].at);
  }
  for (const dem::Vec3 end : ends) {
    INFO("ends at " << end.x << ", " << end.y << ", " << end.z);
    CHECK(dem::length(end - ends[0]) < 1e-9 * 0.5e-3);
  }
}

TEST_CASE("a sphere slips on a plane at its speed less that of its rolling, and so on a plane that moves") {
  dem::Case c = ball();
  c.contact.friction = 0.0;
  const double r = 0.5 * c.material.diameter, speed = 0.07, dive = 0.05;
  const auto slip = [&](dem::Vec3 velocity, double spin, bool moves) {
    dem::Setup setup = resting(c, velocity, 1, 1);
    setup.spheres.spin = {{0.0, spin, 0.0}};
    if (moves)  // along x, at 0.03 m/s when it begins
      setup.bodies.at(0).motion.oscillations = {
          {dem::OscillationKind::along, {1.0, 0.0, 0.0}, 0.03 / (2.0 * std::numbers::pi * 5.0), 5.0, 0.0}};
    dem::Simulation s(std::move(setup));
    s.step();  // bodies rest until time 0 is over
    REQUIRE(s.sums().body[0].contacts == 1);
    return s.sums().body[0].slip;
  };
  // The overlap of a sphere at rest is less than 1e-3 of its radius, by which its lever is shorter.
  CHECK_THAT(slip({speed, 0.0, 0.0}, 0.0, false), WithinRel(speed, 1e-12));
  CHECK_THAT(slip({speed, 0.0, -dive}, 0.0, false), WithinRel(speed, 1e-12));
  CHECK_THAT(slip({speed, 0.0, 0.0}, speed / r, false), WithinAbs(0.0, 1e-3 * speed));
  CHECK_THAT(slip({speed, 0.0, 0.0}, -speed / r, false), WithinRel(2.0 * speed, 1e-3));
  CHECK_THAT(slip({speed, 0.0, 0.0}, 0.0, true), WithinRel(speed - 0.03, 1e-6));
}

TEST_CASE("an edge or a vertex of a box pushes a sphere like a point, once, and with the same force from either side") {
  // A cube of half length 5 radii; the sphere touches a face, an edge or a corner with the same overlap.
  const dem::Case c = ball();
  const double r = 0.5 * c.material.diameter, half = 5.0 * r;
  dem::TriangleMesh cube;
  for (int k = 0; k < 8; ++k)
    cube.vertices.push_back({k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? half : -half});
  cube.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const double away = 0.98 * r, overlap = 0.02 * r;
  const std::vector<dem::Vec3> directions{
      {0.0, 0.0, 1.0}, {0.0, 1.0, 1.0}, {1.0, 1.0, 1.0}, {0.0, -1.0, 1.0}, {0.0, 0.3, 1.0}};
  const std::vector<dem::Vec3> feet{
      {0.1 * r, 0.1 * r, half}, {0.7 * r, half, half}, {half, half, half}, {0.0, -half, half}, {0.2 * r, half, half}};
  for (std::size_t k = 0; k < feet.size(); ++k) {
    const dem::Vec3 n = dem::unit(directions[k]);
    dem::Setup setup = scene::box(c, {feet[k] + away * n}, {});
    setup.bodies.push_back({"cube", cube, {}});
    const dem::Simulation s(std::move(setup));
    CHECK(s.sums().wall_contacts == 1);
    const dem::Vec3 miss = s.state().load[0].force - c.contact.stiffness * overlap * n;
    CHECK(dem::length(miss) < 1e-9 * c.contact.stiffness * overlap);
  }
}

TEST_CASE(
    "a sphere spinning in place on a frictionless plane loses 5 mu_r g t / (2 r), and one that rolls 5 mu_r g t / (7 "
    "r)",
    "[table]") {
  // LAMMPS unit tests of granular rolling (w0 - 5 mu_r g t / (2 r)); rolling without slip: derived.
  const double r = 0.5e-3, mu_r = 0.05, g = 9.81, w0 = 100.0, t = 10e-3;
  for (const auto law : {dem::ResistanceLaw::constant, dem::ResistanceLaw::spring}) {
    for (const bool rolls : {false, true}) {
      dem::Case c = ball();
      c.contact.resistance = law;
      c.contact.rolling_friction = mu_r;
      c.contact.friction = rolls ? 0.4 : 0.0;
      dem::Setup setup = resting(c, {rolls ? w0 * r : 0.0, 0.0, 0.0}, 1, 1);
      setup.spheres.spin = {{0.0, w0, 0.0}};
      dem::Simulation s(std::move(setup));
      while (s.time() < t) s.step();
      const char* kind = law == dem::ResistanceLaw::constant ? "constant torque" : "spring-dashpot";
      // The spring takes mu_r m g / kr of rolling before it gives: a share of that torque is missing at the start.
      scene::row(fmt::format("spin lost, {}, {} [rad/s]", rolls ? "rolling" : "in place", kind),
                 (rolls ? 5.0 / 7.0 : 2.5) * mu_r * g * t / r, w0 - s.motion(0).spin.y,
                 {law == dem::ResistanceLaw::constant ? 0.005 : 0.01});
    }
  }
}

TEST_CASE("a sphere spinning about the normal of a plane is braked by 5 mu_t g / (2 r), and stops", "[table]") {
  const double r = 0.5e-3, mu_t = 0.05, g = 9.81, w0 = 50.0;
  for (const auto law : {dem::ResistanceLaw::constant, dem::ResistanceLaw::spring}) {
    dem::Case c = ball();
    c.contact.resistance = law;
    c.contact.twisting_friction = mu_t;
    dem::Setup setup = resting(c, {}, 1, 1);
    setup.spheres.spin = {{0.0, 0.0, w0}};
    dem::Simulation s(std::move(setup));
    while (s.time() < 10e-3) s.step();
    const char* kind = law == dem::ResistanceLaw::constant ? "constant torque" : "spring-dashpot";
    scene::row(fmt::format("twisting spin lost, {} [rad/s]", kind), 2.5 * mu_t * g * 10e-3 / r, w0 - s.motion(0).spin.z,
               {law == dem::ResistanceLaw::constant ? 0.005 : 0.01});
    while (s.time() < 60e-3) s.step();
    CHECK(std::abs(s.motion(0).spin.z) < 0.02 * w0);
  }
}
