// Bands of a discrepancy against kriging by hand: two readings one range of the control apart, their covariance a
// 2 x 2 matrix, the correlation that of Rasmussen and Williams, Gaussian Processes for Machine Learning, eq. 4.17
// (Matern, nu = 5/2).
#include "uq/posterior/discrepancy.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/temporary.hpp"
#include "tests/uq/formula_study.hpp"
#include "uq/posterior/posterior.hpp"

using namespace uq;

namespace {

constexpr double own = 0.02;
const formula::Pair flat{[](double a, double, double) { return a; }, formula::angle};

data::Study study_with_discrepancy(const TemporaryFolder& folder) {
  folder.write("bench.csv", "speed,torque,torque_se\n0,1.1,0.02\n1,0.8,0.02\n");
  const data::StudyFile file = data::StudyFile::open(folder.write(
      "study.toml",
      "[study]\nname = \"s\"\nseed = 5\n[parameters.a]\nlow = 0\nhigh = 1\n[parameters.b]\nlow = 0\nhigh = 1\n"
      "[training]\ntable = \"runs.csv\"\n[outputs.torque]\n[controls.speed]\nlow = 0\nhigh = 1\n"
      "[[observe]]\nname = \"bench\"\nfile = \"bench.csv\"\n"
      "[[calibrate]]\nname = \"powder\"\nobserve = [\"bench\"]\nfree = [\"a\", \"b\"]\n"
      "discrepancy = { sd = 0.3, length = 0.5 }\n"));
  data::Study study = data::read_study(file);
  file.finish();
  return study;
}

double matern(double distance, double length) {
  const double r = std::sqrt(5.0) * distance / length;
  return (1.0 + r + r * r / 3.0) * std::exp(-r);
}

}  // namespace

TEST_CASE("a discrepancy's band is the kriging of what the model leaves", "[uq]") {
  const TemporaryFolder folder;
  const data::Study study = study_with_discrepancy(folder);
  const CaseModel model = build_case(study, formula::emulators(0.0, flat), 0);
  REQUIRE(model.dimension() == 4);
  Eigen::VectorXd u(4);
  u << 0.9, 0.5, 0.4, 0.3;
  double sd = 0.0, length = 0.0;
  for (Eigen::Index k = 0; k < 4; ++k) {
    const Unknown& unknown = model.unknowns[k];
    if (unknown.nuisance == data::NuisanceKind::discrepancy_sd) sd = unknown.value(u[k]);
    if (unknown.nuisance == data::NuisanceKind::discrepancy_length) length = unknown.value(u[k]);
  }
  REQUIRE(sd > 0.0);
  REQUIRE(length > 0.0);
  const auto bands = discrepancy_bands(study, model, u.transpose().replicate(300, 1), 1);
  REQUIRE(bands.size() == 1);

  // sd is a share of the readings' root mean square.
  const double variance = sd * sd * 0.5 * (1.1 * 1.1 + 0.8 * 0.8), between = variance * matern(1.0, length);
  const double on = variance + own * own, determinant = on * on - between * between;
  const double left[2] = {1.1 - 0.9, 0.8 - 0.9};
  CHECK(bands[0].share == Approx(variance / on));
  for (std::size_t j = 0; j < bands[0].x.size(); ++j) {
    const double k[2] = {variance * matern(bands[0].x[j], length), variance * matern(1.0 - bands[0].x[j], length)};
    const auto solved = [&](double first, double second) {  // k' S^-1 (first, second)'
      return (k[0] * (on * first - between * second) + k[1] * (on * second - between * first)) / determinant;
    };
    const double mean = solved(left[0], left[1]), spread = std::sqrt(variance - solved(k[0], k[1]));
    INFO("x " << bands[0].x[j]);
    CHECK(std::abs(bands[0].mean[j] - mean) < 4.0 * spread / std::sqrt(300.0));
    // A quantile of 300 draws has a standard error of 0.122 sd at 5 and 95 %.
    CHECK(std::abs(bands[0].q05[j] - (mean - 1.6449 * spread)) < 4.0 * 0.122 * spread);
    CHECK(std::abs(bands[0].q95[j] - (mean + 1.6449 * spread)) < 4.0 * 0.122 * spread);
  }
}
