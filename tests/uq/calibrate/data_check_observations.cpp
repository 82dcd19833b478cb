// What is said of measurements before anything is fitted.
#include <catch2/catch.hpp>

#include "tests/uq/formula_study.hpp"
#include "uq/calibrate/data_check.hpp"

namespace {

/// What is said where the torque's errors at 0.2 and 0.8 go with those of angles that were read at these speeds.
std::vector<data::Finding> findings_of(const std::vector<double>& speeds) {
  data::Study study = formula::study({0.2, 0.8}, {14.0, 14.5}, 0.1);
  data::ObservationSet camera{.name = "camera", .file = "camera.csv", .outputs = {1}};
  for (const double speed : speeds)
    camera.points.push_back({.controls = {speed}, .values = {11.0}, .standard_errors = {0.1}});
  study.observations[0].correlations = {{.output = 0, .other_output = 1, .other_set = "camera", .value = 0.5}};
  study.observations.push_back(camera);
  return uq::check_observations(study, data::empty_table(study), {});
}

std::string said_with(const std::vector<double>& speeds, data::Severity severity) {
  std::string all;
  for (const data::Finding& finding : findings_of(speeds))
    if (finding.severity == severity) all += data::describe(finding) + "\n";
  return all;
}

}  // namespace

TEST_CASE(
    "a correlation that joins no readings is a warning, one that joins a part a note, one that joins all neither") {
  const std::string unmatched = "have no reading of angle at their setting in 'camera'";
  CHECK_THAT(said_with({0.4, 0.6}, data::Severity::warning), Catch::Contains("2 of 2 readings of torque " + unmatched));
  CHECK_THAT(said_with({0.201, 0.6}, data::Severity::note), Catch::Contains("1 of 2 readings of torque " + unmatched));
  for (const auto severity : {data::Severity::warning, data::Severity::note})
    CHECK_THAT(said_with({0.801, 0.199}, severity), !Catch::Contains(unmatched));
}

TEST_CASE("two sets that agree better than their errors allow are named, unless they say what they share") {
  const auto said = [](double apart, const std::string& meter) {
    std::vector<double> speeds, torques;
    for (int i = 0; i < 8; ++i) {
      speeds.push_back(0.1 + 0.1 * i);
      torques.push_back(14.0 + 0.1 * i);
    }
    data::Study study = formula::study(speeds, torques, 0.1);
    data::ObservationSet again = study.observations[0];
    again.name = "again";
    for (std::size_t i = 0; i < again.points.size(); ++i) again.points[i].values[0] += (i % 2 == 0 ? apart : -apart);
    study.observations[0].meter = again.meter = meter;
    study.cases.at(0).observe.push_back("again");
    study.observations.push_back(again);
    std::string all;
    for (const data::Finding& finding : uq::check_observations(study, data::empty_table(study), {}))
      if (finding.kind == data::FindingKind::counted_twice) all += data::describe(finding);
    return all;
  };
  CHECK_THAT(said(0.004, ""), Catch::Contains("8 readings of torque") && Catch::Contains("which counts twice"));
  CHECK(said(0.004, "cell").empty());
  CHECK(said(0.14, "").empty());  // as two independent readings of 0.1 differ
}

TEST_CASE("a reading whose standard error is far smaller than all others' is named: it would decide alone") {
  const auto said = [](const std::vector<double>& torques, const std::vector<double>& errors) {
    data::Study study = formula::study({0.1, 0.3, 0.5, 0.7, 0.9}, torques, 0.1);
    for (std::size_t i = 0; i < errors.size(); ++i) study.observations[0].points[i].standard_errors[0] = errors[i];
    std::string all;
    for (const data::Finding& finding : uq::check_observations(study, data::empty_table(study), {}))
      if (finding.kind == data::FindingKind::standard_errors) all += data::describe(finding);
    return all;
  };
  const std::vector<double> level{14.0, 14.1, 14.2, 14.3, 14.4}, decades{0.014, 0.14, 1.4, 14.0, 140.0};
  CHECK_THAT(said(level, {0.1, 0.12, 1e-4, 0.1, 0.1}),
             Catch::Contains("outweighs all others") && Catch::Contains("0.0001") && Catch::Contains("993 times"));
  CHECK(said(level, {0.1, 0.12, 0.01, 0.1, 0.1}).empty());           // ten times better
  CHECK(said(decades, {1.4e-4, 1.4e-3, 0.014, 0.14, 1.4}).empty());  // shares of the value
  CHECK(said(decades, {0.1, 0.1, 0.1, 0.1, 0.1}).empty());           // a meter's resolution
}
