// demcal sample: the two samplers, draws for others, and the check of the posterior's width.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "data/csv.hpp"
#include "tests/cli/program.hpp"

using Catch::Contains;
using test::Folder;
namespace fs = std::filesystem;

namespace {

const std::string study = DEMCAL_SOURCE_DIR "/data/other-code";

struct Moments {
  double mean = 0.0, sd = 0.0;
};

Moments moments(const fs::path& draws, const std::string& name) {
  const data::Csv csv = data::read_csv(draws.string());
  const std::size_t column = csv.column(name);
  double sum = 0.0, squares = 0.0;
  for (const auto& row : csv.rows) {
    const double value = csv.number(row, column);
    sum += value;
    squares += value * value;
  }
  const double count = static_cast<double>(csv.rows.size()), mean = sum / count;
  return {mean, std::sqrt(squares / count - mean * mean)};
}

}  // namespace

TEST_CASE("either sampler that a user asks for draws from the same posterior", "[slow]") {
  const Folder folder;
  for (const std::string sampler : {"mixture", "nuts"}) {
    const auto outcome = folder.demcal({"sample", study, "--out", sampler, "--sampler", sampler, "--csv", "--json"});
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK(nlohmann::json::parse(outcome.out)["cases"][0]["converged"] == true);
    CHECK(fs::exists(folder.path / sampler / "posterior-powder.nc"));
  }
  for (const char* name : {"friction", "cohesion"}) {
    const Moments mixture = moments(folder.path / "mixture" / "posterior-powder.csv", name);
    const Moments nuts = moments(folder.path / "nuts" / "posterior-powder.csv", name);
    // Both have at least 1,000 independent draws: 1 / sqrt(1000) sd each.
    CHECK(std::abs(mixture.mean - nuts.mean) < 4.5 * std::sqrt(2.0 / 1000.0) * mixture.sd);
    CHECK(nuts.sd == Approx(mixture.sd).epsilon(0.1));
  }
  CHECK(folder.read("mixture/posterior-powder.csv") != folder.read("nuts/posterior-powder.csv"));
}

TEST_CASE("the width of the posterior is checked for every parameter, in words, as JSON and as a figure", "[slow]") {
  const Folder folder;
  const auto outcome = folder.demcal({"sample", study, "--sbc", "20", "--seed", "4", "--json"});
  INFO(outcome.err);
  const nlohmann::json told = nlohmann::json::parse(outcome.out)["cases"][0];
  CHECK(outcome.status == (told["calibrated"].get<bool>() ? 0 : 2));
  const nlohmann::json found = nlohmann::json::parse(folder.read("other-code-results/sbc-powder.json"));
  CHECK(found["calibrated"] == told["calibrated"]);
  CHECK(found["replicates"] == 20);
  REQUIRE(found["unknowns"].size() == 2);
  for (const auto& one : found["unknowns"]) {
    CHECK(one["coverage_error"].get<double>() == Approx(std::sqrt(0.9 * 0.1 / 20.0)));
    CHECK(std::abs(one["coverage"].get<double>() - 0.9) < 4.0 * one["coverage_error"].get<double>());
    CHECK(one["ranks"].size() == 20);
    CHECK_THAT(outcome.err, Contains("powder: " + one["name"].get<std::string>() + ": ranks inside the 95 % bands") ||
                                Contains("OUTSIDE"));
  }
  CHECK_THAT(outcome.err, Contains("90 % intervals cover") && Contains("+- 6.7 %"));
  CHECK(fs::exists(folder.path / "other-code-results" / "figures" / "sbc-powder.svg"));
  CHECK_FALSE(fs::exists(folder.path / "other-code-results" / "posterior-powder.nc"));
  // The same seed, the same ranks.
  REQUIRE(folder.demcal({"sample", study, "--sbc", "20", "--seed", "4", "--out", "again", "--quiet"}).status ==
          outcome.status);
  CHECK(folder.read("again/sbc-powder.json") == folder.read("other-code-results/sbc-powder.json"));
}
