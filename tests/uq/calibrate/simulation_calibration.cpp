// Is the posterior as wide as it claims, and would the check notice if it were not?
#include "uq/calibrate/simulation_calibration.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "data/study_file.hpp"
#include "tests/uq/closed_form.hpp"
#include "uq/calibrate/calibrate.hpp"
#include "uq/posterior/posterior.hpp"

using namespace closed_form;

namespace {

const Eigen::VectorXd six = Eigen::VectorXd::LinSpaced(6, 0.0, 1.0);

uq::CaseModel two_terms() {
  const Formula formula = [](const Eigen::VectorXd& p, double x) { return p[0] * (1.0 + x) + p[1] * (1.0 - x * x); };
  return make_synthetic({{"a"}, {"b"}}, formula, six, Eigen::Vector2d(0.4, 0.6), 0.05, 1);
}

struct Calibrated {
  data::Study study;
  std::vector<uq::Emulator> emulators;
};

Calibrated other_code() {
  const data::StudyFile file = data::StudyFile::open(DEMCAL_SOURCE_DIR "/data/other-code");
  Calibrated found{.study = data::read_study(file), .emulators = {}};
  const data::RunTable table = data::read_table(found.study.training.table, found.study).table;
  found.emulators = uq::emulators_of(uq::fit_surrogates(found.study, table));
  return found;
}

/// Ranks of all unknowns are uniform, with a gain, the noise's scale and a common error beside the parameters.
void check_nuisances(int replicates) {
  Calibrated input = other_code();
  data::CalibrationCase& powder = input.study.cases[0];
  data::Parameter gain{.name = "gain", .target = "gain", .low = 0.88, .high = 1.12};
  gain.prior = {.kind = data::PriorKind::normal, .low = 0.88, .high = 1.12, .mean = 1.0, .sd = 0.02};
  data::Parameter noise{.name = "noise", .target = "noise", .low = 0.1, .high = 10.0, .scale = data::Scale::log};
  noise.prior = {.kind = data::PriorKind::log_normal, .low = 0.1, .high = 10.0, .mean = 1.0, .sd = 0.5};
  powder.nuisances = {{data::NuisanceKind::gain, 0, gain}, {data::NuisanceKind::noise_scale, {}, noise}};
  input.study.observations[0].common_errors = {{0, {.absolute = 0.0, .relative = 0.02}}};
  const uq::CaseModel model = uq::build_case(input.study, input.emulators, 0);
  REQUIRE(model.dimension() == 4);
  const uq::SimulationCalibration found = uq::simulate_calibration(model, {.replicates = replicates, .seed = 100});
  CHECK(found.failed <= 1);
  for (const auto& one : found.unknowns) {
    INFO(one.name << " coverage " << one.coverage);
    CHECK(one.inside);
  }
}

}  // namespace

TEST_CASE("uniform ranks stay inside the simultaneous bands as often as stated, and shifted or narrow ones do not",
          "[uq]") {
  const uq::RankBands bands = uq::rank_bands(200, 99, 0.95, 1);
  data::RandomStream random(7, data::Purpose::test);
  int inside = 0;
  const int sets = 1000;
  for (int i = 0; i < sets; ++i) {
    std::vector<int> ranks(200);
    for (int& rank : ranks) rank = static_cast<int>(random.uniform() * 100.0);
    inside += uq::inside_bands(ranks, 99, bands) ? 1 : 0;
  }
  CHECK(inside / static_cast<double>(sets) == Approx(0.95).margin(0.025));
  std::vector<int> shifted(200), narrow(200);
  for (int i = 0; i < 200; ++i) {
    shifted[i] = static_cast<int>(100.0 * std::pow((i + 0.5) / 200.0, 1.5));
    // A posterior 1.5 times too narrow: truths are too often in its tails.
    const double z = 1.5 * std::sqrt(2.0) * random.normal() / std::sqrt(2.0);
    narrow[i] = std::min(99, static_cast<int>(50.0 * std::erfc(-z / std::sqrt(2.0))));
  }
  CHECK_FALSE(uq::inside_bands(shifted, 99, bands));
  CHECK_FALSE(uq::inside_bands(narrow, 99, bands));
}

TEST_CASE("the posterior of a formula is calibrated", "[uq][slow]") {
  const uq::CaseModel model = two_terms();
  const uq::SimulationCalibration right = uq::simulate_calibration(model, {.replicates = 200, .seed = 3});
  CHECK(right.failed == 0);
  CHECK(right.calibrated());
  REQUIRE(right.unknowns.size() == 2);
  for (const auto& one : right.unknowns) CHECK(std::abs(one.coverage - 0.9) < 4.0 * one.coverage_error);
  const nlohmann::json json = nlohmann::json::parse(uq::to_json_text(right));
  CHECK(json["calibrated"] == true);
  CHECK(json["unknowns"][0]["ranks"].size() == 200);
}

TEST_CASE("the surrogate's posterior is calibrated when torque functions are drawn from its process", "[uq][slow]") {
  const Calibrated input = other_code();
  const uq::CaseModel model = uq::build_case(input.study, input.emulators, 0);
  const uq::SimulationCalibration found = uq::simulate_calibration(model, {.replicates = 100, .seed = 11});
  CAPTURE(found.reasons);
  CHECK(found.failed <= 1);
  CHECK(found.calibrated());
  for (const auto& one : found.unknowns) CHECK(std::abs(one.coverage - 0.9) < 4.0 * one.coverage_error);
}

TEST_CASE("with gain, offset, noise and discrepancy unknown the posterior is still calibrated", "[uq][slow]") {
  check_nuisances(80);
}

TEST_CASE("with gain, offset, noise and discrepancy unknown ranks of 300 data sets are uniform", "[uq][weekly]") {
  check_nuisances(300);
}

TEST_CASE("90 % intervals over a thousand data sets cover 88 to 92 % of the truths", "[uq][weekly]") {
  const Calibrated input = other_code();
  const uq::CaseModel model = uq::build_case(input.study, input.emulators, 0);
  const uq::SimulationCalibration found = uq::simulate_calibration(model, {.replicates = 1000, .seed = 20110726});
  CHECK(found.failed <= 5);
  for (const auto& one : found.unknowns) {
    INFO(one.name << " coverage " << one.coverage);
    CHECK(one.coverage >= 0.88);
    CHECK(one.coverage <= 0.92);
    WARN(one.name << ": 90 % intervals cover " << 100.0 * one.coverage << " % of 1000");
  }
}
