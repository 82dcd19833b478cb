// Quadrature beside the sampler, on every kind of prior and both scales: they see one density, of u.
#include "uq/infer/quadrature.hpp"

#include <catch2/catch.hpp>
#include <cmath>

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
