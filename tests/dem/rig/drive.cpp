// The sign of a mesh's torque: that of what its drive supplies, by how far the mesh turns over the measured window.
#include "dem/rig/drive.hpp"

#include <catch2/catch.hpp>

#include "dem/case/stl_rig.hpp"

TEST_CASE("a programme that ends at rest keeps the sign of its turning, and one that ends backwards is not fooled") {
  dem::RunControl run;
  run.start_up = 0.1;
  run.start_up_turns = 0.25;
  run.longest = 1.0;
  dem::Motion m;
  const auto sign = [&](std::vector<dem::SpeedPoint> programme) {
    m.programme = std::move(programme);
    return dem::drive_sign(m, run);
  };
  CHECK(sign({{0.0, 10.0}}) == -1.0);
  CHECK(sign({{0.0, -10.0}}) == 1.0);
  CHECK(sign({{0.0, 10.0}, {0.6, 10.0}, {0.7, 0.0}}) == -1.0);
  CHECK(sign({{0.0, -10.0}, {0.6, -10.0}, {0.7, 0.0}}) == 1.0);
  CHECK(sign({{0.0, 10.0}, {0.9, 10.0}, {0.95, -1.0}}) == -1.0);
  CHECK(sign({{0.0, 10.0}, {2.0, 10.0}, {3.0, -10.0}}) == -1.0);  // what comes after the run does not count
  CHECK(sign({{0.1, 10.0}, {1.0, -10.0}}) == 1.0);                // as far back as forward: the moment itself
  CHECK(sign({}) == 1.0);
}

TEST_CASE("a turn is that of the measured mesh, and where it rests of the one that turns the slowest") {
  dem::StlRig rig;
  rig.meshes.resize(4);
  rig.meshes[1].motion.oscillations = {{.frequency = 0.1}};
  rig.meshes[2].speed_ratio = -4.0;
  rig.meshes[3].motion.programme = {{0.0, 8.0 * M_PI}};
  dem::Case c;
  c.rig.angular_velocity = M_PI;
  const auto turn = [&](std::size_t measured) {
    rig.measured = {measured};
    c.rig.stl = std::make_shared<const dem::StlRig>(rig);
    return dem::turn_of(c);
  };
  CHECK(turn(2) == Approx(0.5));
  CHECK(turn(3) == Approx(0.25));
  CHECK(turn(1) == Approx(10.0));
  CHECK(turn(0) == Approx(0.5));
  rig.meshes[2].speed_ratio = -1.0;
  CHECK(turn(0) == Approx(2.0));
  rig.meshes[2].speed_ratio = 0.0;
  CHECK(turn(0) == Approx(0.25));
  rig.meshes[3].motion.programme.clear();
  CHECK(turn(0) == Approx(10.0));
  rig.meshes[1].motion.oscillations.clear();
  CHECK(turn(0) == 0.0);
}
