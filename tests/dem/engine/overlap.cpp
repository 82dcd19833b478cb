// A contact deeper than the laws are meant for ends the run; shallower ones are counted.
#include <catch2/catch.hpp>

#include "dem/run/run.hpp"
#include "tests/dem/scene.hpp"

namespace {

/// Spheres wider than the gap between blade and trough.
dem::Case pinched() {
  dem::Case c;
  c.rig.fill = 350.0;
  c.material.diameter = 1.5e-3;
  c.contact.stiffness = 200.0;
  c.rig.angular_velocity = 60.0;
  c.run.settle = 0.02;
  c.run.start_up = 0.01;
  c.run.start_up_turns = 0.25;
  c.run.shortest = c.run.longest = 0.05;
  c.run.window = 5e-3;
  return c;
}

void until(dem::Simulation& s, double time) {
  while (s.time() < time) s.step();
}

}  // namespace

TEST_CASE("two spheres, or a sphere and a wall, pressed beyond the limit end the run with who, where, when and why") {
  dem::Case c;
  c.contact.stiffness = 1.0;
  const double size = c.material.diameter;
  const bool on_wall = GENERATE(false, true);
  dem::Setup setup = on_wall ? scene::box(c, {{0.0, 0.0, 0.51 * size}}, {{0.0, 0.0, -0.2}})
                             : scene::box(c, {{0.0, 0.0, 0.0}, {1.01 * size, 0.0, 0.0}}, {{0.2, 0.0, 0.0}, {}});
  if (on_wall) setup.bodies.push_back(scene::floor(10.0 * size));
  setup.overlap_limit = 0.1;
  dem::Simulation s(setup);
  CHECK_THROWS_WITH(until(s, 0.01), Catch::Contains(on_wall ? "sphere 0 and floor" : "spheres 0 and 1") &&
                                        Catch::Contains("of a radius at (") && Catch::Contains("approaching at 0.") &&
                                        Catch::Contains("run.overlap_limit") && Catch::Contains("contact.stiffness"));
  setup.overlap_limit = 1.0;
  dem::Simulation deeper(setup);
  CHECK_NOTHROW(until(deeper, 0.01));
}

TEST_CASE("a run that fails by an overlap keeps a good state from before, and what was measured until then") {
  const dem::RunResult result = dem::run(pinched(), 1);
  REQUIRE(result.status == dem::RunStatus::failed);
  CHECK_THAT(result.reason, Catch::Contains("run.overlap_limit"));
  CHECK(result.checkpoint.state.particles() == 350);
  CHECK(result.checkpoint.state.step < result.diagnostics.steps);
  CHECK(result.checkpoint.series.time.size() == result.series.time.size());
}

TEST_CASE("overlaps beyond half the limit are counted in a warning that says what to raise") {
  dem::Case c = pinched();
  c.run.overlap_limit = 0.9;
  const dem::RunResult result = dem::run(c, 1);
  REQUIRE(result.status == dem::RunStatus::done);
  REQUIRE(result.diagnostics.max_overlap > 0.1);
  c.run.overlap_limit = 1.5 * result.diagnostics.max_overlap;
  const dem::RunResult warned = dem::run(c, 1);
  CHECK(warned.series.torque == result.series.torque);  // the limit does not change a run
  REQUIRE(!warned.warnings.empty());
  CHECK_THAT(warned.warnings.back(),
             Catch::Contains("half of run.overlap_limit") && Catch::Contains("contact.stiffness"));
  CHECK(warned.diagnostics.deep_contacts > 0);
}
