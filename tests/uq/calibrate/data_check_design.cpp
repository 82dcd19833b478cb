// Controls that move together in all runs: no matter where the readings lie on the same line.
#include <catch2/catch.hpp>

#include "uq/calibrate/data_check.hpp"

using Catch::Contains;

namespace {

/// Findings about runs whose fill follows the speed, and readings at these settings (both 0 to 1).
std::vector<data::Finding> found(const std::vector<std::vector<double>>& settings) {
  data::Study study;
  for (const char* name : {"speed", "fill"}) {
    data::Control control;
    control.name = name;
    control.low = 0.0;
    control.high = 1.0;
    study.controls.push_back(control);
  }
  study.outputs.resize(1);
  study.outputs[0].name = "torque";
  data::RunTable table = data::empty_table(study);
  for (int i = 0; i <= 20; ++i) {
    data::RunRow row;
    row.inputs = {0.05 * i, 0.2 + 0.03 * i};
    row.outputs = {1.0 + 0.1 * i};
    row.standard_errors = {0.1};
    row.place = "runs.csv:" + std::to_string(i + 2);
    table.rows.push_back(row);
  }
  data::ObservationSet bench{.name = "bench", .file = "bench.csv", .outputs = {0}};
  for (const auto& at : settings) bench.points.push_back({.controls = at, .values = {1.5}, .standard_errors = {0.1}});
  study.observations = {bench};
  return uq::check_design(study, table, {});
}

}  // namespace

TEST_CASE("controls that move together are named where a reading lies beside their line, or there is none") {
  CHECK(found({{0.1, 0.26}, {0.5, 0.5}, {0.9, 0.74}}).empty());
  for (const auto& settings : {std::vector<std::vector<double>>{{0.1, 0.26}, {0.5, 0.8}}, {}}) {
    const auto findings = found(settings);
    REQUIRE(findings.size() == 1);
    CHECK_THAT(findings[0].what, Contains("speed and fill move together"));
  }
}
