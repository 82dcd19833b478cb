// Columns that nothing reads: named where they move an output and are chosen apart, and not where they follow from the
// inputs.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

#include "uq/calibrate/data_check.hpp"

using Catch::Contains;

namespace {

struct Run {
  double friction, cohesion, unread, noise;  ///< the first three uniform in 0 to 1, the noise normal
};

/// Findings about `count` runs with a torque and a column that nothing reads.
std::vector<data::Finding> found(int count, unsigned seed, const std::function<double(const Run&)>& torque,
                                 const std::function<double(const Run&)>& column) {
  data::Study study;
  for (const char* name : {"friction", "cohesion"}) {
    data::Parameter parameter;
    parameter.name = name;
    parameter.low = 0.0;
    parameter.high = 1.0;
    study.parameters.push_back(parameter);
  }
  study.outputs.resize(1);
  study.outputs[0].name = "torque";
  data::RunTable table = data::empty_table(study);
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  for (int i = 0; i < count; ++i) {
    const Run run{uniform(engine), uniform(engine), uniform(engine), normal(engine)};
    data::RunRow row;
    row.inputs = {run.friction, run.cohesion};
    row.outputs = {torque(run)};
    row.standard_errors = {0.01};
    row.unread = {{"restitution", column(run)}, {"a_power", 3.0 * torque(run) + 0.01 * run.cohesion}};
    row.place = "runs.csv:" + std::to_string(i + 2);
    table.rows.push_back(row);
  }
  return uq::check_unread_inputs(study, table, {});
}

double of_both(const Run& run) { return 2.0 + 3.0 * run.friction / (0.3 + run.friction) + run.cohesion; }
double as_written(const Run& run) { return run.unread; }

}  // namespace

TEST_CASE("a column that moves the torque, and that nothing reads, is named") {
  const auto torque = [](const Run& run) { return of_both(run) * (1.0 - 0.4 * run.unread) + 0.02 * run.noise; };
  const auto findings = found(60, 1, torque, as_written);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].kind == data::FindingKind::unread_columns);
  CHECK(findings[0].severity == data::Severity::warning);
  CHECK(findings[0].place == "runs.csv");
  CHECK_THAT(findings[0].what, Contains("the column restitution moves torque"));
  CHECK_THAT(findings[0].remedy, Contains("[parameters.restitution]"));
  // Also of two levels, and where its influence is no straight line.
  CHECK(found(60, 2, torque, [](const Run& run) { return run.unread < 0.5 ? 0.2 : 0.8; }).size() == 1);
  const auto bent = [](const Run& run) {
    return of_both(run) + 4.0 * std::pow(run.unread - 0.5, 2) + 0.01 * run.noise;
  };
  CHECK(found(60, 3, bent, as_written).size() == 1);
}

TEST_CASE("columns without influence are not named, however many there are") {
  for (unsigned seed = 0; seed < 200; ++seed) {
    INFO(seed);
    CHECK(found(
              30, seed, [](const Run& run) { return of_both(run) + 0.1 * run.noise; }, as_written)
              .empty());
  }
}

TEST_CASE("an output that shares the torque's scatter is no input, nor is a column that hardly matters") {
  const auto torque = [](const Run& run) { return of_both(run) + 0.1 * run.noise; };
  CHECK(found(60, 1, torque, [&](const Run& run) { return 3.0 * torque(run) + 0.1 * run.unread; }).empty());  // power
  CHECK(found(
            60, 1, [&](const Run& run) { return torque(run) + 0.05 * run.unread; }, as_written)
            .empty());
  CHECK(found(60, 1, torque, [](const Run&) { return 0.9; }).empty());
  CHECK(found(
            8, 1, [](const Run& run) { return of_both(run) + run.unread; }, as_written)
            .empty());  // too few runs
}
