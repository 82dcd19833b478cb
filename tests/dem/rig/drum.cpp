// The drum: how it is filled, what its torque is, and that its runs have the same bits. The torque is held against
// the weight's moment about the axis, which the walls must hold in steady flow; the fill against the centroid of a half
// disc.
#include <catch2/catch.hpp>
#include <cmath>

#include "dem/case/grains.hpp"
#include "dem/forecast/forecast.hpp"
#include "dem/reading/prepare.hpp"
#include "dem/reading/target.hpp"
#include "dem/rig/drum.hpp"
#include "dem/run/run.hpp"
#include "tests/dem/same_bits.hpp"
#include "tests/dem/scene.hpp"
#include "tests/dem/small_rigs.hpp"

using Catch::Contains;
using scene::small_drum;
using scene::Turning;

namespace {

dem::Case short_run(dem::Case c) {
  c.run.settle = 0.02;
  c.run.start_up = 0.02;
  c.run.start_up_turns = 0.0;
  c.run.shortest = 0.03;
  c.run.shortest_turns = 0.0;
  c.run.longest = 0.05;
  c.run.window = 3e-3;
  return c;
}

/// Means over some time of turning, after a start-up.
struct Balance {
  double shell = 0.0, plates = 0.0;  ///< N m, that the drive supplies or the rest holds
  double weight = 0.0;               ///< N m, of the powder about the axis
};
Balance balance(const dem::Case& c, double start_up, double measured) {
  Turning turning(c, 2, start_up);
  dem::Simulation& s = turning.simulation;
  const dem::Sensor& sensor = turning.sensor;
  Balance mean;
  const auto steps = static_cast<int>(measured / turning.time_step);
  for (int k = 0; k < steps; ++k) {
    s.step();
    mean.shell += dot(sensor.driven[0].torque_axis, s.sums().body[dem::shell].torque) / steps;
    if (c.rig.drum->end_plates != dem::EndPlates::none)
      mean.plates += dot(sensor.driven[0].torque_axis, s.sums().body[dem::plates].torque) / steps;
    mean.weight += c.run.gravity * dot(sensor.picture.right, s.carried().moment) / steps;
  }
  return mean;
}

}  // namespace

TEST_CASE("a half-full drum of log-normal sizes starts with as many spheres as asked for, none touching anything") {
  dem::Case c;
  c.rig.drum = dem::Drum{.radius = 20e-3, .length = 8e-3};
  c.rig.level = 0.5;
  c.material.diameter = 1.2e-3;
  c.material.log_normal = dem::LogNormalSizes{.geometric_sd = 1.25, .low = 0.7e-3, .high = 2.0e-3};
  REQUIRE(dem::problems(c).empty());
  for (const dem::EndPlates ends : {dem::EndPlates::turning, dem::EndPlates::none}) {
    c.rig.drum->end_plates = ends;
    c.rig.drum->length = ends == dem::EndPlates::none ? 12e-3 : 8e-3;
    const dem::Simulation s(scene::rig(c, 3));
    CHECK(s.state().particles() == dem::summarise_bed(c).spheres);
    CHECK(s.sums().contacts == 0);
    CHECK(s.sums().wall_contacts == 0);
    for (std::size_t i = 0; i < s.state().particles(); ++i)
      REQUIRE(std::hypot(s.state().position[i].at.x, s.state().position[i].at.z) < 20e-3);
  }
  // Spheres of that lattice alone would not have fitted.
  const double solids = dem::summarise_bed(c).volume, drum = c.rig.drum->volume();
  CHECK(solids / drum == Approx(0.3).epsilon(0.01));
}

TEST_CASE("the filling is by the seed alone, and any level up to the fullest starts") {
  dem::Case c = small_drum();
  for (const double level : {0.05, 0.5, dem::fullest_drum - 0.01}) {
    c.rig.level = level;
    const dem::BuiltRig one = dem::build_rig(c, 3), again = dem::build_rig(c, 3), other = dem::build_rig(c, 4);
    REQUIRE(one.position.size() == dem::summarise_bed(c).spheres);
    CHECK(one.position[7].x == again.position[7].x);
    CHECK(one.position[7].x != other.position[7].x);
  }
}

