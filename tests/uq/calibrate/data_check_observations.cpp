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
