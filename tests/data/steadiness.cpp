// Reference: an autoregressive series x_t = phi x_{t-1} + noise, whose mean has variance tau/n, tau = (1 + phi)/(1 -
// phi).
#include "data/steadiness.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "data/random.hpp"

namespace {

constexpr double tau = 10.0;

/// Of unit variance; `share` of it is common to the series of one `index`.
std::vector<double> autoregressive(std::size_t n, std::uint32_t index, std::uint32_t which = 0, double share = 0.0) {
  const double phi = (tau - 1.0) / (tau + 1.0);
  data::RandomStream common(17, data::Purpose::test, index), own(18 + which, data::Purpose::test, index);
  const auto draw = [&] { return std::sqrt(share) * common.normal() + std::sqrt(1.0 - share) * own.normal(); };
  std::vector<double> x(n);
  double value = draw();
  for (double& out : x) {
    out = value;
    value = phi * value + std::sqrt(1.0 - phi * phi) * draw();
  }
  return x;
}

std::vector<double> with_line(std::vector<double> x, double rise) {
  for (std::size_t k = 0; k < x.size(); ++k)
    x[k] += rise * ((static_cast<double>(k) + 0.5) / static_cast<double>(x.size()) - 0.5);
  return x;
}

}  // namespace

TEST_CASE("the mean of a correlated series scatters by its stated error") {
  for (const std::size_t n : {std::size_t{400}, std::size_t{1600}}) {
    double square = 0.0;
    const int series = 2000;
    for (int i = 0; i < series; ++i) {
      const data::SeriesMean m = data::steadiness(autoregressive(n, static_cast<std::uint32_t>(i))).mean;
      square += m.mean * m.mean / (m.standard_error * m.standard_error) / series;
    }
    INFO("n " << n << ", sd of mean over error " << std::sqrt(square));
    CHECK(std::sqrt(square) > 0.93);
    CHECK(std::sqrt(square) < 1.10);
  }
}

TEST_CASE("three steady series are called drifting in at most 5 of 100, however much they have in common") {
  for (const double share : {0.0, 0.5, 1.0}) {
    int called = 0;
    const int runs = 1000;
    for (int i = 0; i < runs; ++i) {
      std::vector<double> p;
      for (std::uint32_t which = 0; which < 3; ++which)
        p.push_back(data::steadiness(autoregressive(800, static_cast<std::uint32_t>(i), which, share)).drift_p);
      if (data::drifts(p, 0.05)) ++called;
    }
    INFO("share " << share << ", called drifting " << called << " of " << runs);
    CHECK(called < 0.065 * runs);  // 5 % and two standard deviations of the count
    CHECK(called > (share == 1.0 ? 0.008 : 0.03) * runs);
  }
}

TEST_CASE("a line that rises by sixteen errors of the mean over the series is caught in 9 of 10") {
  // A straight line of rise d has by regression an error of sqrt(12) errors of the mean: less cannot be seen by anyone.
  const std::size_t n = 1600;
  const double error = std::sqrt(tau / static_cast<double>(n));
  int caught = 0;
  const int series = 1000;
  for (int i = 0; i < series; ++i) {
    const auto x = with_line(autoregressive(n, static_cast<std::uint32_t>(i)), 16.0 * error);
    if (data::steadiness(x).drift_p < 0.05 / 3.0) ++caught;
  }
  INFO("caught " << caught << " of " << series);
  CHECK(caught > 0.85 * series);
}

TEST_CASE("a start-up that decays over a tenth of the series is caught") {
  const std::size_t n = 1600;
  int caught = 0;
  const int series = 300;
  for (int i = 0; i < series; ++i) {
    std::vector<double> x = autoregressive(n, static_cast<std::uint32_t>(i));
    for (std::size_t k = 0; k < n; ++k)
      x[k] += 4.0 * std::exp(-static_cast<double>(k) / (0.1 * static_cast<double>(n)));
    if (data::steadiness(x).drift_p < 0.05 / 3.0) ++caught;
  }
  INFO("caught " << caught << " of " << series);
  CHECK(caught > 0.85 * series);
}

TEST_CASE("mean, error and drift do not depend on the series' unit, and the drift not on its direction in time") {
  const std::vector<double> x = with_line(autoregressive(900, 7), 0.4);
  std::vector<double> scaled = x, backwards(x.rbegin(), x.rend());
  for (double& value : scaled) value = 5.0 - 1e-6 * value;
  const data::Steadiness a = data::steadiness(x), b = data::steadiness(scaled), c = data::steadiness(backwards);
  CHECK(b.mean.standard_error == Approx(1e-6 * a.mean.standard_error));
  CHECK(b.drift_p == Approx(a.drift_p));
  CHECK(c.drift_p == Approx(a.drift_p));
  CHECK(c.mean.standard_error == Approx(a.mean.standard_error));
}

TEST_CASE("the error is seldom called known in a series of seven correlation times, and mostly in one of 30") {
  const auto called_known = [](std::size_t n) {
    int known = 0;
    for (std::uint32_t i = 0; i < 500; ++i) known += data::steadiness(autoregressive(n, i)).mean.reliable;
    return known / 500.0;
  };
  CHECK(called_known(70) < 0.2);
  CHECK(called_known(100) < 0.35);
  CHECK(called_known(300) > 0.9);
  CHECK(called_known(1000) > 0.99);
}

TEST_CASE("the error of a random walk's mean is hardly ever called known, however long the walk is") {
  int known = 0;
  for (std::uint32_t i = 0; i < 200; ++i) {
    data::RandomStream random(77, data::Purpose::test, i);
    std::vector<double> x(1000);
    double at = 0.0;
    for (double& value : x) value = at += random.normal();
    known += data::steadiness(x).mean.reliable;
  }
  CHECK(known <= 0.05 * 200);
}

TEST_CASE(
    "a series too short for its correlation is not reliable, a constant is exact, and neither is drifting by that") {
  CHECK_FALSE(data::steadiness(autoregressive(100, 3)).mean.reliable);
  CHECK_FALSE(data::steadiness({}).mean.reliable);
  const data::Steadiness constant = data::steadiness(std::vector<double>(500, 3.0));
  CHECK(constant.mean.mean == 3.0);
  CHECK(constant.mean.standard_error == 0.0);
  CHECK(constant.drift_p == 1.0);
  CHECK(constant.mean.reliable);
}
