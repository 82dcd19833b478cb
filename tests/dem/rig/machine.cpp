// The machine of two augers: its room against counted points, its walls for gaps, where its powder starts, that it
// goes round, and that its runs have the same bits.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numeric>

#include "data/random.hpp"
#include "dem/case/cross_section.hpp"
#include "dem/case/grains.hpp"
#include "dem/forecast/forecast.hpp"
#include "dem/reading/prepare.hpp"
#include "dem/reading/target.hpp"
#include "dem/rig/machine.hpp"
#include "dem/run/mixing.hpp"
#include "dem/run/run.hpp"
#include "tests/dem/scene.hpp"
#include "tests/dem/small_rigs.hpp"

using Catch::Contains;

namespace {

/// 36 mm long, with some two thousand spheres of 1.2 mm, at 300 rpm.
dem::Case small_machine() {
  dem::Case c;
  c.rig.machine = dem::Machine{.length = 36e-3, .opening = 9e-3};
  c.rig.trough_radius = 9.6e-3;
  c.rig.level = 0.6;
  c.rig.angular_velocity = 10.0 * M_PI;
  c.material.density = 2500.0;
  c.material.sizes = scene::thirds(1.1e-3, 1.2e-3, 1.3e-3);
  c.contact.stiffness = 400.0;
  c.run.settle = 0.05;
  c.run.steps_per_contact = 15.0;
  return c;
}

/// Whether a point lies in the vessel, the augers not taken out.
bool in_vessel(const dem::Rig& rig, dem::Vec3 p) {
  const dem::Machine& m = *rig.machine;
  const double y = std::abs(p.y) - 0.5 * m.partition - rig.trough_radius, r = rig.trough_radius;
  if (p.x < 0.0 || p.x > m.length || p.z < -r || y > r) return false;
  if (p.z < 0.0 ? std::hypot(y, p.z) < r : std::abs(y) < r) return true;
  if (y > 0.0) return false;  // below the outer half of a circle
  const bool open = p.x < m.opening || p.x > m.length - m.opening;
  return open ? p.z > m.sill : p.z > m.partition_height;
}

/// Mass that crosses planes across the partition, forward less backward, a time and a plane; the first stream's sign
/// turned.
class Crossings {
 public:
  Crossings(const dem::Rig& rig, std::size_t spheres) : at_(spheres) {
    const dem::Machine& m = *rig.machine;
    for (int k = 1; k <= planes; ++k) planes_.push_back(m.opening + (m.length - 2.0 * m.opening) * (k - 0.5) / planes);
  }
  void look(const dem::State& s) {
    for (std::size_t i = 0; i < s.particles(); ++i) {
      const dem::Vec3 now = s.position[i].at;
      double& before = at_[s.id[i]];
      if (looked_)
        for (const double plane : planes_)
          crossed_ += ((now.x > plane) - (before > plane)) * std::copysign(s.motion[i].mass, now.y);
      before = now.x;
    }
    looked_ = true;
  }
  double flow(double time) const { return crossed_ / (2.0 * planes * time); }

 private:
  static constexpr int planes = 9;
  std::vector<double> at_, planes_;
  bool looked_ = false;
  double crossed_ = 0.0;
};

struct Flow {
  double crossed = 0.0;              ///< kg/s, counted
  double circulation = 0.0;          ///< kg/s
  double first = 0.0, second = 0.0;  ///< N m
};
Flow turn(const dem::Case& c, double start_up, double measured) {
  scene::Turning turning(c, 3, start_up);
  dem::Simulation& s = turning.simulation;
  const dem::Sensor& sensor = turning.sensor;
  const double dt = turning.time_step;
  Flow mean;
  Crossings crossings(c.rig, s.state().particles());
  crossings.look(s.state());
  const auto steps = static_cast<int>(measured / dt);
  for (int k = 0; k < steps; ++k) {
    s.step();
    mean.circulation += (s.carried().flow[0] - s.carried().flow[1]) / sensor.flow_length / steps;
    mean.first += dot(sensor.driven[0].torque_axis, s.sums().body[dem::first_mixer].torque) / steps;
    mean.second += dot(sensor.driven[1].torque_axis, s.sums().body[dem::second_mixer].torque) / steps;
    if (k % 10 == 9 || k + 1 == steps) crossings.look(s.state());
  }
  mean.crossed = crossings.flow(steps * dt);
  return mean;
}

}  // namespace

