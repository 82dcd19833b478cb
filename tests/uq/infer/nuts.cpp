// The gradient-based sampler against quadrature and closed forms.
#include "uq/infer/nuts.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/uq/infer/densities.hpp"
#include "uq/infer/diagnostics.hpp"
#include "uq/infer/quadrature.hpp"
#include "uq/infer/unconstrained.hpp"

using namespace uq;

TEST_CASE("the map to the whole space is undone by its inverse, and its Jacobian is in the gradient", "[uq]") {
  Target target = densities::ridge_at_bound(0.05);
  for (const double upper : {1.0, std::numeric_limits<double>::infinity()}) {
    target.upper[1] = upper;
    const Eigen::VectorXd z = Eigen::Vector2d(0.7, -1.3);
    CHECK((to_unconstrained(target, from_unconstrained(target, z)) - z).norm() < 1e-10);
    const Evaluation found = unconstrained_density(target, z);
    for (Eigen::Index k = 0; k < 2; ++k) {
      Eigen::VectorXd up = z, down = z;
      up[k] += 1e-6;
      down[k] -= 1e-6;
      const double difference =
          (unconstrained_density(target, up).value - unconstrained_density(target, down).value) / 2e-6;
      CHECK(found.gradient[k] == Approx(difference).epsilon(1e-5));
    }
  }
}

TEST_CASE("gradient-based draws on a ridge against a bound agree with quadrature", "[uq]") {
  const Target target = densities::ridge_at_bound(0.05);
  const Draws draws = sample_nuts(target, {.seed = 2});
  INFO(draws.reason << " divergences " << draws.divergences);
  REQUIRE(draws.converged);
  const Quadrature exact = integrate(target, {.guides = draws.pooled().topRows(1000)});
  for (int k = 0; k < 2; ++k) {
    const Eigen::MatrixXd values = draws.coordinate(k);
    CHECK(std::abs(values.mean() - exact.mean[k]) < 4.0 * mean_mcse(values));
    const Eigen::MatrixXd squares = (values.array() - exact.mean[k]).square();
    CHECK(std::abs(squares.mean() - exact.sd[k] * exact.sd[k]) < 4.0 * mean_mcse(squares));
  }
  CHECK(energy_fraction(draws.chains[0].energy) > 0.3);
}

TEST_CASE("gradient-based draws of a correlated Gaussian in ten dimensions have its covariance, without divergences",
          "[uq]") {
  const Target target = densities::correlated(10, 0.99);
  const Draws draws = sample_nuts(target, {.seed = 3});
  INFO(draws.reason);
  REQUIRE(draws.converged);
  CHECK(draws.divergences == 0);
  for (int k = 0; k < 10; ++k) {
    const Eigen::MatrixXd values = draws.coordinate(k), squares = values.array().square();
    CHECK(std::abs(values.mean()) < 4.5 * mean_mcse(values));
    CHECK(std::abs(squares.mean() - 1.0) < 4.5 * mean_mcse(squares));
  }
}

TEST_CASE("gradient-based draws are the same bits for any number of threads", "[uq]") {
  const Target target = densities::correlated(2, 0.5);
  CHECK(sample_nuts(target, {.draws_max = 1000, .threads = 1, .seed = 5}).pooled() ==
        sample_nuts(target, {.draws_max = 1000, .threads = 3, .seed = 5}).pooled());
}
