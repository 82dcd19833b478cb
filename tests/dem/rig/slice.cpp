// The auger slice as a whole: balances, bits, and what a run hands out.
#include <catch2/catch.hpp>

#include "data/error.hpp"
#include "data/random.hpp"
#include "dem/reading/prepare.hpp"
#include "dem/reading/target.hpp"
#include "dem/rig/slice.hpp"
#include "dem/run/run.hpp"
#include "tests/dem/same_bits.hpp"
#include "tests/dem/scene.hpp"

namespace {

/// A short box of large spheres: a few hundred, so that seconds are enough.
dem::Case small_case() {
  dem::Case c;
  c.rig.fill = 350.0;
  c.material.diameter = 1.5e-3;
  c.rig.trough_radius = 8e-3;  // a gap that they pass through
  c.contact.stiffness = 200.0;
  c.contact.friction = 0.4;
  c.run.settle = 0.03;
  c.run.start_up = 0.02;
  c.run.start_up_turns = 0.25;
  c.run.shortest = 0.03;
  c.run.longest = 0.05;
  c.run.window = 3e-3;
  return c;
}

}  // namespace

TEST_CASE("spheres start clear of each other and of the walls, as many as were asked for, and by the seed alone") {
  dem::Case c;
  const dem::Packing packing = dem::pack(c, 3);
  REQUIRE(packing.position.size() == 2400);
  const dem::Simulation s(scene::rig(c, 3));
  CHECK(s.sums().contacts == 0);
  CHECK(s.sums().wall_contacts == 0);
  CHECK(dem::pack(c, 3).position[17].x == packing.position[17].x);
  CHECK(dem::pack(c, 4).position[17].x != packing.position[17].x);
}

TEST_CASE("the meshes of mixer and trough share their seams with their periodic copies") {
  const dem::Rig rig;
  for (const dem::TriangleMesh& one : {dem::auger_mesh(rig), dem::trough_mesh(rig, 0.01)}) {
    const dem::TriangleMesh three = dem::with_copies(one, {{rig.pitch, 0.0, 0.0}}, 1e-9 * rig.pitch);
    CHECK(three.triangles.size() == 3 * one.triangles.size());
    CHECK(three.vertices.size() < 3 * one.vertices.size());  // the copies share their seams
  }
}

TEST_CASE("momentum is kept to rounding in a periodic gas of rough, sticky spheres") {
  // Enough spheres for two chunks, whose halos carry what crosses from one to the other.
  dem::Case c;
  c.contact.hamaker = 2e-18;
  const double size = c.material.diameter;
  dem::Setup setup = scene::box(c, {}, {});
  setup.low = {};
  setup.high = {45.0 * size, 10.0 * size, 10.0 * size};
  setup.periodic = {true, true, true};
  data::RandomStream random(5, data::Purpose::test);
  for (int k = 0; k < 2304; ++k) {
    setup.spheres.position.push_back(
        {(k / 64 + 0.5) * 1.25 * size, (k / 8 % 8 + 0.5) * 1.25 * size, (k % 8 + 0.5) * 1.25 * size});
    setup.spheres.velocity.push_back({random.normal(), random.normal(), random.normal()});
    setup.spheres.spin.push_back({1e3 * random.normal(), 1e3 * random.normal(), 1e3 * random.normal()});
  }
  dem::Simulation s(std::move(setup));
  const dem::Vec3 before = s.momentum();
  double typical = 0.0, contacts = 0.0;
  for (int k = 0; k < 1000; ++k) {
    s.step();
    contacts += static_cast<double>(s.sums().contacts);
  }
  typical = 2304.0 * dem::derive(c).mass;  // kg m/s, the sum of the speeds' order
  CHECK(s.state().chunks() == 2);
  CHECK(contacts > 10000.0);
  CHECK(dem::length(s.momentum() - before) < 1e-13 * typical);
}

