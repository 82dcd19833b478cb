// What a kind of rig says of its bodies before it builds them.
#include "dem/rig/rig.hpp"

#include <catch2/catch.hpp>

#include "dem/rig/drive.hpp"
#include "tests/dem/small_rigs.hpp"

namespace {

dem::Case small_slice() {
  dem::Case c;
  c.rig.fill = 200.0;
  return c;
}

dem::Case small_machine() {
  dem::Case c;
  c.rig.machine = dem::Machine{.length = 36e-3, .opening = 9e-3};
  c.rig.fill = 200.0;
  return c;
}

}  // namespace

TEST_CASE("a rig builds the bodies that its kind lists, moves them so, and measures those that it names") {
  for (dem::Case c : {small_slice(), small_machine(), scene::small_drum(dem::EndPlates::turning),
                      scene::small_drum(dem::EndPlates::resting), scene::small_drum(dem::EndPlates::none)}) {
    INFO(dem::rig_kind(c));
    const std::vector<dem::RigBody> bodies = dem::rig_bodies(c);
    const dem::BuiltRig built = dem::build_rig(c, 1);
    REQUIRE(built.bodies.size() == bodies.size());
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      CHECK(built.bodies[k].name == bodies[k].label.name);
      CHECK(dem::programme_speed(built.bodies[k].motion, 1.0) == dem::programme_speed(bodies[k].motion, 1.0));
      CHECK(dem::length(built.bodies[k].motion.axis - bodies[k].motion.axis) == 0.0);
      CHECK(dem::length(built.bodies[k].motion.point - bodies[k].motion.point) == 0.0);
    }
    const std::vector<std::size_t> measured = dem::measured_bodies(c);
    REQUIRE(built.sensor.driven.size() == measured.size());
    for (std::size_t k = 0; k < measured.size(); ++k) CHECK(built.sensor.driven[k].body == measured[k]);
    CHECK(built.sensor.period == dem::turn_of(c));
    CHECK(dem::has_picture(c) == dem::shows_bed(built.sensor.picture, built.periodic));
  }
}

TEST_CASE("a body is driven where the rig's angular velocity is part of its motion") {
  for (dem::Case c : {small_slice(), small_machine(), scene::small_drum(dem::EndPlates::turning),
                      scene::small_drum(dem::EndPlates::resting)}) {
    INFO(dem::rig_kind(c));
    c.rig.angular_velocity = 3.0;
    const std::vector<dem::RigBody> slow = dem::rig_bodies(c);
    c.rig.angular_velocity = 6.0;
    const std::vector<dem::RigBody> fast = dem::rig_bodies(c);
    for (std::size_t k = 0; k < slow.size(); ++k)
      CHECK(slow[k].driven == (dem::programme_speed(slow[k].motion, 1.0) != dem::programme_speed(fast[k].motion, 1.0)));
    CHECK(dem::drives_a_body(c));
  }
}
