// Diagnostics against R's posterior package 1.4.0 on the same draws: tests/reference/posterior-diagnostics.R made the
// values.
#include "uq/infer/diagnostics.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "data/random.hpp"

TEST_CASE("R-hat, effective sample sizes and Monte Carlo errors agree with R's posterior package to 1e-9", "[uq]") {
  std::ifstream file(DEMCAL_SOURCE_DIR "/tests/reference/posterior-diagnostics.json");
  const nlohmann::json reference = nlohmann::json::parse(file);
  REQUIRE(reference["cases"].size() == 8);
  for (const auto& item : reference["cases"]) {
    INFO(item["name"]);
    const std::vector<double> values = item["draws"];
    const Eigen::Map<const Eigen::MatrixXd> mapped(values.data(), item["iterations"], item["chains"]);
    const Eigen::MatrixXd draws = mapped;
    CHECK(uq::rank_rhat(draws) == Approx(item["rhat"].get<double>()).epsilon(1e-9));
    CHECK(uq::bulk_ess(draws) == Approx(item["ess_bulk"].get<double>()).epsilon(1e-9));
    CHECK(uq::tail_ess(draws) == Approx(item["ess_tail"].get<double>()).epsilon(1e-9));
    CHECK(uq::mean_ess(draws) == Approx(item["ess_mean"].get<double>()).epsilon(1e-9));
    CHECK(uq::mean_mcse(draws) == Approx(item["mcse_mean"].get<double>()).epsilon(1e-9));
  }
}

TEST_CASE("ranks make R-hat and bulk ESS blind to a monotone change of scale", "[uq]") {
  data::RandomStream random(5, data::Purpose::test);
  Eigen::MatrixXd draws(200, 4);
  for (double& value : draws.reshaped()) value = random.normal();
  const Eigen::MatrixXd stretched = draws.array().exp();
  CHECK(uq::bulk_ess(stretched) == uq::bulk_ess(draws));
  CHECK(uq::tail_ess(stretched) == uq::tail_ess(draws));
}

TEST_CASE("an effective size that one tail does not have is nobody's, whichever tail", "[uq]") {
  // R's posterior gives NA where over 5 % of the draws are tied at a bound.
  data::RandomStream random(6, data::Purpose::test);
  Eigen::MatrixXd draws(500, 4);
  for (double& value : draws.reshaped()) value = random.uniform();
  const Eigen::MatrixXd at_high = draws.cwiseMin(0.9), at_low = draws.cwiseMax(0.1);
  CHECK(std::isnan(uq::tail_ess(at_high)));
  CHECK(std::isnan(uq::tail_ess(-at_high)) == std::isnan(uq::tail_ess(at_low)));
  CHECK(std::isfinite(uq::tail_ess(draws)));
}

TEST_CASE("a chain that never moves is not called converged", "[uq]") {
  const Eigen::MatrixXd stuck = Eigen::MatrixXd::Constant(100, 4, 1.0);
  CHECK(std::isnan(uq::rank_rhat(stuck)));
  CHECK(std::isnan(uq::bulk_ess(stuck)));
  Eigen::MatrixXd apart(100, 4);
  data::RandomStream random(6, data::Purpose::test);
  for (Eigen::Index c = 0; c < 4; ++c)
    for (Eigen::Index i = 0; i < 100; ++i) apart(i, c) = 10.0 * static_cast<double>(c) + random.normal();
  CHECK(uq::rank_rhat(apart) > 2.0);
  CHECK(uq::bulk_ess(apart) < 10.0);
}

TEST_CASE("quantiles interpolate between order statistics", "[uq]") {
  const Eigen::VectorXd values = Eigen::Vector4d(4.0, 1.0, 3.0, 2.0);
  CHECK(uq::quantile(values, 0.0) == 1.0);
  CHECK(uq::quantile(values, 0.5) == 2.5);
  CHECK(uq::quantile(values, 1.0) == 4.0);
}
