// What a surrogate's report notes of the design of its runs.
#include "uq/emulate/surrogate_report.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "surrogate/design.hpp"

using namespace uq;

namespace {

/// a + b on the unit square, at these points.
SurrogateReport report_at(const Eigen::MatrixXd& points) {
  data::Study study;
  for (const char* name : {"a", "b"}) {
    data::Parameter parameter;
    parameter.name = name;
    study.parameters.push_back(parameter);
  }
  data::Output torque;
  torque.name = "torque";
  study.outputs.push_back(torque);
  SurrogateOptions options;
  options.fit.starts = 2;
  FittedSurrogate fitted{
      .rows = {.material = "",
               .output = 0,
               .set = {points, points.rowwise().sum(), Eigen::VectorXd::Constant(points.rows(), 1e-6)},
               .low = std::nullopt,
               .places = {},
               .inputs = {{InputKind::parameter, 0}, {InputKind::parameter, 1}},
               .constants = {},
               .control_range = {}},
      .process = {},
      .two_level = {},
      .report = {}};
  fitted.process = std::make_shared<surrogate::GaussianProcess>(surrogate::fit(fitted.rows.set, options.fit));
  return report_of(study, fitted, options);
}

std::string note_of(const SurrogateReport& report, const std::string& words) {
  for (const std::string& note : report.notes)
    if (note.find(words) != std::string::npos) return note;
  return {};
}

}  // namespace

TEST_CASE("an input of few values is named with what takes its doubt away, one of many is not", "[uq]") {
  Eigen::MatrixXd grid(9, 2);
  for (int i = 0; i < 9; ++i) grid.row(i) << 0.5 * (i / 3), 0.5 * (i % 3);
  const SurrogateReport few = report_at(grid);
  CHECK(note_of(few, "values of a were run").rfind("3 values of a", 0) == 0);
  CHECK(note_of(few, "values of b were run").find("between_runs = \"trusted\"") != std::string::npos);
  CHECK(note_of(report_at(surrogate::scrambled_sobol(30, 2, 1, 0)), "were run, and").empty());
}
