// Data that used to give a wrong answer without a word: what is said, where, and with which status.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.hpp"

using Catch::Contains;
using test::Folder;
namespace fs = std::filesystem;

namespace {

struct Run {
  double friction, cohesion, speed, torque, error;
};

double torque(double friction, double cohesion, double speed) {
  return 2.0 + 14.0 * friction / (0.4 + friction) + 0.5 * cohesion * (1.0 - 0.6 * speed / 300.0) - 0.003 * speed;
}

std::vector<Run> runs_of(int count) {
  const auto part = [](double x) { return x - std::floor(x); };
  std::vector<Run> runs;
  for (int i = 1; i <= count; ++i) {
    // Roberts' additive recurrence in three dimensions.
    const double f = 0.1 + 0.7 * part(0.8191725134 * i), c = 10.0 * part(0.6710436067 * i),
                 s = 50.0 + 250.0 * part(0.5497004779 * i);
    const double y = torque(f, c, s) * (1.0 + 0.005 * std::sin(71.0 * i));
    runs.push_back({f, c, s, y, 0.005 * y});
  }
  return runs;
}

void write_study(const Folder& folder, const std::vector<Run>& runs, double friction = 0.4,
                 const std::string& training = "") {
  fs::create_directories(folder.path / "study");
  folder.write(
      "study/study.toml",
      "[study]\nname = \"odd\"\nseed = 7\n[parameters.friction]\nlow = 0.1\nhigh = 0.8\n[parameters.cohesion]\n"
      "unit = \"mJ/m2\"\nlow = 0\nhigh = 10\n[controls.speed]\nunit = \"rpm\"\nlow = 50\nhigh = 300\n"
      "[training]\ntable = \"runs.csv\"\n" +
          training +
          "[outputs.torque]\nunit = \"mN m\"\n[[observe]]\nname = \"bench\"\nfile = \"bench.csv\"\n"
          "[[calibrate]]\nname = \"powder\"\nobserve = [\"bench\"]\nfree = [\"friction\", \"cohesion\"]\n");
  std::ostringstream table, bench;
  table << "friction,cohesion,speed,torque,torque_se\n";
  for (const Run& r : runs)
    table << r.friction << ',' << r.cohesion << ',' << r.speed << ',' << r.torque << ',' << r.error << '\n';
  bench << "speed,torque,torque_se\n";
  for (int i = 0; i < 6; ++i) {
    const double s = 50.0 + 50.0 * i, y = torque(friction, 4.0, s) * (1.0 + 0.01 * std::sin(37.0 * (i + 1)));
    bench << s << ',' << y << ',' << 0.01 * y << '\n';
  }
  folder.write("study/runs.csv", table.str());
  folder.write("study/bench.csv", bench.str());
}

nlohmann::json report_of(const Folder& folder, int status) {
  const auto outcome = folder.demcal({"calibrate", "study", "--out", "out", "--json"});
  INFO(outcome.err);
  REQUIRE(outcome.status == status);
  nlohmann::json report = nlohmann::json::parse(outcome.out);
  report["terminal"] = outcome.err;
  return report;
}

}  // namespace

TEST_CASE("clean data calibrate without a warning, and next-runs.csv is a table of points for any code", "[slow]") {
  const Folder folder;
  write_study(folder, runs_of(60));
  CHECK(folder.demcal({"check", "study"}).status == 0);
  const nlohmann::json report = report_of(folder, 0);
  CHECK(report["warnings"].empty());
  CHECK(report["findings"].empty());
  CHECK(report["cases"][0]["support"]["supported"] == true);
  CHECK(report["cases"][0]["doubt"].is_null());
  CHECK_THAT(folder.read("out/next-runs.csv"), Contains("\nfriction,cohesion,speed\n"));
}

