// Training around the posterior and its confirmation, with a formula in the place of another code (data/other-code: the
// formula that made its table, which no surrogate knows), and with the DEM.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"
#include "tests/cli/table.hpp"

namespace fs = std::filesystem;

namespace {

using test::Folder;
using test::number;
using test::read_rows;
using test::Row;

/// mN m, of the table's header; `wrong` multiplies it above 150 rpm.
double torque(double friction, double cohesion, double speed, double wrong) {
  const double s = (speed - 175.0) / 125.0, c = cohesion / 6.0;
  return (speed > 150.0 ? wrong : 1.0) * 8.0 * std::sqrt((1.0 + c) * friction / 0.4) * (1.0 + 0.12 * s - 0.04 * s * c);
}

/// Makes the listed runs and adds them to the study's table; how many.
std::size_t run_listed(const fs::path& list, const fs::path& table, double wrong = 1.0) {
  const std::vector<Row> rows = read_rows(list);
  std::ofstream file(table, std::ios::app);
  for (const Row& row : rows) {
    const double value = torque(number(row, "friction"), number(row, "cohesion"), number(row, "speed"), wrong);
    file << row.at("friction") << "," << row.at("cohesion") << "," << row.at("speed") << "," << value << ","
         << 0.01 * value << "\n";
  }
  return rows.size();
}

/// A copy of data/other-code with the first `runs` rows of its table.
fs::path few_runs(const Folder& folder, std::size_t runs) {
  const fs::path study = folder.study("other-code");
  const std::vector<Row> all = read_rows(study / "runs.csv");
  std::ofstream file(study / "runs.csv");
  file << "friction,cohesion,speed,torque,torque_se\n";
  for (std::size_t i = 0; i < runs; ++i)
    file << all[i].at("friction") << "," << all[i].at("cohesion") << "," << all[i].at("speed") << ","
         << all[i].at("torque") << "," << all[i].at("torque_se") << "\n";
  return study;
}

}  // namespace

TEST_CASE("points for another code are listed until the surrogate hides little of the posterior", "[slow]") {
  const Folder folder;
  const fs::path study = few_runs(folder, 10);
  double before = 1.0;
  bool enough = false;
  for (int round = 0; round < 8 && !enough; ++round) {
    const auto done =
        folder.demcal({"train", study.string(), "--until", "posterior", "--share", "0.04", "--runs", "6", "--json"});
    INFO(done.err);
    REQUIRE(done.status == 0);
    const auto json = nlohmann::json::parse(done.out);
    const double share = json["cases"][0]["surrogate_share"];
    if (round == 0) before = share;
    enough = json["points"] == 0;
    CHECK(enough == (share <= 0.04));
    if (!enough) CHECK(run_listed(folder.path / "other-code-results" / "next-runs.csv", study / "runs.csv") == 6);
  }
  CHECK(before > 0.04);
  CHECK(enough);
}

TEST_CASE("a posterior is confirmed by another code's runs, or is not and says where", "[slow]") {
  const double wrong = GENERATE(1.0, 1.25);
  const Folder folder;
  const fs::path study = few_runs(folder, 40);
  const std::vector<std::string> arguments{"calibrate", study.string(), "--verify", "2", "--rounds", "1", "--json"};
  const auto asked = folder.demcal(arguments);
  INFO(asked.err);
  CHECK(asked.status == 0);
  CHECK(asked.err.find("6 points to run with your code") != std::string::npos);
  CHECK(run_listed(folder.path / "other-code-results" / "verify-runs.csv", study / "runs.csv", wrong) == 6);
  const auto told = folder.demcal(arguments);
  INFO(told.err);
  const auto verification = nlohmann::json::parse(told.out)["cases"][0]["verification"];
  REQUIRE(verification.size() == 1);
  CHECK(verification[0]["runs"] == 6);
  CHECK(verification[0]["points"] == 2);
  CHECK(verification[0]["agrees"] == (wrong == 1.0));
  CHECK(told.status == (wrong == 1.0 ? 0 : 2));
  const std::string page = folder.read("other-code-results/report.html");
  CHECK(page.find(wrong == 1.0 ? "Confirmed by 6 runs of your code at 2 points" : "Not confirmed by 6 runs") !=
        std::string::npos);
  // The runs have joined the table: the list is gone.
  CHECK_FALSE(fs::exists(folder.path / "other-code-results" / "verify-runs.csv"));
}

TEST_CASE("training around the posterior is interrupted, goes on, and makes the runs of one that was not", "[slow]") {
  test::check_interruption_changes_nothing(test::with_settings({"--until", "posterior", "--runs", "18", "--jobs", "2"},
                                                               {"run.longest=\"0.4 s\"", "run.start_up_turns=0.25",
                                                                "training.unsteady=\"use\"", "run.shortest=\"0.1 s\""}),
                                           {"friction", "hamaker", "rpm", "seed"}, 18);
}