TEST_CASE("a half-full drum at rest settles to the centroid of a half disc", "[slow]") {
  dem::Case c = small_drum();
  c.rig.drum->end_plates = dem::EndPlates::none;
  c.rig.level = 0.5;
  c.material.sizes = scene::thirds(0.66e-3, 0.72e-3, 0.78e-3);
  c.contact.friction = 0.1;  // so that they pack well: the solid fraction is then 0.6 within a few hundredths
  dem::Simulation s(scene::rig(c, 1, scene::at_rest));
  while (s.time() < 0.15) s.step();
  double mass = 0.0;
  for (std::size_t i = 0; i < s.state().particles(); ++i) mass += s.state().motion[i].mass;
  const double depth = -s.carried().moment.z / mass;
  CHECK(depth == Approx(4.0 * 10e-3 / (3.0 * M_PI)).epsilon(0.08));
}

TEST_CASE("in steady flow the drum's torque is the weight times the centre's distance from the axis", "[slow]") {
  dem::Case c = scene::steady(small_drum(), 2.5);
  c.rig.angular_velocity *= GENERATE(1.0, -1.0);
  const dem::RunResult result = dem::run(c, 1);
  INFO(result.reason);
  REQUIRE(result.status == dem::RunStatus::done);
  const data::SeriesMean torque = dem::output(result, "torque"), x = dem::output(result, "centre_x");
  const double weight = dem::summarise_bed(c).mass * c.run.gravity;
  INFO("torque " << 1e6 * torque.mean << " +- " << 1e6 * torque.standard_error << " uN m, weight * centre_x "
                 << 1e6 * weight * x.mean << " +- " << 1e6 * weight * x.standard_error);
  CHECK(torque.mean > 0.0);
  CHECK(std::abs(torque.mean - weight * x.mean) < 3.0 * std::hypot(torque.standard_error, weight * x.standard_error));
  CHECK(weight * x.mean == Approx(torque.mean).epsilon(0.03));
  CHECK(dem::output(result, "centre_z").mean < 0.0);
}

TEST_CASE("shell and end plates hold the weight together, and end plates that rest brake and load the shell",
          "[slow]") {
  const Balance turning = balance(small_drum(), 0.4, 0.8);
  CHECK(turning.shell + turning.plates == Approx(turning.weight).epsilon(0.03));
  CHECK(turning.plates > 0.0);
  const Balance resting = balance(small_drum(dem::EndPlates::resting), 0.4, 0.8);
  CHECK(resting.shell + resting.plates == Approx(resting.weight).epsilon(0.03));
  CHECK(resting.plates < 0.0);
  CHECK(resting.shell > resting.weight);
  const Balance open = balance(small_drum(dem::EndPlates::none), 0.4, 0.8);
  CHECK(open.shell == Approx(open.weight).epsilon(0.03));
}

TEST_CASE("the sensor sums what turns: the shell alone where the end plates rest or are missing") {
  const auto driven = [](const dem::Case& c) { return dem::build_rig(c, 1).sensor.driven; };
  CHECK(driven(small_drum()).size() == 2);
  CHECK(driven(small_drum())[1].body == dem::plates);
  CHECK(driven(small_drum(dem::EndPlates::resting)).size() == 1);
  CHECK(driven(small_drum(dem::EndPlates::resting))[0].body == dem::shell);
  const dem::BuiltRig open = dem::build_rig(small_drum(dem::EndPlates::none), 1);
  CHECK(open.bodies.size() == 1);
  CHECK(open.periodic[1]);
}

