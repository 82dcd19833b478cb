// Planned readings in a case's model: which errors they share with what is measured, and which are their own.
#include "uq/plan/extended_case.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/uq/plan/plans.hpp"
#include "uq/posterior/posterior.hpp"

using namespace plans;

TEST_CASE("a reading of an output that has no set yet is made at settings of the same error", "[plan]") {
  data::Study study = one_unknown();
  const data::SettingError speed{.control = 0, .spread = {.absolute = 0.2}};  // moves the angle by 0.4
  study.controls[0].uncertainty = speed;
  study.observations[0].setting_errors = {speed};
  for (const bool sampled : {false, true}) {
    study.observations[0].setting_errors[0].as =
        sampled ? data::SettingErrorAs::unknown : data::SettingErrorAs::covariance;
    const PlanReport plan = plan_of(study, formula::emulators(), {.candidates = {reading_of(1, 0.1)}}, {.about = "a"});
    const auto& about = plan.candidates.front().parameters[0];
    CHECK(about.information == Approx(taught_by_angle(0.01 + 0.16)).margin(about.information_error + 0.005));
  }
}

namespace {

/// Both outputs move with the speed, which is known to 0.05: by 4 and 2 a range.
const formula::Pair steep{[](double a, double, double x) { return 10.0 + 5.0 * a + 4.0 * x; }, formula::angle};

/// one_unknown, read at the speed 0.5 and, so that the speeds differ, at 1.
data::Study read_at_two_speeds() {
  data::Study study = one_unknown();
  std::vector<data::Observation>& points = study.observations[0].points;
  points.push_back(points[0]);
  points[1].controls = {1.0};
  points[0].values = {14.5};
  points[1].values = {16.5};
  study.observations[0].setting_errors = {{.control = 0, .spread = {.absolute = 0.05}}};
  return study;
}

}  // namespace

TEST_CASE("a repeat at a measured speed shares that speed's error, whatever other speeds were measured", "[plan]") {
  const PlanReport plan = plan_of(read_at_two_speeds(), formula::emulators(0.0, steep),
                                  {.candidates = {reading_of(0, 0.1)}}, {.about = "a"});
  const double own = 0.01, speed = 0.04, other = 25.0 / (own + speed);
  const double before = 100.0 + other + 25.0 / (own + speed), after = 100.0 + other + 25.0 / (own / 2.0 + speed);
  const auto& about = plan.candidates.front().parameters[0];
  CHECK(about.information == Approx(0.5 * std::log(after / before)).margin(about.information_error + 0.002));
}

TEST_CASE("all measured settings read again are a candidate of their own, at the cost of all", "[plan]") {
  const PlanReport plan = plan_of(read_at_two_speeds(), formula::emulators(0.0, steep), {}, {.about = "a"});
  const auto all = std::find_if(plan.candidates.begin(), plan.candidates.end(),
                                [](const PlanCandidate& one) { return one.settings.size() == 2; });
  REQUIRE(all != plan.candidates.end());
  CHECK(all->kind == uq::CandidateKind::repeat);
  CHECK(all->cost == 2.0);
  // The error of a reading that nobody states is the measured ones' share of their values.
  const double share = 0.5 * (0.1 / 14.5 + 0.1 / 16.5), speed = 0.04, own = 0.01;
  const auto again = [&](double value) { return 1.0 / (1.0 / own + 1.0 / std::pow(share * value, 2)); };
  const double before = 100.0 + 2.0 * 25.0 / (own + speed);
  const double after = 100.0 + 25.0 / (again(14.5) + speed) + 25.0 / (again(16.5) + speed);
  const auto& about = all->parameters[0];
  CHECK(about.information == Approx(0.5 * std::log(after / before)).margin(about.information_error + 0.002));
}

TEST_CASE("outputs of one candidate share their speed's error, in the case's sets and in new ones", "[plan]") {
  data::PlanEntry both = reading_of(0, 0.1);
  both.outputs = {0, 1};
  both.settings = {{0.8}};
  const PlanReport plan =
      plan_of(read_at_two_speeds(), formula::emulators(0.0, steep), {.candidates = {both}}, {.about = "a"});
  const Eigen::Vector2d slope(5.0, 3.0), of_speed(4.0, 2.0);
  const Eigen::Matrix2d covariance = 0.01 * Eigen::Matrix2d::Identity() + 0.0025 * of_speed * of_speed.transpose();
  const double before = 100.0 + 2.0 * 25.0 / 0.05, after = before + slope.dot(covariance.inverse() * slope);
  const auto& about = plan.candidates.front().parameters[0];
  CHECK(about.information == Approx(0.5 * std::log(after / before)).margin(about.information_error + 0.002));
}

