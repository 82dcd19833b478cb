// Two outputs of a measurement under each other's headings.
#include <catch2/catch.hpp>

#include "uq/calibrate/data_check.hpp"

using Catch::Contains;

namespace {

/// What is refused of a measurement of torque and angle, where the runs give 5 to 15 and 25 to 60.
std::vector<std::string> refused(const std::vector<double>& torques, const std::vector<double>& angles) {
  data::Study study;
  study.outputs.resize(2);
  study.outputs[0].name = "torque";
  study.outputs[1].name = "angle";
  data::RunTable table = data::empty_table(study);
  for (int i = 0; i <= 10; ++i) {
    data::RunRow row;
    row.outputs = {5.0 + i, 60.0 - 3.5 * i};
    row.standard_errors = {0.1, 0.5};
    table.rows.push_back(row);
  }
  data::ObservationSet bench{.name = "bench", .file = "bench.csv", .outputs = {0, 1}};
  for (std::size_t i = 0; i < torques.size(); ++i)
    bench.points.push_back({.controls = {},
                            .values = {torques[i], angles[i]},
                            .standard_errors = {0.1, 0.5},
                            .line = static_cast<int>(i) + 2});
  study.observations = {bench};
  std::vector<std::string> found;
  for (const data::Finding& one : uq::check_observations(study, table, {}))
    if (one.severity == data::Severity::refusal) found.push_back(one.what);
  return found;
}

}  // namespace

TEST_CASE("outputs of a measurement under each other's headings are refused, and others are not") {
  const auto exchanged = refused({31.0, 35.0, 42.0}, {7.0, 8.0, 9.0});
  REQUIRE(exchanged.size() == 1);
  CHECK_THAT(exchanged[0], Contains("the columns torque and angle look exchanged"));
  CHECK(refused({7.0, 8.0, 9.0}, {31.0, 35.0, 42.0}).empty());
  CHECK(refused({31.0, 35.0, 42.0}, {31.0, 35.0, 42.0}).empty());  // one is wrong, and not exchanged
  CHECK(refused({70.0, 80.0, 90.0}, {7.0, 8.0, 9.0}).empty());
}