TEST_CASE("the machine's room below any height is what points at random count") {
  for (const double sill : {-4e-3, 0.0, 3e-3}) {
    dem::Rig rig = small_machine().rig;
    rig.machine->sill = sill;
    // Without augers, so that points can say what is inside.
    rig.shaft_radius = rig.blade_radius = 1e-9;
    const dem::Machine& m = *rig.machine;
    const double r = rig.trough_radius, side = dem::axis_offset(rig) + r, top = 1.5 * m.partition_height;
    const std::vector<double> heights{-0.7 * r, -0.3 * r, -0.1 * r, 0.2 * r, 0.6 * r, 1.3 * m.partition_height};
    std::vector<double> below(heights.size());
    data::RandomStream random(7, data::Purpose::test);
    constexpr int points = 400000;
    for (int k = 0; k < points; ++k) {
      const dem::Vec3 p{random.uniform(0.0, m.length), random.uniform(-side, side), random.uniform(-r, top)};
      if (!in_vessel(rig, p)) continue;
      for (std::size_t h = 0; h < heights.size(); ++h) below[h] += p.z < heights[h];
    }
    const double box = m.length * 2.0 * side * (top + r);
    for (std::size_t h = 0; h < heights.size(); ++h) {
      INFO("sill " << sill << ", height " << heights[h]);
      const double share = dem::machine_room_below(rig, heights[h]) / box;
      CHECK(below[h] / points == Approx(share).margin(4.0 * std::sqrt(share / points)));
    }
  }
}

TEST_CASE("the double trough has no gap: its triangles share their edges but at end walls and rim") {
  for (const double sill : {-4e-3, -1e-12, 0.0, 3e-3}) {
    dem::Rig rig = small_machine().rig;
    rig.machine->sill = sill;
    constexpr double top = 0.02;
    const dem::TriangleMesh mesh = dem::double_trough(rig, top);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const auto& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
    const auto both = [&](const auto& edge, auto&& holds) {
      return holds(mesh.vertices[edge.first]) && holds(mesh.vertices[edge.second]);
    };
    int open = 0;
    for (const auto& [edge, count] : uses) {
      const bool rim = both(edge, [&](dem::Vec3 v) { return v.z == top; });
      const bool end = both(edge, [&](dem::Vec3 v) { return v.x == 0.0; }) ||
                       both(edge, [&](dem::Vec3 v) { return v.x == rig.machine->length; });
      if (rim || end) continue;
      // At the openings three sheets meet: the sill's, the partition's and the partition's end.
      open += count < 2;
    }
    INFO("sill " << sill);
    CHECK(open == 0);
  }
}

TEST_CASE("the augers of the machine are closed at their blades' ends and keep clear of walls and of each other") {
  const dem::Rig rig = small_machine().rig;
  for (const bool first : {true, false}) {
    const dem::TriangleMesh mesh = first ? dem::first_auger(rig) : dem::second_auger(rig);
    const double y = first ? -dem::axis_offset(rig) : dem::axis_offset(rig);
    const auto radius = [&](std::uint32_t v) { return std::hypot(mesh.vertices[v].y - y, mesh.vertices[v].z); };
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    double from = 1.0, to = 0.0;
    for (const auto& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
    }
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      if (radius(v) < 1.01 * rig.shaft_radius) continue;
      CHECK(radius(v) < rig.blade_radius * (1.0 + 1e-9));
      from = std::min(from, mesh.vertices[v].x);
      to = std::max(to, mesh.vertices[v].x);
    }
    for (const auto& [edge, count] : uses) {
      if (std::min(radius(edge.first), radius(edge.second)) > 1.01 * rig.shaft_radius) CHECK(count == 2);
    }
    const dem::Machine& m = *rig.machine;
    const double slack = rig.pitch / 48 + rig.blade_thickness;
    CHECK(from == Approx(first ? m.opening : 2.0 * rig.clearance()).margin(slack));
    CHECK(to == Approx(first ? m.length - 2.0 * rig.clearance() : m.length - m.opening).margin(slack));
    CHECK(from > 0.0);
    CHECK(to < m.length);
  }
}

