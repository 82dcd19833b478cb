// How many turns a bed takes to forget the speed that it had, beside how many it takes to forget that it was at rest:
// what a run through several speeds would save over one run a speed.
//   bench_staircase STUDY MATERIAL NAME=VALUE,... FROM_RPM TO_RPM SEEDS
// Prints the mean torque over quarters of a turn after the start, and after the change of speed, over its level at that
// speed: the mean from two turns after it on.
#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "campaign/point.hpp"
#include "dem/bed/derived.hpp"
#include "dem/bed/setup.hpp"
#include "dem/reading/target.hpp"
#include "dem/rig/rig.hpp"

namespace {

constexpr int parts_a_turn = 4;
constexpr int turns = 4;  // at each speed

/// Mean torque of each quarter of a turn [N m]: at the first speed, then at the second.
std::vector<double> torque_of(dem::Case c, double from, double to, std::uint64_t seed) {
  c.rig.angular_velocity = from;
  dem::BuiltRig rig = dem::build_rig(c, seed);
  const dem::Sensor sensor = rig.sensor;
  const double turn = 2.0 * std::numbers::pi, change = turns * turn / from;
  const dem::Driven driven = sensor.driven[0];
  rig.bodies[driven.body].motion.programme = {{0.0, from}, {change, from}, {change + 1e-4, to}};
  const double dt = dem::derive(c).time_step;
  const auto rest = static_cast<std::uint64_t>(std::llround(c.run.settle / dt));
  dem::Simulation s(dem::make_setup(c, dem::derive(c), std::move(rig), rest, 1));
  while (s.time() < c.run.settle) s.step();
  std::vector<double> sum(2 * turns * parts_a_turn), steps(sum.size());
  while (true) {
    const double time = s.time() - c.run.settle;
    const double turned = time < change ? time * from / turn : turns + (time - change) * to / turn;
    const auto part = static_cast<std::size_t>(turned * parts_a_turn);
    if (part >= sum.size()) break;
    s.step();
    sum[part] += dot(driven.torque_axis, s.sums().body[driven.body].torque);
    steps[part] += 1.0;
  }
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] /= steps[k];
  return sum;
}

}  // namespace

int main(int count, char** words) {
  if (count != 7) {
    fmt::print(stderr, "bench_staircase STUDY MATERIAL NAME=VALUE,... FROM_RPM TO_RPM SEEDS\n");
    return 64;
  }
  std::vector<std::string> at;
  for (std::string rest = words[3]; !rest.empty();) {
    const std::size_t comma = rest.find(',');
    at.push_back(rest.substr(0, comma));
    rest = comma == std::string::npos ? "" : rest.substr(comma + 1);
  }
  const campaign::Workspace workspace = campaign::open_workspace({.study = words[1], .out = {}, .seed = {}, .set = {}});
  const dem::Case c = campaign::case_at(workspace, campaign::parse_point(workspace, words[2], at));
  const double rpm = std::numbers::pi / 30.0, from = std::atof(words[4]) * rpm, to = std::atof(words[5]) * rpm;
  const int seeds = std::atoi(words[6]);
  constexpr std::size_t half = turns * parts_a_turn;
  std::vector<double> mean(2 * half), square(2 * half);
  for (int seed = 0; seed < seeds; ++seed) {
    const std::vector<double> torque = torque_of(c, from, to, 90000 + static_cast<std::uint64_t>(seed));
    for (std::size_t k = 0; k < mean.size(); ++k) {
      mean[k] += torque[k] / seeds;
      square[k] += torque[k] * torque[k] / seeds;
    }
  }
  for (const std::size_t speed : {0, 1}) {
    double level = 0.0;
    for (std::size_t k = half / 2; k < half; ++k) level += mean[speed * half + k] / (half / 2);
    fmt::print("{} to {} rpm, level {:.2f} uN m\n", speed == 0 ? "rest" : words[4], speed == 0 ? words[4] : words[5],
               1e6 * level);
    for (std::size_t k = 0; k < half; ++k) {
      const std::size_t at_part = speed * half + k;
      const double error = std::sqrt(std::max(0.0, square[at_part] - mean[at_part] * mean[at_part]) / (seeds - 1));
      fmt::print("  {:.2f} to {:.2f} turns: {:.3f} +- {:.3f}\n", static_cast<double>(k) / parts_a_turn,
                 static_cast<double>(k + 1) / parts_a_turn, mean[at_part] / level, error / level);
    }
  }
}