TEST_CASE("a candidate that names no meter is read with the one that has read its output elsewhere", "[plan]") {
  data::Study study = one_unknown();
  data::ObservationSet other{.name = "other", .file = "other.csv", .outputs = {1}, .meter = "camera"};
  other.points = {{.controls = {0.5}, .values = {10.0}, .standard_errors = {0.1}}};
  other.common_errors = {{1, {.absolute = 0.4}}};
  study.observations.push_back(other);  // no set of the case
  const PlanReport plan = plan_of(study, formula::emulators(), {.candidates = {reading_of(1, 0.1)}}, {.about = "a"});
  const auto& about = plan.candidates.front().parameters[0];
  CHECK(about.information == Approx(taught_by_angle(0.01 + 0.16)).margin(about.information_error + 0.005));
}

TEST_CASE("the discrepancy of an output that is not read yet is a share of what the model predicts", "[plan]") {
  data::Study study = measured(0.5, 0.5, 0.1, 1);
  data::Parameter size{.name = "sd", .target = "sd", .low = 0.01, .high = 0.1};
  size.prior = {.low = 0.01, .high = 0.1};
  data::Parameter length = size;
  length.name = length.target = "length";
  study.cases[0].nuisances = {{data::NuisanceKind::discrepancy_sd, {}, size},
                              {data::NuisanceKind::discrepancy_length, {}, length}};
  const std::vector<uq::Emulator> emulators = formula::emulators();
  const uq::CaseModel model = uq::build_case(study, emulators, 0);
  const std::vector<uq::plan::Candidate> candidates =
      uq::plan::candidates_of(study, emulators, 0, {.candidates = {reading_of(1, 0.1)}});
  const Eigen::VectorXd u = Eigen::Vector4d(0.4, 0.6, 0.5, 0.5);
  const uq::plan::ExtendedCase extended = uq::plan::extend(study, emulators, 0, model, candidates, u);
  REQUIRE(extended.model.groups.size() == 2);
  CHECK(extended.model.groups[1].measurement.discrepancies.at(0).magnitude ==
        Approx(formula::angle(0.4, 0.6, 0.5)).epsilon(1e-9));
}

TEST_CASE("where the readings' sd is an unknown, a candidate's own error and the number of its readings count",
          "[plan]") {
  data::Study study = measured(0.5, 0.5, 0.1, 1);
  data::Parameter sd{.name = "sd", .target = "sd", .low = 0.01, .high = 1.0};
  sd.prior = {.low = 0.01, .high = 1.0};
  study.cases[0].nuisances = {{data::NuisanceKind::noise_sd, {}, sd}};
  const std::vector<uq::Emulator> emulators = formula::emulators();
  const uq::CaseModel model = uq::build_case(study, emulators, 0);
  std::vector<uq::plan::Candidate> candidates =
      uq::plan::candidates_of(study, emulators, 0, {.candidates = {reading_of(0, 0.05), reading_of(0, 0.05)}});
  candidates[0].readings = candidates[1].readings = 4;
  candidates[1].stated_error = false;
  const Eigen::VectorXd u = Eigen::Vector3d(0.5, 0.5, 0.2);
  const uq::plan::ExtendedCase extended = uq::plan::extend(study, emulators, 0, model, candidates, u);
  const uq::StackedPrediction all = uq::predict(extended.model, u);
  const Eigen::VectorXd noise = extended.noise_at(all.mean, all.noise);
  const double unknown = extended.model.unknowns[2].value(0.2);
  CHECK(noise[extended.planned[0].front()] == Approx(0.05 * 0.05 / 4.0).epsilon(1e-9));
  CHECK(noise[extended.planned[1].front()] == Approx(unknown * unknown / 4.0).epsilon(1e-9));
  for (const Eigen::Index row : extended.measured) CHECK(noise[row] == Approx(unknown * unknown).epsilon(1e-9));
}