TEST_CASE("the machine starts with as many spheres as its level asks for, in both troughs alike, none touching") {
  const dem::Case c = small_machine();
  const dem::BuiltRig rig = dem::build_rig(c, 1);
  const dem::BedSummary bed = dem::summarise_bed(c);
  CHECK(rig.position.size() == bed.spheres);
  CHECK(bed.volume / dem::packing_fraction == Approx(0.6 * dem::level_volume(c.rig)).epsilon(0.002));
  const auto first = std::count_if(rig.position.begin(), rig.position.end(), [](dem::Vec3 p) { return p.y < 0.0; });
  CHECK(static_cast<double>(first) == Approx(0.5 * static_cast<double>(bed.spheres)).epsilon(0.03));
  CHECK(std::all_of(rig.position.begin(), rig.position.end(), [&](dem::Vec3 p) { return in_vessel(c.rig, p); }));
  const dem::Simulation s(scene::rig(c, 1));
  CHECK(s.sums().contacts == 0);
  CHECK(s.sums().wall_contacts == 0);
}

TEST_CASE("the machine's powder goes round, and both mixers resist alike", "[slow]") {
  const dem::Case c = small_machine();
  const Flow forward = turn(c, 0.1, 0.1);
  CHECK(forward.circulation > 0.0);
  CHECK(forward.circulation == Approx(forward.crossed).epsilon(0.1));
  CHECK(forward.first > 0.0);
  // The second auger is the first turned about the vertical: they differ by their phase.
  CHECK(forward.second == Approx(forward.first).epsilon(0.25));
  // A lap takes some turns: no powder outruns its auger, a pitch a turn, and some of it moves.
  const double mass = dem::summarise_bed(c).mass, turn_time = 2.0 * M_PI / c.rig.angular_velocity;
  const double laps_fastest = 2.0 * c.rig.machine->length / c.rig.pitch * turn_time;
  CHECK(mass / forward.circulation > laps_fastest);
  CHECK(mass / forward.circulation < 20.0 * laps_fastest);
}

TEST_CASE("a machine has the same bits with 1, 2 and 4 threads") {
  dem::Case c = small_machine();
  c.run.settle = 0.02;
  std::vector<double> torque;
  for (const int threads : {1, 2, 4}) {
    dem::BuiltRig rig = dem::build_rig(c, 2);
    dem::Simulation s(dem::make_setup(c, dem::derive(c), std::move(rig), 100, threads));
    double sum = 0.0, circulation = 0.0;
    for (int k = 0; k < 1500; ++k) {
      s.step();
      sum += s.sums().body[dem::first_mixer].torque.x;
      circulation += s.carried().flow[0] - s.carried().flow[1];
    }
    CHECK(circulation != 0.0);
    torque.push_back(sum + circulation);
  }
  CHECK(torque[0] == torque[1]);
  CHECK(torque[0] == torque[2]);
}

TEST_CASE("the machine's output is the sum of both mixers' torques about their own axes") {
  const dem::BuiltRig rig = dem::build_rig(small_machine(), 1);
  REQUIRE(rig.sensor.driven.size() == 2);
  CHECK(rig.bodies[0].motion.point.y == -dem::axis_offset(small_machine().rig));
  CHECK(rig.bodies[1].motion.point.y == dem::axis_offset(small_machine().rig));
  CHECK(rig.bodies[0].motion.axis.x == -rig.bodies[1].motion.axis.x);
  CHECK(rig.sensor.driven[0].torque_axis.x == -rig.bodies[0].motion.axis.x);
  CHECK(rig.sensor.driven[1].torque_axis.x == -rig.bodies[1].motion.axis.x);
}