TEST_CASE("the slice has the same bits with 1, 2 and 4 threads, in one chunk and in several") {
  for (const auto& [hamaker, pitches] : {std::pair{0.0, 1}, std::pair{4e-18, 8}}) {
    dem::Case c = small_case();
    c.rig.pitches = pitches;
    c.rig.fill *= pitches;
    c.rig.angular_velocity = 100.0;
    c.contact.hamaker = hamaker;
    scene::check_threads_agree(c, 800);
  }
}

TEST_CASE("a run stopped and gone on from its checkpoint ends with the same bits") {
  scene::check_resumed_agrees(small_case(), 12);
}

TEST_CASE("a stop request ends a run early with a checkpoint to go on from") {
  std::stop_source source;
  source.request_stop();
  dem::RunOptions options;
  options.stop = source.get_token();
  const dem::RunResult result = dem::run(small_case(), 1, options);
  CHECK(result.status == dem::RunStatus::interrupted);
  CHECK(result.checkpoint.state.particles() == 350);
}

TEST_CASE("a sphere that leaves the rig ends the run with who, where and when") {
  dem::Case c = small_case();
  dem::Setup setup = scene::rig(c, 1, scene::at_rest);
  setup.bodies.pop_back();  // no trough
  dem::Simulation s(std::move(setup));
  CHECK_THROWS_WITH(
      [&] {
        while (s.time() < 1.0) s.step();
      }(),
      Catch::Contains("outside the rig") && Catch::Contains("m, at"));
}

TEST_CASE("spheres that start inside each other end the run instead of spreading nonsense") {
  const dem::Case c;
  dem::Setup setup = scene::box(c, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, {});
  CHECK_THROWS_AS(
      [&] {
        dem::Simulation s(setup);
        for (int k = 0; k < 100; ++k) s.step();
      }(),
      dem::Fault);
}

TEST_CASE("in steady state the torques of mixer and trough and the weight's moment balance", "[slow]") {
  // T_mixer + T_trough + sum m g y = rate of change of the angular momentum, which averages out.
  dem::Case c;
  dem::Simulation s(scene::rig(c, 2, std::llround(0.06 / dem::derive(c).time_step)));
  while (s.time() < 0.06) s.step();
  const double start = s.time() + 0.15;
  while (s.time() < start) s.step();
  double mixer = 0.0, trough = 0.0, weight = 0.0;
  int steps = 0;
  const auto spin = [&] {
    double sum = 0.0;
    for (std::size_t i = 0; i < s.state().half.size(); ++i) {
      const auto [p, r] = s.state().position[i];
      const dem::MotionRow m = s.motion(i);
      sum += m.mass * (p.y * m.velocity.z - p.z * m.velocity.y) + 0.4 * m.mass * r * r * m.spin.x;
    }
    return sum;
  };
  const double before = spin(), time = s.time();
  while (s.time() < start + 0.1) {
    s.step();
    ++steps;
    mixer += s.sums().body[dem::mixer].torque.x;
    trough += s.sums().body[dem::trough].torque.x;
    for (std::size_t i = 0; i < s.state().particles(); ++i)
      weight += s.state().motion[i].mass * 9.81 * s.state().position[i].at.y;
  }
  const double rate = (spin() - before) / (s.time() - time);
  const double torque = -mixer / steps;
  INFO("torque " << 1e6 * torque << " uN m, trough " << 1e6 * trough / steps << ", weight " << 1e6 * weight / steps
                 << ", rate " << 1e6 * rate);
  CHECK(torque > 0.0);
  CHECK(std::abs(mixer / steps + trough / steps + weight / steps + rate) < 2e-3 * torque);
}

TEST_CASE("powder in a mixer at rest comes to rest", "[slow]") {
  dem::Case c = small_case();
  dem::Simulation s(scene::rig(c, 1, scene::at_rest));
  while (s.time() < 0.5) s.step();
  const double d = dem::derive(c).weight * c.material.diameter;
  CHECK(s.kinetic_energy() < 1e-4 * 350.0 * d);
}
