// Quadrature beside the sampler, on every kind of prior and both scales: they see one density, of u.
#include "uq/infer/quadrature.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/uq/closed_form.hpp"
#include "uq/infer/diagnostics.hpp"
#include "uq/infer/mixture_sampler.hpp"
#include "uq/posterior/posterior.hpp"

using namespace uq;

TEST_CASE("sampler and quadrature agree on every kind of prior and scale", "[uq]") {
  const auto prior = [](data::PriorKind kind) {
    return data::Prior{.kind = kind, .low = 0.1, .high = 10.0, .mean = 4.0, .sd = 1.5, .alpha = 2.0, .beta = 3.0};
  };
  data::Prior log_normal = prior(data::PriorKind::log_normal);
  log_normal.sd = 0.5;
  const std::vector<data::Prior> priors = {prior(data::PriorKind::uniform),
                                           prior(data::PriorKind::log_uniform),
                                           prior(data::PriorKind::normal),
                                           prior(data::PriorKind::truncated_normal),
                                           log_normal,
                                           prior(data::PriorKind::beta)};
  Eigen::VectorXd x(4);
  x << 0.0, 0.3, 0.6, 1.0;
  const Eigen::VectorXd truth = Eigen::Vector2d(0.4, 3.0);
  for (const data::Prior& law : priors)
    for (const data::Scale scale : {data::Scale::linear, data::Scale::log}) {
      CAPTURE(static_cast<int>(law.kind), static_cast<int>(scale));
      const auto model = std::make_shared<const CaseModel>(closed_form::make_synthetic(
          {{"a", 0.0, 1.0}, {"b", 0.1, 10.0, law, 1.0, scale}},
          [](const Eigen::VectorXd& p, double z) { return 1.0 + p[0] + 0.05 * p[1] * (1.0 + z); }, x, truth, 0.05, 3));
      const Target target = posterior_target(model);
      const Draws draws = sample_mixture(target, {.draws = 4000, .seed = 3});
      INFO(draws.reason);
      REQUIRE(draws.converged);
      const Quadrature exact = integrate(target, {.tolerance = 1e-4, .guides = draws.pooled().topRows(1000)});
      REQUIRE(exact.resolved);
      for (int k = 0; k < 2; ++k) {
        const Eigen::MatrixXd values = draws.coordinate(k), squares = (values.array() - exact.mean[k]).square();
        CHECK(std::abs(values.mean() - exact.mean[k]) < 4.5 * mean_mcse(values));
        CHECK(std::abs(squares.mean() - exact.sd[k] * exact.sd[k]) < 4.5 * mean_mcse(squares));
      }
      CHECK(std::abs(draws.log_evidence - exact.log_evidence) < 4.5 * draws.log_evidence_error + 1e-4);
    }
}

namespace {

/// 0.9985 of a normal law about zero, and 0.0015 of a narrower one thirty of its standard deviations away.
double far_place(const Eigen::VectorXd& x) {
  const auto normal = [&](double mean, double sd) {
    return std::exp(-0.5 * std::pow((x[0] - mean) / sd, 2)) / (sd * std::sqrt(2.0 * std::numbers::pi));
  };
  return std::log(0.9985 * normal(0.0, 1.0) + 0.0015 * normal(30.0, 0.5));
}

/// Independent draws of the law about zero alone.
Draws without_far_place(int count, double shift, data::RandomStream& random) {
  Draws draws;
  for (int c = 0; c < 4; ++c) {
    Chain chain{.x = Eigen::MatrixXd(count / 4, 1), .log_density = Eigen::VectorXd::Zero(count / 4)};
    for (double& x : chain.x.reshaped()) x = shift + random.normal();
    draws.chains.push_back(chain);
  }
  return draws;
}

}  // namespace

TEST_CASE("draws that miss a far place agree with quadrature while chance explains it", "[uq]") {
  const Eigen::VectorXd low = Eigen::VectorXd::Constant(1, -10.0), high = Eigen::VectorXd::Constant(1, 40.0);
  const Target target{
      .dimension = 1, .lower = low, .upper = high, .reference = uniform_reference(low, high), .log_density = far_place};
  const Quadrature exact = integrate(target);
  CHECK(exact.mean[0] == Approx(0.0015 * 30.0).epsilon(1e-4));
  CHECK(exact.sd[0] * exact.sd[0] ==
        Approx(0.9985 * (1.0 + 0.045 * 0.045) + 0.0015 * (0.25 + 29.955 * 29.955)).epsilon(1e-4));
  const double near = 0.9985 * (3.0 + 6.0 * 0.045 * 0.045),
               far = 0.0015 * (std::pow(29.955, 4) + 6.0 * 0.25 * 29.955 * 29.955);
  CHECK(exact.fourth[0] == Approx(near + far).epsilon(1e-4));
  data::RandomStream random(5, data::Purpose::sampler);
  // Of 1,000 draws 1.5 lie there: none of them is chance. Of 100,000 draws 150 do.
  CHECK(agree(without_far_place(1000, 0.0, random), exact));
  CHECK_FALSE(agree(without_far_place(100000, 0.0, random), exact));
  CHECK_FALSE(agree(without_far_place(1000, 0.5, random), exact));
}