TEST_CASE("a run of the machine has both mixers' torques, which sum to the output, and says how its powder circulates",
          "[slow]") {
  dem::Case c = small_machine();
  c.rig.level = 0.5;
  c.run.settle = 0.02;
  c.run.start_up = 0.02;
  c.run.start_up_turns = c.run.shortest_turns = 0.0;
  c.run.shortest = 0.03;
  c.run.longest = 0.05;
  c.run.window = 3e-3;
  const dem::RunResult result = dem::run(c, 1, {});
  const auto mean = [&](const char* name) { return dem::output(result, name).mean; };
  CHECK(mean("first_torque") + mean("second_torque") == Approx(mean("torque")).epsilon(1e-12));
  CHECK(mean("first_torque") > 0.0);
  CHECK(mean("second_torque") > 0.0);
  CHECK(std::isnan(mean("silhouette_x")));
  CHECK(0.5 * (mean("first_flow") + mean("second_flow")) == Approx(mean("axial_flow")).epsilon(1e-9));
  REQUIRE(result.series.mixing_index.size() == result.series.look_time.size());
  REQUIRE_FALSE(result.series.mixing_index.empty());
  // The colours are those of the filling: what has gone round by the first looks is little.
  CHECK(result.series.mixing_index.back() > 0.0);
  CHECK(result.series.mixing_index.back() < 0.2);
  const double held =
      std::accumulate(result.series.channel_mass.end() - dem::channel_places, result.series.channel_mass.end(), 0.0);
  CHECK(held == Approx(dem::summarise_bed(c).mass).epsilon(0.02));
}

TEST_CASE("a machine that cannot be is refused with its key, and a level that stops the powder is warned of") {
  const auto place = [](auto&& change) {
    dem::Case c = small_machine();
    change(c);
    const std::vector<data::Problem> found = dem::problems(c);
    return found.empty() ? std::string{} : found[0].place;
  };
  CHECK(place([](dem::Case&) {}).empty());
  CHECK(place([](dem::Case& c) { c.rig.machine->length = 20e-3; }) == "rig.machine_length");
  CHECK(place([](dem::Case& c) { c.rig.machine->opening = 2e-3; }) == "rig.opening");
  CHECK(place([](dem::Case& c) { c.rig.machine->sill = -10e-3; }) == "rig.sill");
  CHECK(place([](dem::Case& c) { c.rig.machine->sill = 13e-3; }) == "rig.partition_height");
  CHECK(place([](dem::Case& c) { c.rig.blade_radius = 10e-3; }) == "rig.blade_radius");
  CHECK(place([](dem::Case& c) { c.rig.angular_velocity = 0.0; }) == "rig.rpm");
  CHECK(place([](dem::Case& c) {
          c.rig.level.reset();
          c.rig.fill_mass = 1.0;
        }) == "rig.fill_mass");
  CHECK(dem::no_output_because(small_machine(), "second_torque").empty());
  CHECK_FALSE(dem::no_output_because(small_machine(), "silhouette_x").empty());
  CHECK_FALSE(dem::no_output_because(dem::Case{}, "second_torque").empty());
  dem::Case low = small_machine();
  low.rig.level = 0.15;
  const dem::Forecast f = dem::forecast(dem::prepare(low), 1);
  REQUIRE(f.warnings.size() >= 2);
  CHECK_THAT(f.warnings[f.warnings.size() - 2], Contains("below the openings' sill"));
  CHECK_THAT(f.warnings.back(), Contains("goes round this machine once in 6 turns at best"));
  low.rig.level = 0.5;
  low.run.start_up_turns = 6.0;
  CHECK(dem::forecast(dem::prepare(low), 1).warnings.empty());
}
