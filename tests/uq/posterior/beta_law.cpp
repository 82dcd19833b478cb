// The beta law against closed forms, and priors of any shape.
#include "uq/posterior/beta_law.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/error.hpp"
#include "tests/uq/closed_form.hpp"

using namespace uq;

TEST_CASE("the beta distribution function is its closed forms", "[uq]") {
  for (const double s : {1e-12, 0.01, 0.3, 0.5, 0.77, 0.999, 1.0 - 1e-12}) {
    for (const double shape : {0.01, 0.1, 0.7, 1.0, 5.0, 300.0, 1000.0}) {
      CHECK(beta_cdf(s, {shape, 1.0}) == Approx(std::pow(s, shape)).epsilon(1e-11));
      CHECK(beta_upper(s, {1.0, shape}) == Approx(std::exp(shape * std::log1p(-s))).epsilon(1e-11));
    }
    CHECK(beta_cdf(s, {2.0, 3.0}) == Approx(s * s * (6.0 - 8.0 * s + 3.0 * s * s)).epsilon(1e-11));
    // Arcsine law, by the end that is nearer.
    const double arc = s < 0.5 ? std::asin(std::sqrt(s)) : 0.5 * M_PI - std::asin(std::sqrt(1.0 - s));
    CHECK(beta_cdf(s, {0.5, 0.5}) == Approx(2.0 / M_PI * arc).epsilon(1e-11));
  }
  // A thousand and more: normal to the order of the skewness, which is zero.
  const double sd = 0.5 / std::sqrt(2e4 + 1.0);
  CHECK(beta_cdf(0.5 + sd, {1e4, 1e4}) == Approx(0.5 * std::erfc(-1.0 / std::sqrt(2.0))).epsilon(1e-4));
}

TEST_CASE("beta quantiles go back where they came from", "[uq]") {
  for (const BetaShapes shapes : {BetaShapes{3, 300}, {1, 1000}, {0.1, 5}, {1e4, 1e4}, {0.01, 0.01}, {2, 2}, {1e6, 3}})
    for (const double p : {1e-6, 0.01, 0.3, 0.5, 0.9, 0.999}) {
      CAPTURE(shapes.alpha, shapes.beta, p);
      const double s = beta_quantile(p, shapes);
      CHECK(s >= 0.0);
      CHECK(s <= 1.0);
      if (s > 1e-300 && s < 1.0 - 1e-10) CHECK(beta_cdf(s, shapes) == Approx(p).epsilon(1e-8));
    }
}

TEST_CASE("beta priors of extreme shapes have finite densities, draws and moments", "[uq]") {
  for (const BetaShapes shapes : {BetaShapes{3, 300}, {1, 1000}, {0.1, 5}, {1e4, 1e4}, {0.01, 0.01}}) {
    CAPTURE(shapes.alpha, shapes.beta);
    const data::Parameter parameter = closed_form::parameter_of({"p", 2.0, 6.0});
    const ScaledPrior prior(
        parameter,
        {.kind = data::PriorKind::beta, .low = 2.0, .high = 6.0, .alpha = shapes.alpha, .beta = shapes.beta});
    const double mean = shapes.alpha / (shapes.alpha + shapes.beta);
    const double sd = std::sqrt(mean * (1.0 - mean) / (shapes.alpha + shapes.beta + 1.0));
    CHECK(prior.value_mean() == Approx(2.0 + 4.0 * mean).epsilon(1e-3));
    CHECK(prior.value_sd() == Approx(4.0 * sd).epsilon(2e-2));
    data::RandomStream random(3, data::Purpose::test);
    for (int i = 0; i < 50; ++i) CHECK(std::isfinite(prior.log_density(prior.draw(random))));
  }
}

TEST_CASE("a beta prior whose shapes no number can hold is refused with its bounds", "[uq]") {
  const data::Parameter parameter = closed_form::parameter_of({"p", 0.0, 1.0});
  for (const BetaShapes shapes : {BetaShapes{1e308, 1e-308}, {1e-3, 1.0}, {2.0, 1e7}})
    CHECK_THROWS_AS(
        ScaledPrior(
            parameter,
            {.kind = data::PriorKind::beta, .low = 0.0, .high = 1.0, .alpha = shapes.alpha, .beta = shapes.beta}),
        data::InputError);
}

TEST_CASE("a beta prior that a narrower range cuts keeps its law inside", "[uq]") {
  const data::Prior law{.kind = data::PriorKind::beta, .low = 0.0, .high = 1.0, .alpha = 2.0, .beta = 5.0};
  const ScaledPrior whole(closed_form::parameter_of({"p", 0.0, 1.0}), law);
  const ScaledPrior cut(closed_form::parameter_of({"p", 0.1, 0.5}), law);
  // The ratio of densities at two values is the law's, in values.
  for (const double a : {0.15, 0.3})
    for (const double b : {0.2, 0.45}) {
      const double inside = cut.log_density((a - 0.1) / 0.4) - cut.log_density((b - 0.1) / 0.4);
      CHECK(inside == Approx(whole.log_density(a) - whole.log_density(b)).epsilon(1e-10));
    }
}
