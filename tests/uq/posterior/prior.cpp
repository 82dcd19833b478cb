// Moments of the uncut laws: N. L. Johnson, S. Kotz, N. Balakrishnan, "Continuous Univariate Distributions" (1994).
#include "uq/posterior/prior.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

namespace {

uq::ScaledPrior scaled(data::PriorKind kind, double low, double high, double mean, double sd,
                       data::Scale scale = data::Scale::linear) {
  data::Parameter parameter{.name = "p", .target = "p", .low = low, .high = high, .scale = scale};
  data::Prior prior{.kind = kind, .low = low, .high = high, .mean = mean, .sd = sd};
  return {parameter, prior};
}

}  // namespace

TEST_CASE("priors far from the ends of their ranges have the moments of their laws", "[uq]") {
  using data::PriorKind;
  for (const auto scale : {data::Scale::linear, data::Scale::log}) {
    const uq::ScaledPrior normal = scaled(PriorKind::normal, 1.0, 101.0, 50.0, 4.0, scale);
    CHECK(normal.value_mean() == Approx(50.0).epsilon(1e-4));
    CHECK(normal.value_sd() == Approx(4.0).epsilon(1e-3));
    CHECK(normal.kept_mass() == Approx(1.0));
    // exp(m + s^2 / 2) and that times sqrt(exp(s^2) - 1).
    const uq::ScaledPrior log_normal = scaled(PriorKind::log_normal, 0.01, 1000.0, 2.0, 0.5, scale);
    CHECK(log_normal.value_mean() == Approx(2.0 * std::exp(0.125)).epsilon(1e-3));
    CHECK(log_normal.value_sd() == Approx(2.0 * std::exp(0.125) * std::sqrt(std::exp(0.25) - 1.0)).epsilon(5e-3));
    // (b - a) / log(b / a).
    const uq::ScaledPrior decades = scaled(PriorKind::log_uniform, 1.0, 100.0, 0.0, 0.0, scale);
    CHECK(decades.value_mean() == Approx(99.0 / std::log(100.0)).epsilon(1e-3));
    CHECK(uq::ScaledPrior(decades).cdf(decades.parameter().axis().to_unit(10.0)) == Approx(0.5).epsilon(1e-6));
  }
}

TEST_CASE("a normal prior whose middle is an end of the range is half a normal", "[uq]") {
  const uq::ScaledPrior half = scaled(data::PriorKind::normal, 0.0, 40.0, 0.0, 4.0);
  CHECK(half.value_mean() == Approx(4.0 * std::sqrt(2.0 / std::numbers::pi)).epsilon(1e-3));
  CHECK(half.value_sd() == Approx(4.0 * std::sqrt(1.0 - 2.0 / std::numbers::pi)).epsilon(1e-3));
  const data::Parameter range{.name = "p", .target = "p", .low = 0.0, .high = 40.0};
  const data::Prior wider{.kind = data::PriorKind::normal, .low = -40.0, .high = 40.0, .mean = 0.0, .sd = 4.0};
  CHECK(uq::ScaledPrior(range, wider).kept_mass() == Approx(0.5).epsilon(1e-6));
  CHECK(half.is_informative());
  CHECK_FALSE(scaled(data::PriorKind::uniform, 0.0, 40.0, 0.0, 0.0).is_informative());
}

TEST_CASE("far out in a tail a cut prior keeps its digits", "[uq]") {
  // A normal beyond 8 of its sds: nearly exponential, with the mean pdf(8) / tail(8).
  const uq::ScaledPrior tail = scaled(data::PriorKind::truncated_normal, 8.0, 20.0, 0.0, 1.0);
  CHECK(tail.value_mean() == Approx(8.1213681).epsilon(1e-5));
  CHECK(tail.cdf(tail.inverse_cdf(0.37)) == Approx(0.37).epsilon(1e-6));
}

TEST_CASE("priors are normalised on their support and give their own moments", "[uq]") {
  for (const auto kind : {data::PriorKind::uniform, data::PriorKind::log_uniform, data::PriorKind::normal,
                          data::PriorKind::truncated_normal, data::PriorKind::log_normal, data::PriorKind::beta})
    for (const auto scale : {data::Scale::linear, data::Scale::log}) {
      data::Parameter parameter;
      parameter.low = 0.5e-18;
      parameter.high = 6e-18;
      parameter.scale = scale;
      data::Prior prior;
      prior.kind = kind;
      prior.low = 1e-18;
      prior.high = 5e-18;
      prior.mean = 2e-18;
      prior.sd = kind == data::PriorKind::log_normal ? 0.6 : 1.5e-18;
      prior.alpha = 2.0;
      prior.beta = 3.5;
      INFO(static_cast<int>(kind) << " scale " << static_cast<int>(scale));
      const uq::ScaledPrior scaled(parameter, prior);
      const int n = 20000;
      double mass = 0.0, first = 0.0, second = 0.0;
      for (int i = 0; i < n; ++i) {
        const double u = scaled.low() + (scaled.high() - scaled.low()) * (i + 0.5) / n;
        const double part = std::exp(scaled.log_density(u)) * (scaled.high() - scaled.low()) / n;
        const double value = parameter.axis().from_unit(u) * 1e18;
        mass += part;
        first += part * value;
        second += part * value * value;
        if (i % 4000 == 2000) {
          CHECK(scaled.cdf(scaled.inverse_cdf(mass)) == Approx(mass).epsilon(1e-6));
          CHECK(scaled.cdf(u) == Approx(mass).margin(2e-4));
          const double difference = (scaled.log_density(u + 1e-6) - scaled.log_density(u - 1e-6)) / 2e-6;
          CHECK(scaled.slope(u) == Approx(difference).epsilon(1e-4).margin(1e-4));
        }
      }
      CHECK(mass == Approx(1.0).epsilon(1e-5));
      CHECK(scaled.value_mean() * 1e18 == Approx(first).epsilon(1e-4));
      CHECK(scaled.value_sd() * 1e18 == Approx(std::sqrt(second - first * first)).epsilon(1e-3));
    }
}
