// Several rows at one extreme value: named where a sensor's end is likely, and not where rounding is.
#include <catch2/catch.hpp>

#include "uq/calibrate/data_check.hpp"

using Catch::Contains;

namespace {

std::vector<data::Finding> found(const std::vector<double>& torques, bool same_speed = false) {
  data::Study study;
  study.outputs.resize(1);
  study.outputs[0].name = "torque";
  data::ObservationSet bench{.name = "bench", .file = "bench.csv", .outputs = {0}};
  for (std::size_t i = 0; i < torques.size(); ++i)
    bench.points.push_back({.controls = {same_speed ? 1.0 : static_cast<double>(i)},
                            .values = {torques[i]},
                            .standard_errors = {0.1},
                            .line = static_cast<int>(i) + 2});
  study.observations = {bench};
  return uq::check_saturated(study, {});
}

}  // namespace

TEST_CASE("readings of exactly one largest value at several settings are named") {
  const auto clipped = found({8.6, 8.6, 8.6, 8.01, 7.43, 6.88});
  REQUIRE(clipped.size() == 1);
  CHECK(clipped[0].kind == data::FindingKind::saturated);
  CHECK_THAT(clipped[0].place, Contains("bench.csv:2"));
  CHECK_THAT(clipped[0].what, Contains("3 of 6 rows have exactly the largest torque, 8.6"));
  CHECK(found({9.96, 9.38, 8.86, 7.2, 7.2, 7.2}).size() == 1);
}

TEST_CASE("equal extremes that rounding, zeros or repeats explain are not named") {
  CHECK(found({8.6, 8.6, 8.6, 8.5, 8.3, 8.1}).empty());                    // coarse
  CHECK(found({8.61, 8.61, 8.61, 8.01, 8.01, 7.43, 6.88, 5.5}).empty());   // others meet, too
  CHECK(found({0.0, 0.0, 0.0, 8.01, 7.43, 6.88}).empty());                 // nothing there
  CHECK(found({8.613, 8.613, 8.613, 8.011, 7.434, 6.885}, true).empty());  // one setting
  CHECK(found({9.96, 9.38, 9.12, 8.01, 7.78, 6.88}).empty());
}
