// The commands as a user starts them.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"
#include "tests/cli/table.hpp"

using Catch::Contains;
using test::Folder;
using test::number;
using test::read_rows;
using test::Row;
namespace fs = std::filesystem;

namespace {

nlohmann::json simulate(const Folder& folder, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"simulate", DEMCAL_SOURCE_DIR "/data/developer", "--json", "--quiet", "--out",
                                     "run"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto outcome = folder.demcal(arguments);
  REQUIRE((outcome.status == 0 || outcome.status == 2));
  fs::remove_all(folder.path / "run");
  return nlohmann::json::parse(outcome.out);
}

}  // namespace

TEST_CASE("another code's runs give a whole calibration: report, results and posterior", "[slow]") {
  const Folder folder;
  const auto outcome = folder.demcal({"calibrate", DEMCAL_SOURCE_DIR "/data/other-code", "--json"});
  INFO(outcome.err);
  CHECK(outcome.status == 0);
  const nlohmann::json report = nlohmann::json::parse(outcome.out);
  CHECK(report["format"] == 1);
  CHECK(report["cases"].size() == 1);
  for (const char* file : {"report.html", "report.json", "surrogate.h5", "posterior-powder.nc"})
    CHECK(fs::exists(folder.path / "other-code-results" / file));
  CHECK(nlohmann::json::parse(folder.read("other-code-results/report.json"))["cases"] == report["cases"]);

  // The data trade friction for cohesion: the truth (its file's header) lies inside, and neither is called identified.
  const nlohmann::json& friction = report["cases"][0]["parameters"][0];
  CHECK(friction["name"] == "friction");
  CHECK(std::abs(friction["mean"].get<double>() - 0.4) < 3.0 * friction["sd"].get<double>());
  CHECK(friction["verdict"] != "identified");

  SECTION("the report is written again without sampling, and is the same page") {
    const std::string page = folder.read("other-code-results/report.html");
    fs::remove(folder.path / "other-code-results" / "report.html");
    CHECK(folder.demcal({"report", DEMCAL_SOURCE_DIR "/data/other-code"}).status == 0);
    CHECK(folder.read("other-code-results/report.html") == page);
  }
}

TEST_CASE("a new study passes its own check") {
  const Folder folder;
  CHECK(folder.demcal({"new", "my-mixer"}).status == 0);
  const auto outcome = folder.demcal({"check", "my-mixer"});
  INFO(outcome.err);
  CHECK(outcome.status == 0);
  CHECK(folder.demcal({"new", "my-mixer"}).status == 73);
  CHECK_THAT(outcome.out, Contains("no problems"));
  CHECK_THAT(outcome.err, Contains("bench.csv: 'bench' still holds the example that demcal new wrote"));
  // Beside the study the results have a folder of their own.
  CHECK(folder.demcal({"design", "my-mixer"}).status == 0);
  CHECK(fs::exists(folder.path / "my-mixer-results" / "design.csv"));
}

TEST_CASE("training runs are interrupted, go on where they were, and give the table of an uninterrupted campaign",
          "[slow]") {
  test::check_interruption_changes_nothing(
      test::with_settings({"--runs", "3"}, {"rig.fill=200", "run.longest=\"0.4 s\"", "run.start_up_turns=0.25",
                                            "training.unsteady=\"use\""}),
      {"friction", "hamaker", "rpm"}, 3);
}

TEST_CASE("shipped rows of the steady flow and an observed point come out again", "[slow]") {
  const Folder folder;
  const fs::path study = fs::path(DEMCAL_SOURCE_DIR) / "data" / "developer";
  // The quickest run without attraction and the quickest with it. Rows from before runs were tested have no state.
  std::vector<Row> quickest(2);
  for (const Row& row : read_rows(study / "training.csv")) {
    if (row.count("state") == 0 || row.at("state") != "steady") continue;
    Row& best = quickest[number(row, "hamaker") > 0.0 ? 1 : 0];
    if (best.empty() || number(row, "cpu_seconds") < number(best, "cpu_seconds")) best = row;
  }
  for (const Row& row : quickest) {
    REQUIRE_FALSE(row.empty());
    const nlohmann::json run =
        simulate(folder, {"--material", row.at("material"), "--at",
                          "friction=" + row.at("friction") + ",hamaker=" + row.at("hamaker") + ",rpm=" + row.at("rpm"),
                          "--seed", row.at("seed")});
    CHECK(run["settings"] == row.at("settings"));
    const double torque = run["outputs"]["torque"]["mean"];
    CHECK(torque == number(row, "torque"));
  }
  // An observed point is the same DEM plus noise: within three of its standard errors, run and noise together.
  const std::vector<Row> observed = read_rows(study / "observed" / "noise-3" / "zirconia-800.csv");
  const Row& point = observed.back();
  const nlohmann::json run = simulate(folder, {"--material", "zirconia-800", "--at",
                                               "friction=0.4,hamaker=0,rpm=" + point.at("rpm"), "--seed", "40911"});
  CHECK(run["state"] == "steady");
  CHECK(std::abs(run["outputs"]["torque"]["mean"].get<double>() - number(point, "torque")) <
        3.0 * number(point, "torque_se"));
}

TEST_CASE("a run with another instruction set is recorded as such and gives the same") {
  const Folder folder;
  std::vector<std::string> few =
      test::with_settings({}, {"run.start_up=\"0.004 s\"", "run.shortest=\"0.008 s\"", "run.shortest_turns=0",
                               "run.start_up_turns=0", "run.longest=\"0.01 s\"", "run.window=\"0.6 ms\""});
  nlohmann::json widest = simulate(folder, few);
  few.insert(few.end(), {"--isa", "x86-64"});
  nlohmann::json least = simulate(folder, few);
  CHECK(least["isa"] == "x86-64");
  widest.erase("isa");
  least.erase("isa");
  CHECK(widest == least);
}
