// Closed form for an autoregressive series x_t = phi x_{t-1} + noise: tau = (1 + phi) / (1 - phi).
#include "data/time_series.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "data/random.hpp"

namespace {

std::vector<double> autoregressive(double phi, std::size_t n, std::uint32_t index) {
  data::RandomStream random(11, data::Purpose::test, index);
  std::vector<double> x(n);
  double value = random.normal();
  for (double& out : x) {
    out = value;
    value = phi * value + std::sqrt(1.0 - phi * phi) * random.normal();
  }
  return x;
}

}  // namespace

TEST_CASE("the integrated autocorrelation time of an AR(1) series is (1 + phi) / (1 - phi)") {
  for (const double phi : {0.0, 0.5, 0.9}) {
    const std::vector<double> x = autoregressive(phi, 200000, 1);
    const data::SeriesMean found = data::mean_with_error(x);
    const double tau = (1.0 + phi) / (1.0 - phi);
    CHECK(found.integrated_time == Approx(tau).epsilon(0.08));
    CHECK(found.sd == Approx(1.0).epsilon(0.03));
    CHECK(found.standard_error == Approx(std::sqrt(tau / 200000.0)).epsilon(0.06));
    CHECK(found.reliable);
  }
}

TEST_CASE(
    "a series each of whose samples is held for long has the error that it had, in time that grows with its length") {
  const std::vector<double> x = autoregressive(0.9, 3000, 2);
  std::vector<double> held;
  for (const double value : x) held.insert(held.end(), 200, value);
  const data::SeriesOptions all{.start_up_fraction_max = 0.0};
  const data::SeriesMean found = data::mean_with_error(held, all), before = data::mean_with_error(x, all);
  CHECK(found.standard_error == Approx(before.standard_error).epsilon(0.02));
  CHECK(found.integrated_time == Approx(200 * before.integrated_time).epsilon(0.04));
  CHECK(found.reliable);
}

TEST_CASE("95 % intervals of correlated means cover the truth about 95 % of the time") {
  for (const double phi : {0.0, 0.8}) {
    int covered = 0, truncated = 0;
    const int series = 1500;
    for (int i = 0; i < series; ++i) {
      const std::vector<double> x = autoregressive(phi, 1000, 100 + static_cast<std::uint32_t>(i));
      const data::SeriesMean found = data::mean_with_error(x);
      if (std::abs(found.mean) < 1.96 * found.standard_error) ++covered;
      if (found.dropped > 0) ++truncated;
    }
    INFO("phi " << phi << ", covered " << covered << ", truncated " << truncated << " of " << series);
    CHECK(covered > 0.925 * series);
    CHECK(covered < 0.975 * series);
    CHECK(truncated < 0.03 * series);  // a stationary series is kept whole
  }
}

TEST_CASE("a start-up transient is dropped, and the mean is that of the stationary part") {
  int covered = 0;
  const int series = 300;
  for (int i = 0; i < series; ++i) {
    std::vector<double> x = autoregressive(0.6, 1500, 5000 + static_cast<std::uint32_t>(i));
    for (std::size_t t = 0; t < x.size(); ++t) x[t] += 3.0 - 8.0 * std::exp(-static_cast<double>(t) / 40.0);
    const data::SeriesMean found = data::mean_with_error(x);
    CHECK(found.dropped >= 40);  // one time constant at least; what is left is within the error, as the coverage shows
    CHECK(found.dropped <= 750);
    if (std::abs(found.mean - 3.0) < 1.96 * found.standard_error) ++covered;
  }
  CHECK(covered > 0.90 * series);
}

TEST_CASE("a short start-up does not cost a large part of the series") {
  std::vector<double> x = autoregressive(0.3, 2000, 77);
  for (std::size_t t = 0; t < 30; ++t) x[t] -= 20.0;
  const data::SeriesMean found = data::mean_with_error(x);
  CHECK(found.dropped >= 30);
  CHECK(found.dropped <= 200);
}

TEST_CASE("a slow fluctuation at the beginning is seldom taken for a start-up") {
  // Fast, slower and slow parts of equal power, as of a bed that packs and loosens: 600 samples of which the slowest
  // part remembers 100. Its mean over the rest alone is farther off than that over all.
  int truncated = 0;
  double of_found = 0.0, of_all = 0.0;
  const int series = 400;
  for (int i = 0; i < series; ++i) {
    std::vector<double> x(600, 0.0);
    for (const double phi : {0.37, 0.905, 0.99}) {
      const std::vector<double> part =
          autoregressive(phi, x.size(), 9000 + static_cast<std::uint32_t>(3 * i) + (phi > 0.5) + (phi > 0.95));
      for (std::size_t t = 0; t < x.size(); ++t) x[t] += part[t];
    }
    const data::SeriesMean found = data::mean_with_error(x);
    const double all = data::mean_with_error(x, {.start_up_fraction_max = 0.0}).mean;
    truncated += found.dropped > 0 ? 1 : 0;
    of_found += found.mean * found.mean;
    of_all += all * all;
  }
  INFO("truncated " << truncated << ", rms " << std::sqrt(of_found / of_all) << " of that of all");
  CHECK(truncated < 0.04 * series);
  CHECK(of_found < 1.05 * 1.05 * of_all);
}

