// Points of measurements that belong together.
#include "data/observations.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/temporary.hpp"

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

namespace {

data::ObservationSet set_at(const std::vector<double>& speeds) {
  data::ObservationSet set;
  for (const double speed : speeds)
    set.points.push_back({.controls = {speed}, .values = {1.0}, .standard_errors = {0.1}});
  return set;
}

Pairs pairs(const std::vector<double>& first, const std::vector<double>& second) {
  data::Study study;
  data::Control speed;
  speed.name = "speed";
  speed.low = 0.0;
  speed.high = 100.0;
  study.controls.push_back(speed);
  Pairs found = data::points_at_same_settings(study, set_at(first), set_at(second));
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

TEST_CASE("settings of two instruments are the same up to half a per cent of the range") {
  CHECK(pairs({10.0, 20.0, 30.0}, {30.02, 10.0 + 1e-7, 20.4}) == Pairs{{0, 1}, {1, 2}, {2, 0}});
  CHECK(pairs({10.0}, {10.6}).empty());
}

TEST_CASE("each point is paired once, with the nearest, and replicates in the order of the files") {
  CHECK(pairs({10.0, 10.2}, {10.2, 10.0}) == Pairs{{0, 1}, {1, 0}});
  CHECK(pairs({10.0, 10.0, 20.0, 10.0}, {10.0, 20.0, 10.0 + 1e-8}) == Pairs{{0, 0}, {1, 2}, {2, 1}});
}

TEST_CASE("columns of numbers that vary and that nothing reads are named, and those of demcal observe are not") {
  data::Study study;
  data::Control speed;
  speed.name = "speed";
  speed.high = 300.0;
  study.controls.push_back(speed);
  study.outputs.resize(1);
  study.outputs[0].name = "torque";
  const TemporaryFolder folder;
  const auto unread = [&](const std::string& text) {
    return data::read_observations(folder.write("bench.csv", text), study, {}, data::MissingErrors::refused).unread;
  };
  const std::vector<std::string> fill = {"fill (from 0.4 to 0.5)"};
  CHECK(unread("Speed,fill,torque,torque_se\n100,0.4,3,0.1\n200,0.5,4,0.1\n") == fill);
  CHECK(unread("speed,fill,torque,torque_se\n100,0.4,3,0.1\n200,0.4,4,0.1\n").empty());  // the same in all rows
  CHECK(unread("speed,who,torque,torque_se\n100,me,3,0.1\n200,you,4,0.1\n").empty());
  CHECK(unread("speed,torque,torque_se,idle,from_s,seconds,independent,speed_sd\n"
               "100,3,0.1,0.2,0,59,31,0.1\n200,4,0.1,0.3,60,58,15,0.2\n")
            .empty());
}
