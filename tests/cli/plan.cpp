// demcal plan: what it says and writes, and what it refuses.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.hpp"

using Catch::Contains;
using test::Folder;
namespace fs = std::filesystem;

namespace {

const std::string study = DEMCAL_SOURCE_DIR "/data/other-code";

}  // namespace

TEST_CASE("a plan ranks readings, says what they are expected to give, and stands in the report") {
  const Folder folder;
  REQUIRE(folder.demcal({"calibrate", study, "--out", "o"}).status != 70);
  const auto outcome = folder.demcal({"plan", study, "--out", "o", "--about", "cohesion", "--json"});
  INFO(outcome.err);
  REQUIRE((outcome.status == 0 || outcome.status == 2));
  const nlohmann::json told = nlohmann::json::parse(outcome.out), plan = told["plans"][0];
  CHECK(plan["about"] == "cohesion");
  CHECK(plan["candidates"].size() >= 9);
  double last = 1e300;
  for (const auto& candidate : plan["candidates"])
    for (const auto& parameter : candidate["parameters"])
      if (parameter["name"] == "cohesion") {
        const double worth = parameter["information"].get<double>() / candidate["cost"].get<double>();
        CHECK(worth <= last);
        last = worth;
        CHECK(parameter["sd_after"].get<double>() <= 1.05 * parameter["sd_now"].get<double>());
      }
  CHECK(fs::exists(folder.path / "o" / "plan.json"));
  CHECK_THAT(folder.read("o/report.html"), Contains("What to measure next"));
  CHECK(nlohmann::json::parse(folder.read("o/report.json"))["plan"].size() == 1);
  CHECK_THAT(outcome.err, Contains("nats about cohesion"));
  // A calibration of the same inputs keeps it; one of others says that it does not.
  REQUIRE(folder.demcal({"calibrate", study, "--out", "o", "--no-scan"}).status != 70);
  CHECK(nlohmann::json::parse(folder.read("o/report.json"))["plan"][0]["about"] == "cohesion");
  const auto other =
      folder.demcal({"calibrate", study, "--out", "o", "--no-scan", "--set", "parameters.friction.low=0.2"});
  CHECK_THAT(other.err, Contains("the plan of case powder is left out of the report, since these have changed"));
  CHECK(nlohmann::json::parse(folder.read("o/report.json"))["plan"].empty());
}

TEST_CASE("a plan takes candidates, errors and costs from the study") {
  const Folder folder;
  const std::string place = folder.study("other-code").string(), toml = "study/study.toml";
  folder.write(
      toml,
      folder.read(toml) +
          "\n[plan]\nabout = \"friction\"\ncost_unit = \"h\"\n[[plan.candidates]]\nname = \"fast\"\n"
          "settings = { speed = [\"250 rpm\", \"290 rpm\"] }\nerror = \"1 %\"\ncost = 2\n"
          "[[plan.candidates]]\nname = \"both\"\nsettings = { speed = [\"60 rpm\", \"290 rpm\"] }\ntogether = true\n");
  const auto outcome = folder.demcal({"plan", place, "--out", "o", "--json"});
  INFO(outcome.err);
  REQUIRE((outcome.status == 0 || outcome.status == 2));
  const nlohmann::json plan = nlohmann::json::parse(outcome.out)["plans"][0];
  CHECK(plan["about"] == "friction");
  REQUIRE(plan["candidates"].size() == 3);
  int of_two = 0;
  for (const auto& candidate : plan["candidates"]) of_two += candidate["settings"].size() == 2 ? 1 : 0;
  CHECK(of_two == 1);
}

TEST_CASE("before any measurement nothing is measured again") {
  const Folder folder;
  for (const bool prior : {false, true}) {
    std::vector<std::string> command{"plan", study, "--out", "o", "--json"};
    if (prior) command.push_back("--prior");
    const nlohmann::json plan = nlohmann::json::parse(folder.demcal(command).out)["plans"][0];
    bool again = false;
    for (const auto& candidate : plan["candidates"]) again = again || candidate["kind"] == "repeat";
    CHECK(again == !prior);
  }
}

TEST_CASE("a plan on the prior needs neither measurements nor a case") {
  const Folder folder;
  const std::string place = folder.study("other-code").string(), file = "study/study.toml", toml = folder.read(file);
  const std::string bare = toml.substr(0, toml.find("[[observe]]"));
  for (const char* cases : {"", "[[calibrate]]\nname = \"powder\"\nfree = [\"friction\", \"cohesion\"]\n"}) {
    folder.write(file, bare + cases);
    const auto outcome = folder.demcal({"plan", place, "--out", "o", "--prior", "--about", "friction", "--json"});
    INFO(outcome.err);
    REQUIRE((outcome.status == 0 || outcome.status == 2));
    const nlohmann::json plan = nlohmann::json::parse(outcome.out)["plans"][0];
    CHECK(plan["candidates"].size() >= 5);
    CHECK(plan["candidates"][0]["parameters"][0]["information"].get<double>() > 0.1);
    for (const char* command : {"plan", "calibrate", "sample"}) {
      CHECK_THAT(folder.says({command, place, "--out", "o"}, 78), Contains("[[observe]]"));
    }
    CHECK_THAT(folder.demcal({"plan", place, "--out", "o"}).err, Contains("plan --prior"));
    CHECK(folder.demcal({"fit", place, "--out", "o"}).status == 0);
  }
  folder.write(file,
               toml + "\n[[calibrate]]\nname = \"other\"\nmaterial = \"sand\"\nfree = [\"friction\", \"cohesion\"]\n");
  CHECK_THAT(folder.says({"check", place}, 78), Contains("sand"));
}

