// Which rows of the run table train, and which are simulated again.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.hpp"

using Catch::Contains;
using test::Folder;

TEST_CASE("a table of another code without a row is a problem of check, too") {
  const Folder folder;
  folder.study("other-code");
  folder.write("study/runs.csv", "friction,cohesion,speed,torque,torque_se\n");
  for (const char* command : {"check", "fit", "calibrate"}) {
    const auto outcome = folder.demcal({command, "study"});
    INFO(command << ": " << outcome.err);
    CHECK(outcome.status == 66);
    CHECK_THAT(outcome.err, Contains("has no usable training runs") && Contains("demcal design"));
  }
}

TEST_CASE("runs that are not of the steady flow train nothing, by name and number, unless the study takes them") {
  const Folder folder;
  folder.study("other-code");
  std::string runs = folder.read("study/runs.csv"), marked;
  std::istringstream lines(runs);
  int row = -1;
  for (std::string line; std::getline(lines, line);) {
    if (line[0] == '#')
      marked += line;
    else if (++row == 0)
      marked += line + ",state,unreliable";
    else
      marked += line + (row == 1 ? ",drifting," : row == 2 ? ",short," : row == 3 ? ",steady," : ",,");
    marked += "\n";
  }
  folder.write("study/runs.csv", marked);
  const auto outcome = folder.demcal({"check", "study", "--json"});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(nlohmann::json::parse(outcome.out)["rows"] == row - 2);
  CHECK_THAT(outcome.err, Contains("not of the steady flow (drifting)") && Contains("not of the steady flow (short)") &&
                              Contains("run.longest") && Contains("training.unsteady"));
  const auto below = folder.demcal({"check", "study", "--set", "training.low=\"runs.csv\""});
  CHECK_THAT(below.err, Contains("of the cheaper level") && Contains("not of the steady flow (drifting)"));
  const auto taken = folder.demcal({"check", "study", "--json", "--set", "training.unsteady=\"use\""});
  CHECK(nlohmann::json::parse(taken.out)["rows"] == row);
  CHECK(taken.status == 0);
}

TEST_CASE("a range that is moved keeps the rows that were simulated") {
  const Folder folder;
  const std::string study = DEMCAL_SOURCE_DIR "/data/developer";
  const auto rows = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"check", study, "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto outcome = folder.demcal(arguments);
    INFO(outcome.err);
    CHECK_THAT(outcome.err, !Contains("under other settings"));
    return nlohmann::json::parse(outcome.out)["rows"].get<int>();
  };
  const int all = rows({});
  CHECK(all > 0);
  CHECK(rows({"--set", "parameters.friction.low=0.05"}) == all);
  CHECK(rows({"--set", "controls.rpm.low=\"40 rpm\""}) == all);
}

TEST_CASE("a fixed value of any number of digits is the same point in the design of the second start") {
  const Folder folder;
  folder.study("quick");
  folder.replace("study/study.toml", "[materials.powder]",
                 "[materials.powder]\nfixed = { hamaker = \"2.345678e-18 J\" }");
  folder.replace("study/study.toml", "free = [\"friction\", \"hamaker\"]",
                 "free = [\"friction\"]\nfixed = { hamaker = \"2.345678e-18 J\" }");
  const std::vector<std::string> arguments{"design", "study", "--json"};
  const auto first = folder.demcal(arguments), second = folder.demcal(arguments);
  INFO(second.err);
  const int points = nlohmann::json::parse(first.out)["points"];
  CHECK(points > 0);
  CHECK(nlohmann::json::parse(second.out)["points"] == points);
  CHECK_THAT(folder.read("quick-results/design.csv"), Contains("2.345678e-18"));
}

TEST_CASE("a study with a rig whose runs another code makes is not simulated") {
  const Folder folder;
  const std::string study = DEMCAL_SOURCE_DIR "/data/developer", none = "training.engine=\"none\"";
  const auto refused = folder.demcal({"train", study, "--set", none});
  CHECK(refused.status == 78);
  CHECK_THAT(refused.err, Contains("another code makes the runs") && Contains("demcal design"));
  CHECK_FALSE(std::filesystem::exists(folder.path / "developer-results" / "runs"));
  const auto checked = folder.demcal({"check", study, "--set", none});
  CHECK_THAT(checked.out, Contains("amid its ranges") && !Contains("the campaign:"));
  CHECK_THAT(folder.demcal({"check", study}).out, Contains("the campaign:"));
}