TEST_CASE("a spike does not decide where a series begins, nor hides where it does") {
  for (const double phi : {0.0, 0.9})
    for (const double transient : {0.0, -8.0})
      for (const std::size_t at : {3u, 20u, 100u, 700u, 1500u})
        for (const double size : {5.0, 30.0, 1000.0}) {
          std::vector<double> x = autoregressive(phi, 2000, 42);
          for (std::size_t t = 0; t < x.size(); ++t) x[t] += transient * std::exp(-static_cast<double>(t) / 40.0);
          const std::size_t without = data::mean_with_error(x).dropped;
          x[at] += size;
          const data::SeriesMean with = data::mean_with_error(x);
          INFO("phi " << phi << ", start-up " << transient << ", " << size << " sd at " << at << ", dropped "
                      << with.dropped << " and " << without << " without the spike");
          CHECK(std::abs(static_cast<double>(with.dropped) - static_cast<double>(without)) <= 100.0);
          // One sample of 1000 sd moves the mean by half a sd; the error covers that.
          if (size > 100.0 && transient == 0.0) CHECK(std::abs(with.mean) < 2.0 * with.standard_error);
        }
}

TEST_CASE("rare bursts of which the beginning has more by chance are no start-up") {
  // Bursts of eight samples that die away, of exponential size, upon noise: as of a lump that the blade breaks now and
  // then.
  const int series = 200;
  int truncated = 0;
  double of_found = 0.0, of_all = 0.0;
  for (int i = 0; i < series; ++i) {
    data::RandomStream random(static_cast<std::uint64_t>(i), data::Purpose::test, 77);
    std::vector<double> x(600);
    for (double& value : x) value = 0.1 * random.normal();
    double share = 0.0;  // of a burst of size 1, over the samples
    for (int k = 0; k < 8; ++k) share += std::exp(-k / 3.0);
    for (std::size_t t = 0; t < x.size(); ++t) {
      x[t] -= 0.02 * share;
      if (random.uniform() > 0.02) continue;
      const double size = -std::log(random.uniform());
      for (std::size_t k = 0; k < 8 && t + k < x.size(); ++k)
        x[t + k] += size * std::exp(-static_cast<double>(k) / 3.0);
    }
    const data::SeriesMean found = data::mean_with_error(x);
    truncated += found.dropped > 0 ? 1 : 0;
    of_found += std::pow(found.mean, 2);
    of_all += std::pow(data::mean_with_error(x, {.start_up_fraction_max = 0.0}).mean, 2);
  }
  INFO("truncated " << truncated << ", rms " << std::sqrt(of_found / of_all) << " of that of all");
  CHECK(truncated <= 0.02 * series);
  CHECK(of_found < 1.05 * 1.05 * of_all);
}

TEST_CASE("a beginning that decays is cut, also where its mean is near the scatter of the rest") {
  int cut = 0;
  const int series = 100;
  for (int i = 0; i < series; ++i) {
    std::vector<double> x = autoregressive(0.5, 600, 4000 + static_cast<std::uint32_t>(i));
    for (std::size_t t = 0; t < x.size(); ++t) x[t] += 5.0 * std::exp(-static_cast<double>(t) / 30.0);
    cut += data::mean_with_error(x).dropped >= 30 ? 1 : 0;
  }
  CHECK(cut >= 0.95 * series);
}

TEST_CASE("without its spikes, single ones and short bursts, a series has the mean that it had before them") {
  std::vector<double> x = autoregressive(0.8, 3000, 43);
  const data::SeriesMean before = data::mean_with_error(x);
  for (std::size_t t = 200; t < 206; ++t) x[t] = 60.0;
  x[1000] = -500.0;
  CHECK(data::without_spikes(x).spikes == std::vector<std::size_t>{200, 201, 202, 203, 204, 205, 1000});
  const data::SeriesMean after = data::mean_with_error(x, {.spikes_count = false});
  CHECK(after.dropped == before.dropped);
  CHECK(after.spikes_out == 7);
  CHECK(after.mean == Approx(before.mean).margin(0.1 * before.standard_error));
  CHECK(after.standard_error == Approx(before.standard_error).epsilon(0.05));
}

TEST_CASE("spikes that a series begins with are its start-up, whatever else it does") {
  std::vector<double> x = autoregressive(0.0, 2000, 44);
  for (std::size_t t = 0; t < 3; ++t) x[t] = 300.0;
  const data::SeriesMean found = data::mean_with_error(x);
  CHECK(found.dropped >= 3);
  CHECK(found.dropped <= 20);
  CHECK(found.sd == Approx(1.0).epsilon(0.1));
}

TEST_CASE("a correlated, a coarse and a drifting series have no spikes") {
  CHECK(data::without_spikes(autoregressive(0.97, 20000, 45)).spikes.empty());
  std::vector<double> coarse = autoregressive(0.5, 5000, 46), drifting = autoregressive(0.0, 5000, 47);
  for (double& value : coarse) value = std::round(0.6 * value);
  for (std::size_t t = 0; t < drifting.size(); ++t) drifting[t] += 0.5 * static_cast<double>(t);
  CHECK(data::without_spikes(coarse).spikes.empty());
  CHECK(data::without_spikes(drifting).spikes.empty());
}

TEST_CASE("a constant series has its value as mean and no error") {
  const std::vector<double> x(100, 0.1);
  const data::SeriesMean found = data::mean_with_error(x);
  CHECK(found.mean == Approx(0.1));
  CHECK(found.standard_error == 0.0);
  CHECK(found.dropped == 0);
  CHECK(found.reliable);
}

TEST_CASE("a series too short for its correlation, still drifting, empty or not finite is not called reliable") {
  CHECK_FALSE(data::mean_with_error(autoregressive(0.98, 300, 3)).reliable);
  std::vector<double> drifting = autoregressive(0.0, 1000, 4);
  for (std::size_t t = 0; t < drifting.size(); ++t) drifting[t] += 0.05 * static_cast<double>(t);
  CHECK_FALSE(data::mean_with_error(drifting).reliable);
  CHECK_FALSE(data::mean_with_error({}).reliable);
  std::vector<double> broken = autoregressive(0.0, 100, 5);
  broken[50] = std::nan("");
  CHECK_FALSE(data::mean_with_error(broken).reliable);
}
