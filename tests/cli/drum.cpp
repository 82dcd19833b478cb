// The studies of drums: what another group's table determines, what another's model cannot reproduce, and one on
// pictures of a real powder.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using Catch::Matchers::Contains;
using test::Folder;

TEST_CASE("a table of another code with thousands of rows and gaps is checked in one breath, without a warning a row") {
  const Folder folder;
  const auto outcome = folder.demcal({"check", DEMCAL_SOURCE_DIR "/data/drum-table"});
  INFO(outcome.err);
  CHECK(outcome.status == 2);  // the gaps are warned of
  CHECK_THAT(outcome.out + outcome.err,
             Contains("4371 training runs") && Contains("and 549 more: angle_upper: is empty"));
  CHECK((outcome.out + outcome.err).size() < 2000);
}

TEST_CASE("a table of another code: the intervals hold the design that was left out, and angles narrow them",
          "[slow]") {
  const Folder folder;
  const auto outcome = folder.demcal(
      {"calibrate", DEMCAL_SOURCE_DIR "/data/drum-table", "--no-scan", "--json", "--set", "surrogate.runs_most=200"});
  INFO(outcome.err);
  REQUIRE((outcome.status == 0 || outcome.status == 2));
  const nlohmann::json report = nlohmann::json::parse(outcome.out);
  const std::map<std::string, double> truth{
      {"sliding", 0.5}, {"rolling", 0.1}, {"cohesion", 30000.0}, {"restitution", 0.5}};
  std::map<std::string, double> sd[2];
  for (int c = 0; c < 2; ++c)
    for (const auto& parameter : report["cases"][c]["parameters"]) {
      const std::string name = parameter["name"];
      sd[c][name] = parameter["sd"];
      INFO(report["cases"][c]["name"] << ' ' << name);
      CHECK(std::abs(parameter["mean"].get<double>() - truth.at(name)) < 3.0 * sd[c][name]);
      if (c == 0) CHECK(parameter["verdict"] != "identified");  // the torque alone leaves all of them traded
    }
  for (const char* name : {"sliding", "rolling", "cohesion"}) CHECK(sd[1].at(name) < 0.9 * sd[0].at(name));
}

TEST_CASE("the study on pictures of a real powder can be run, and keeps two speeds for the prediction") {
  const Folder folder;
  const auto outcome = folder.demcal({"check", DEMCAL_SOURCE_DIR "/data/drum-mcc"});
  INFO(outcome.out << outcome.err);
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.out + outcome.err,
             Contains("2 observation sets, 2 cases, 15 training runs") && Contains("no problems"));
}

TEST_CASE("a model that cannot reproduce its data is refused, and the datum is named", "[slow]") {
  const Folder folder;
  const auto outcome = folder.demcal({"calibrate", DEMCAL_SOURCE_DIR "/data/hydrogel", "--no-scan", "--json"});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  const nlohmann::json report = nlohmann::json::parse(outcome.out);
  for (const auto& parameter : report["cases"][0]["parameters"]) CHECK(parameter["verdict"] == "model does not fit");
  const std::string finding = report["cases"][0]["finding"];
  CHECK_THAT(finding, Contains("Farthest off: cohesion_index 2.25"));
}
