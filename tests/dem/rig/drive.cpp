// The sign of a mesh's torque: that of what its drive supplies, by how far the mesh turns over the measured window.
#include "dem/rig/drive.hpp"

#include <catch2/catch.hpp>

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
