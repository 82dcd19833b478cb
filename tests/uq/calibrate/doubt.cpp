// What a case takes without feedback from another, it takes with the other's faults. The torque is
// 1 + 2 |friction - 0.5| friction + (cohesion - friction / 2) speed, so that up to three frictions give the same torque
// at speed 0, each with a cohesion of its own at speed 1.
#include "uq/calibrate/doubt.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/temporary.hpp"

using namespace uq;

namespace {

std::vector<Emulator> valley() {
  Emulator emulator{.material = "",
                    .output = 0,
                    .inputs = {{InputKind::parameter, 0}, {InputKind::parameter, 1}, {InputKind::control, 0}},
                    .constants = {},
                    .control_range = {},
                    .predict = {}};
  emulator.predict = [](const Eigen::MatrixXd& points) -> surrogate::Prediction {
    return {.mean = 1.0 + 2.0 * (points.col(0).array() - 0.5).abs() * points.col(0).array() +
                    (points.col(1).array() - 0.5 * points.col(0).array()) * points.col(2).array(),
            .covariance = Eigen::MatrixXd::Zero(points.rows(), points.rows())};
  };
  return {emulator};
}

/// Cases "first" (friction alone), "second" (cohesion, friction cut from first), "third" (cohesion cut from second).
data::Study chain(const TemporaryFolder& folder, const std::string& first_rows) {
  folder.write("first.csv", "speed,torque,torque_se\n" + first_rows);
  folder.write("second.csv", "speed,torque,torque_se\n1,1.4,0.005\n1,1.405,0.005\n");
  folder.write("third.csv", "speed,torque,torque_se\n0,1.8,0.005\n");
  const data::StudyFile file = data::StudyFile::open(folder.write(
      "study.toml",
      "[study]\nname = \"s\"\nseed = 5\n[parameters.friction]\nlow = 0\nhigh = 1\n[parameters.cohesion]\nlow = 0\nhigh "
      "= 1\n[training]\ntable = \"runs.csv\"\n[outputs.torque]\nunit = \"N m\"\n"
      "[controls.speed]\nlow = 0\nhigh = 1\n"
      "[[observe]]\nname = \"first\"\nfile = \"first.csv\"\n[[observe]]\nname = \"second\"\nfile = \"second.csv\"\n"
      "[[observe]]\nname = \"third\"\nfile = \"third.csv\"\n"
      "[[calibrate]]\nname = \"first\"\nobserve = [\"first\"]\nfree = [\"friction\"]\nfixed = { cohesion = 0 }\n"
      "[[calibrate]]\nname = \"second\"\nobserve = [\"second\"]\nfree = [\"friction\", \"cohesion\"]\n"
      "priors = { friction = { posterior = \"first\", cut = true } }\n"
      "[[calibrate]]\nname = \"third\"\nobserve = [\"third\"]\nfree = [\"friction\", \"cohesion\"]\n"
      "priors = { cohesion = { posterior = \"second\", cut = true } }\n"));
  data::Study study = data::read_study(file);
  file.finish();
  return study;
}

CaseReport judged(const data::Study& study, std::size_t index) {
  return report_case(study, sample_case(study, valley(), index), {});
}

}  // namespace

TEST_CASE("nothing is identified by what comes cut from a case that does not fit, at once or over another case",
          "[uq]") {
  const TemporaryFolder folder;
  const data::Study study = chain(folder, "0,1.2,0.005\n0,1.3,0.005\n");  // 14 standard errors apart
  REQUIRE_FALSE(judged(study, 0).fits);
  const CaseReport second = judged(study, 1), third = judged(study, 2);
  CHECK_THAT(second.doubt, Catch::Contains("friction comes from case first, which does not fit its data"));
  CHECK_THAT(third.doubt, Catch::Contains("cohesion comes from case second"));
  for (const CaseReport* report : {&second, &third})
    for (const ParameterReport& parameter : report->parameters) {
      CAPTURE(report->name, parameter.name);
      CHECK(parameter.verdict != Verdict::identified);
      CHECK(parameter.verdict != Verdict::weakly_identified);
    }
  CHECK_FALSE(second.warnings.empty());
}

TEST_CASE("a friction cut with three values gives the cohesion three, and none between them", "[uq]") {
  const TemporaryFolder folder;
  // 2 |f - 1/2| f = 0.1 at f = 0.1382, 0.3618 and 0.5854; then cohesion = 0.3025 + f / 2.
  const data::Study study = chain(folder, "0,1.1,0.005\n0,1.1005,0.005\n");
  const CaseReport second = judged(study, 1);
  CHECK(second.doubt.empty());
  REQUIRE(second.parameters.size() == 2);
  CHECK(second.parameters[0].verdict == Verdict::several_values);
  const ParameterReport& cohesion = second.parameters[1];
  INFO(cohesion.sentence);
  CHECK(cohesion.verdict == Verdict::several_values);
  REQUIRE(cohesion.intervals.size() == 3);
  const double friction[] = {0.1382, 0.3618, 0.5854};
  for (std::size_t i = 0; i < 3; ++i) {
    const double truth = 0.3025 + 0.5 * friction[i];
    CHECK(cohesion.intervals[i].low < truth);
    CHECK(cohesion.intervals[i].high > truth);
    CHECK(cohesion.intervals[i].high - cohesion.intervals[i].low < 0.06);
  }
}

TEST_CASE("a prior that the data contradict leaves no verdict, however narrow it is, and the model is said to fit",
          "[uq]") {
  // At speed 0 the torque 1.8 +- 0.05 is a friction of 0.93 +- 0.02. The prior says less, to 0.02 or to 0.001.
  const TemporaryFolder folder;
  data::Study study = chain(folder, "0,1.8,0.05\n");
  for (const auto& [mean, sd] : {std::pair{0.83, 0.02}, {0.86, 0.001}}) {
    study.cases[0].priors["friction"] = {
        .kind = data::PriorKind::normal, .low = 0.0, .high = 1.0, .mean = mean, .sd = sd};
    const CaseReport report = judged(study, 0);
    CAPTURE(sd, report.finding);
    CHECK_THAT(report.finding, Catch::Contains("No verdict: the data contradict the prior of friction by"));
    CHECK_THAT(report.remedy, Catch::Contains("Check that prior"));
    CHECK(report.fits);
    CHECK(report.parameters[0].verdict == Verdict::not_identified);
  }
}