TEST_CASE("a run that all others contradict is named by fit, sample and calibrate, with the result without it",
          "[slow]") {
  const Folder folder;
  std::vector<Run> runs = runs_of(60);
  runs[22].torque *= 10.0;
  write_study(folder, runs);
  for (const char* command : {"fit", "sample"}) {
    CHECK_THAT(folder.says({command, "study", "--out", "out"}, 2),
               Contains("runs.csv:24 (") && Contains("leave it out: [training] leave_out"));
  }
  const nlohmann::json report = report_of(folder, 2);
  CHECK_THAT(report["warnings"][0].get<std::string>(), Contains("runs.csv:24"));
  CHECK(report["surrogates"][0]["outlying_runs"][0]["place"] == "runs.csv:24");
  const nlohmann::json& powder = report["cases"][0];
  for (const auto& parameter : powder["parameters"]) {
    CHECK(parameter["verdict"] == "not identified");
    CHECK(parameter["usable"] == false);
  }
  REQUIRE(powder["without"]["places"] == nlohmann::json::array({"runs.csv:24"}));
  CHECK(std::abs(powder["without"]["mean"][0].get<double>() - 0.4) < 3.0 * powder["without"]["sd"][0].get<double>());
  CHECK_THAT(report["terminal"].get<std::string>(), Contains("Without runs.csv:24"));
  CHECK_THAT(folder.read("out/report.html"), Contains("Without runs.csv:24"));

  // What the message says to do gives that result, without a warning.
  write_study(folder, runs, 0.4, "leave_out = [\"runs.csv:24\"]\n");
  const nlohmann::json again = report_of(folder, 0);
  CHECK(again["surrogates"][0]["runs"] == 59);
  CHECK(again["cases"][0]["parameters"][0]["mean"].get<double>() ==
        Approx(powder["without"]["mean"][0].get<double>()).epsilon(0.01));
}

TEST_CASE("an answer beyond the runs is no answer: first line, verdict, status and points to run", "[slow]") {
  const Folder folder;
  std::vector<Run> runs = runs_of(60);
  for (Run& run : runs) {
    run.friction = 0.1 + 0.55 * (run.friction - 0.1);
    run.torque = torque(run.friction, run.cohesion, run.speed);
  }
  write_study(folder, runs, 0.75);
  const nlohmann::json report = report_of(folder, 2);
  const nlohmann::json& powder = report["cases"][0];
  CHECK(powder["support"]["supported"] == false);
  CHECK_THAT(report["warnings"].dump(), Contains("beyond the runs' friction"));
  for (const auto& parameter : powder["parameters"]) CHECK(parameter["verdict"] != "identified");
  CHECK_THAT(powder["remedy"].get<std::string>(), Catch::StartsWith("Run ") && Contains("next-runs.csv"));
  CHECK(folder.demcal({"sample", "study", "--out", "out"}).status == 2);
}

TEST_CASE("what the study, its runs and its measurements contradict is refused by check and by all that fit") {
  const Folder folder;
  std::vector<Run> runs = runs_of(30);
  for (Run& run : runs) run.speed = 150.0;
  write_study(folder, runs);
  for (const char* command : {"check", "fit", "sample", "calibrate"}) {
    CHECK_THAT(folder.says({command, "study", "--out", "out"}, 78), Contains("every run of this material has 150 rpm"));
  }
}

TEST_CASE("check and calibrate name copies, failed runs and a column that nothing reads") {
  const Folder folder;
  std::vector<Run> runs = runs_of(30);
  runs.push_back(runs[3]);
  runs[9].torque = runs[9].error = 0.0;
  write_study(folder, runs);
  const auto outcome = folder.demcal({"check", "study", "--json"});
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.err, Contains("runs.csv:32: 1 of 30 runs are copies of others") &&
                              Contains("runs.csv:11: 1 row gives a value of torque exactly 0"));
  CHECK(nlohmann::json::parse(outcome.out)["rows"] == 29);
}

TEST_CASE("design for another code's runs gives further points, as many as are asked for") {
  const Folder folder;
  folder.study("other-code");
  const auto outcome = folder.demcal({"design", "study", "--out", "out", "--runs", "20", "--json"});
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  CHECK(nlohmann::json::parse(outcome.out)["points"] == 20);
  CHECK_THAT(folder.read("out/design.csv"),
             Contains("\n# units: friction [1], cohesion [mJ/m2], speed [rpm]\nfriction,cohesion,speed\n"));
  CHECK(nlohmann::json::parse(folder.demcal({"design", "study", "--out", "out", "--json"}).out)["points"] == 16);
}

TEST_CASE("training at the posterior needs a posterior") {
  const Folder folder;
  folder.study("quick");
  CHECK_THAT(folder.says({"train", "study", "--out", "out", "--at-posterior", "3"}, 66),
             Contains("next-runs.csv") && Contains("run demcal calibrate first"));
}