TEST_CASE("a plan refuses what cannot be planned, with place and remedy") {
  const Folder folder;
  CHECK(folder.demcal({"plan", study, "--about", "no-such"}).status == 64);
  CHECK(folder.demcal({"plan", study, "--case", "no-such"}).status == 64);
  CHECK(folder.demcal({"plan", study, "--budget", "nan"}).status == 64);
  const std::string place = folder.study("other-code").string(), file = "study/study.toml", toml = folder.read(file);
  for (const auto& [entry, what] : std::vector<std::pair<std::string, std::string>>{
           {"settings = { speed = \"900 rpm\" }", "speed"},
           {"outputs = [\"angle\"]", "angle"},
           {"cots = 1", "cots"},
           {"outputs = [\"torque\", \"torque\"]", "'torque' is named twice (name it once"},
           {"meter = \"cell\"", "'cell' has read none of the study's measurements"},
           {"name = \"a\"\n[[plan.candidates]]\nname = \"a\"", "another candidate"}}) {
    folder.write(file, toml + "\n[plan]\n[[plan.candidates]]\n" + entry + "\n");
    const auto outcome = folder.demcal({"plan", place, "--out", "o"});
    INFO(entry << ": " << outcome.err);
    CHECK(outcome.status == 78);
    CHECK_THAT(outcome.err, Contains(what));
    const auto checked = folder.demcal({"check", place});
    CHECK(checked.status != 0);
    CHECK_THAT(checked.err, Contains(what));
  }
}

TEST_CASE("another rig is a candidate as another material with runs of its own, and ranks by what it would part") {
  const Folder folder;
  const auto outcome =
      folder.demcal({"plan", DEMCAL_SOURCE_DIR "/tests/cli/cases/another-rig", "--out", "o", "--json"});
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  const nlohmann::json plan = nlohmann::json::parse(outcome.out)["plans"][0];
  REQUIRE(plan["candidates"].size() == 3);
  const nlohmann::json& first = plan["candidates"][0];
  CHECK(first["name"] == "drum");
  CHECK(first["material"] == "drum");
  for (const auto& candidate : plan["candidates"])
    for (const auto& parameter : candidate["parameters"]) {
      if (parameter["name"] != "friction") continue;
      // The drum's torque hangs on friction almost alone; the slice's on a product with cohesion that is known already.
      const bool drum = candidate["name"] == "drum";
      CHECK((parameter["information"].get<double>() > 0.5) == drum);
      // Near a cohesion of 0 or 10 mJ/m2 its range ends what friction can be, until many readings narrow that. Drum
      // readings drawn from the closed form (runs.csv), each calibrated: 17 of 30 call friction identified.
      double identified = 0.0;
      for (const auto& word : parameter["words"])
        if (word["verdict"] == "identified") identified = word["probability"];
      if (drum) CHECK(identified == Approx(17.0 / 30.0).margin(0.18));
      if (!drum) CHECK_THAT(parameter["floor"].get<std::string>(), Contains("do not part"));
    }
}

TEST_CASE("results of other data than are there now are told so, and no plan joins them", "[slow]") {
  const Folder folder;
  const std::string place = folder.study("other-code").string();
  REQUIRE(folder.demcal({"calibrate", place, "--out", "o", "--no-scan"}).status == 0);
  CHECK(folder.demcal({"report", place, "--out", "o"}).status == 0);
  const std::string before = folder.read("o/report.json");
  folder.replace("study/bench.csv", "11.2418", "12.2418");
  CHECK_THAT(folder.says({"report", place, "--out", "o"}, 2), Contains("Changed since: observations bench"));
  CHECK_THAT(folder.read("o/report.html"), Contains("Changed since: observations bench"));
  const auto planned = folder.demcal({"plan", place, "--out", "o"});
  CHECK(planned.status == 2);
  CHECK_THAT(planned.err, Contains("this plan is not put into it"));
  CHECK(folder.read("o/report.json") == before);
}

TEST_CASE("a plan on a posterior that no run supports says so", "[slow]") {
  const Folder folder;
  const std::string place = folder.study("other-code").string();
  // Of the runs, those of a friction below 0.45; the posterior goes on to 0.6.
  std::istringstream rows(folder.read("study/runs.csv"));
  std::string kept;
  for (std::string line; std::getline(rows, line);)
    if (line.empty() || !std::isdigit(line.front()) || std::stod(line) < 0.45) kept += line + "\n";
  folder.write("study/runs.csv", kept);
  const auto planned = folder.demcal({"plan", place, "--out", "o"});
  CHECK(planned.status == 2);
  CHECK_THAT(planned.err, Contains("where no run speaks") && Contains("make runs there first"));
}

TEST_CASE("a calibration that is interrupted ends with its status and a line that says so") {
  const Folder folder;
  const auto outcome = folder.demcal({"calibrate", study, "--out", "o"}, "o");
  CHECK(outcome.status == 75);
  CHECK_THAT(outcome.err, Contains("interrupted; what was saved is whole"));
}
