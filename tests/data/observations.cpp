// Points of measurements that belong together.
#include "data/observations.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

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