TEST_CASE("a drum has the same bits with 1, 2 and 4 threads") {
  dem::Case c = small_drum();
  c.rig.drum->length = 24e-3;  // several chunks
  scene::check_threads_agree(c, 1200);
}

TEST_CASE("a drum's run stopped and gone on from its checkpoint ends with the same bits") {
  const auto [whole, resumed] = scene::check_resumed_agrees(short_run(small_drum()), 5);
  CHECK(resumed.series.centre_x == whole.series.centre_x);
  CHECK(resumed.series.centre_z == whole.series.centre_z);
  REQUIRE(whole.series.window_time.size() >= 10);
  CHECK(resumed.series.window_time == whole.series.window_time);
  CHECK(resumed.series.silhouette_x == whole.series.silhouette_x);
  CHECK(resumed.series.silhouette_area == whole.series.silhouette_area);
}

TEST_CASE("number, mass and level say the same fill, and the last one said counts") {
  dem::Case c = small_drum();
  const auto spheres = static_cast<double>(dem::summarise_bed(c).spheres);
  for (const char* name : {"rig.fill", "rig.fill_mass", "rig.level"}) {
    dem::set_target(c, name, dem::get_target(c, name));
    INFO(name);
    CHECK(static_cast<double>(dem::summarise_bed(c).spheres) == Approx(spheres).margin(1.0));
  }
  dem::set_target(c, "rig.fill", 100.0);
  CHECK(dem::summarise_bed(c).spheres == 100);
  dem::set_target(c, "level", 0.2);
  CHECK(static_cast<double>(dem::summarise_bed(c).spheres) == Approx(0.5 * spheres).margin(1.0));
}

TEST_CASE("a slice's settings say nothing of drums, and a drum's nothing of slices") {
  const std::string slice = dem::settings_text({}), drum = dem::settings_text(small_drum());
  for (const char* word : {"drum", "level", "end_plates", "centre"}) CHECK_THAT(slice, !Contains(word));
  for (const char* word : {"rig.kind = drum", "rig.drum_radius", "rig.drum_length", "rig.level", "rig.end_plates"})
    CHECK_THAT(drum, Contains(word));
  CHECK_THAT(drum, !Contains("trough") && !Contains("pitch"));
  CHECK(dem::settings_text(small_drum(dem::EndPlates::resting)) != drum);
}

TEST_CASE("a drum too full, at rest, too short to repeat or too fast to flow is said before it is run") {
  dem::Case c = small_drum();
  CHECK(dem::problems(c).empty());
  const dem::Forecast f = dem::forecast(dem::prepare(c), 1);
  CHECK(f.problems.empty());
  CHECK(f.warnings.empty());
  CHECK(f.fill.value() == Approx(0.4).epsilon(0.01));
  // The height below which 0.4 of a unit disc lies: (acos(-z) + z sqrt(1 - z^2)) / pi = 0.4 at z = -0.1576.
  CHECK(f.surface.value() == Approx(-0.1576 * 10e-3).epsilon(0.02));
  dem::Case full = c;
  dem::set_target(full, "rig.fill", 2.5 * dem::get_target(c, "rig.fill"));
  CHECK_THAT(data::describe(dem::problems(full)), Contains("rig.fill") && Contains("of the drum's volume"));
  dem::Case rests = c;
  rests.rig.angular_velocity = 0.0;
  CHECK_THAT(data::describe(dem::problems(rests)), Contains("a drum at rest has no torque"));
  dem::Case slip = small_drum(dem::EndPlates::none);
  slip.rig.drum->length = 5e-3;
  CHECK_THAT(data::describe(dem::problems(slip)),
             Contains("rig.drum_length") && Contains("four of the largest sphere"));
  dem::Case fast = c;
  fast.rig.angular_velocity = 40.0;
  REQUIRE(!dem::forecast(dem::prepare(fast), 1).warnings.empty());
  CHECK_THAT(dem::forecast(dem::prepare(fast), 1).warnings.back(), Contains("Froude number is 1.63"));
}
