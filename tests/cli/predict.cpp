// [[predict]]: data that a case does not use, held against what it predicts.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using Catch::Matchers::Contains;
using test::Folder;

namespace {

/// Makes the study on another code's runs, with readings at two more speeds that the case does not use.
void make_study(const Folder& folder, const std::string& later, const std::string& observe) {
  folder.study("other-code");
  folder.write("study/later.csv", later);
  folder.write("study/study.toml", folder.read("study/study.toml") +
                                       "[[observe]]\nname = \"later\"\nfile = \"later.csv\"\n"
                                       "[[predict]]\nname = \"held out\"\nobserve = [\"" +
                                       observe + "\"]\n");
}

}  // namespace

TEST_CASE("data of the same law are predicted, and the page shows each beside its interval") {
  const Folder folder;
  make_study(folder, "speed,torque,torque_se\n75,9.62,0.29\n275,11.15,0.33\n", "later");
  const auto outcome = folder.demcal({"calibrate", "study", "--out", "out", "--no-scan"});
  INFO(outcome.err);
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.out, Contains("The calibration predicts them."));
  const nlohmann::json report = nlohmann::json::parse(folder.read("out/report.json"));
  const nlohmann::json& found = report["cases"][0]["predictions"][0];
  CHECK(found["name"] == "held out");
  CHECK(found["predicts"] == true);
  REQUIRE(found["points"].size() == 2);
  for (const nlohmann::json& point : found["points"]) CHECK(std::abs(point["z"].get<double>()) < 3.0);
  CHECK_THAT(folder.read("out/report.html"), Contains("Prediction: held out"));
  // The case is calibrated as if they were not there.
  CHECK(report["cases"][0]["predictive"].size() == 6);
}

TEST_CASE("data that the calibration does not predict are a warning") {
  const Folder folder;
  make_study(folder, "speed,torque,torque_se\n75,9.62,0.29\n275,14.5,0.33\n", "later");
  const auto outcome = folder.demcal({"calibrate", "study", "--out", "out", "--no-scan"});
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.out, Contains("The calibration does not predict them."));
  CHECK_THAT(outcome.out, Contains("torque at speed 275"));
  const nlohmann::json of = nlohmann::json::parse(folder.read("out/report.json"))["cases"][0];
  CHECK_THAT(of["consequence"].get<std::string>(), Contains("and not held out"));
  CHECK_THAT(of["remedy"].get<std::string>(), Contains("First find out what differs at held out"));
}

TEST_CASE("what informs the case is no prediction, and what is not there is named") {
  const Folder folder;
  make_study(folder, "speed,torque,torque_se\n75,9.62,0.29\n", "bench");
  CHECK_THAT(folder.says({"check", "study"}, 78), Contains("'bench' informs the case 'powder' itself"));
  const Folder other;
  make_study(other, "speed,torque,torque_se\n75,9.62,0.29\n", "latr");
  const auto unknown = other.demcal({"check", "study"});
  CHECK(unknown.status == 78);
  CHECK_THAT(unknown.err, Contains("did you mean 'later'?"));
}
