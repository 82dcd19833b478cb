// Posteriors with closed-form answers: tests/reference/theory-facts.json.
#include "uq/posterior/posterior.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "surrogate/fit.hpp"
#include "tests/uq/closed_form.hpp"
#include "uq/infer/diagnostics.hpp"
#include "uq/infer/mixture_sampler.hpp"
#include "uq/infer/quadrature.hpp"

using namespace closed_form;

namespace {

nlohmann::json facts() {
  std::ifstream file(DEMCAL_SOURCE_DIR "/tests/reference/theory-facts.json");
  return nlohmann::json::parse(file);
}

data::Prior normal_prior(double mean, double sd) {
  data::Prior prior;
  prior.kind = data::PriorKind::normal;
  prior.mean = mean;
  prior.sd = sd;
  prior.low = mean - 12.0 * sd;
  prior.high = mean + 12.0 * sd;
  return prior;
}

/// Intercept and slope with normal priors, far from the ends of their ranges.
uq::CaseModel linear_gaussian() {
  const nlohmann::json fact = facts()["linear_gaussian"];
  const std::vector<double> y = fact["y"], m0 = fact["m0"];
  const double sd0 = std::sqrt(fact["S0"][0][0].get<double>()), sd1 = std::sqrt(fact["S0"][1][1].get<double>());
  Eigen::VectorXd x(6), data(6);
  for (int i = 0; i < 6; ++i) {
    x[i] = fact["X"][i][1];
    data[i] = y[i];
  }
  const std::vector<FreeParameter> unknowns = {{"a", m0[0] - 12.0 * sd0, m0[0] + 12.0 * sd0, normal_prior(m0[0], sd0)},
                                               {"b", m0[1] - 12.0 * sd1, m0[1] + 12.0 * sd1, normal_prior(m0[1], sd1)}};
  const Formula line = [](const Eigen::VectorXd& p, double at) { return p[0] + p[1] * at; };
  return make_case(unknowns, line, x, data, Eigen::VectorXd::Constant(6, fact["sigma"]));
}

}  // namespace

TEST_CASE("the linear-Gaussian posterior and its evidence are those of the closed form", "[uq]") {
  const nlohmann::json fact = facts()["linear_gaussian"];
  const auto model = std::make_shared<const uq::CaseModel>(linear_gaussian());
  const uq::Target target = uq::posterior_target(model);
  const uq::Draws draws = uq::sample_mixture(target, {.draws = 4000, .seed = 3});
  REQUIRE(draws.converged);
  const uq::Quadrature exact = uq::integrate(target, {.guides = draws.pooled().topRows(1000)});
  CHECK(exact.log_evidence == Approx(fact["log_evidence"].get<double>()).margin(2e-4));
  CHECK(std::abs(draws.log_evidence - fact["log_evidence"].get<double>()) < 4.0 * draws.log_evidence_error);
  for (int k = 0; k < 2; ++k) {
    const data::Parameter& parameter = model->unknowns[k].prior.parameter();
    const double width = parameter.high - parameter.low;
    const double mean = fact["post_mean"][k], sd = std::sqrt(fact["post_cov"][k][k].get<double>());
    CHECK(parameter.axis().from_unit(exact.mean[k]) == Approx(mean).margin(1e-4 * sd));
    CHECK(exact.sd[k] * width == Approx(sd).epsilon(1e-3));
    const Eigen::MatrixXd values = draws.coordinate(k);
    CHECK(std::abs(values.mean() - exact.mean[k]) < 4.0 * uq::mean_mcse(values));
  }
}

TEST_CASE("the gradient of the posterior is that of central differences, with a surrogate's covariance inside",
          "[uq]") {
  // A process over (a, b, x), trained on a smooth function with noise.
  surrogate::TrainingSet set{
      .x = Eigen::MatrixXd(40, 3), .y = Eigen::VectorXd(40), .noise_variance = Eigen::VectorXd::Constant(40, 1e-4)};
  data::RandomStream random(1, data::Purpose::test);
  for (Eigen::Index i = 0; i < 40; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) set.x(i, k) = random.uniform();
    set.y[i] = std::sin(3.0 * set.x(i, 0)) + set.x(i, 1) * set.x(i, 1) + 0.5 * set.x(i, 2) + 0.01 * random.normal();
  }
  const auto process = std::make_shared<const surrogate::GaussianProcess>(surrogate::fit(set, {.starts = 2}));
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(5, 0.1, 0.9);
  uq::CaseModel model = make_case({{"a"}, {"b", 0.5, 4.0, {}, 1.0, data::Scale::log}}, {}, x,
                                  Eigen::VectorXd::LinSpaced(5, 0.9, 1.3), Eigen::VectorXd::Constant(5, 0.05));
  const std::vector<uq::EmulatorInput> inputs = model.groups[0].emulator.inputs;
  model.groups[0].emulator = uq::make_emulator(process, "", 0, inputs);
  const auto gradient_matches = [](const uq::CaseModel& tested) {
    const uq::Target target = uq::posterior_target(std::make_shared<const uq::CaseModel>(tested));
    for (const auto& [a, b] : {std::pair{0.3, 0.4}, std::pair{0.8, 0.2}, std::pair{0.05, 0.95}}) {
      const Eigen::VectorXd u = Eigen::Vector2d(a, b);
      const uq::Evaluation found = target.log_density_gradient(u);
      CHECK(found.value == Approx(target.log_density(u)).epsilon(1e-10));
      const Eigen::VectorXd batch = target.log_densities(u.transpose());
      CHECK(batch[0] == Approx(found.value).epsilon(1e-10));
      for (Eigen::Index k = 0; k < 2; ++k) {
        Eigen::VectorXd up = u, down = u;
        up[k] += 1e-5;
        down[k] -= 1e-5;
        const double difference = (target.log_density(up) - target.log_density(down)) / 2e-5;
        CHECK(found.gradient[k] == Approx(difference).epsilon(1e-4).margin(1e-4));
      }
    }
  };
  gradient_matches(model);
  // Rows that take the second parameter from elsewhere: no common shift, so differences take over.
  model.groups[0].unknown(0, 1) = -1;
  model.groups[0].base(0, 1) = 0.5;
  uq::find_coordinates(model.groups[0], 2);
  CHECK_FALSE(model.groups[0].uniform);
  gradient_matches(model);
}
