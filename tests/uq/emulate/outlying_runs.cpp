// Runs that the others contradict: planted ones are found, each of them, and clean tables have none.
#include "uq/emulate/outlying_runs.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"
#include "surrogate/design.hpp"

using namespace uq;

namespace {

using Function = double (*)(const Eigen::VectorXd&);

double saturating(const Eigen::VectorXd& x) { return 4.0 + 8.0 * x[0] / (0.3 + x[0]) + 2.0 * x[1] - 1.5 * x[0] * x[2]; }
double kinked(const Eigen::VectorXd& x) { return 5.0 + 4.0 * std::abs(x[0] - 0.4) + x[1] + 0.5 * x[2]; }
double peaked(const Eigen::VectorXd& x) {
  return 5.0 + 3.0 * std::exp(-12.0 * (x - Eigen::Vector3d(0.3, 0.6, 0.5)).squaredNorm());
}
double linear(const Eigen::VectorXd& x) { return 3.0 + x.sum(); }
double steep(const Eigen::VectorXd& x) { return 5.0 + 3.0 * std::tanh(20.0 * (x[0] - 0.5)) + x[1]; }

/// Runs with a relative scatter, which their standard errors state.
surrogate::TrainingSet runs_of(Function f, int count, double scatter, std::uint64_t seed) {
  surrogate::TrainingSet set{surrogate::scrambled_sobol(count, 3, seed, 0), Eigen::VectorXd(count),
                             Eigen::VectorXd(count)};
  data::RandomStream random(seed, data::Purpose::measurement_noise, 1);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double y = f(set.x.row(i).transpose());
    set.y[i] = y * (1.0 + scatter * random.normal());
    set.noise_variance[i] = std::pow(scatter * y, 2);
  }
  return set;
}

std::vector<int> found_in(const surrogate::TrainingSet& set) {
  const surrogate::FitOptions options{.starts = 4, .seed = 1};
  std::vector<int> found = find_outlying(set, surrogate::fit(set, options), options).runs;
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

TEST_CASE("a run written ten times too large is found, and so are three that gave half more", "[uq]") {
  for (const Function f : {saturating, kinked, linear}) {
    surrogate::TrainingSet set = runs_of(f, 60, 0.005, 3);
    const surrogate::TrainingSet clean = set;
    set.y[22] *= 10.0;
    CHECK(found_in(set) == std::vector<int>{22});
    set = clean;
    for (const int i : {5, 30, 51}) set.y[i] *= 1.5;
    CHECK(found_in(set) == std::vector<int>{5, 30, 51});
  }
}

TEST_CASE("failed runs written as a number of their own are found, six of them that hide each other", "[uq]") {
  surrogate::TrainingSet set = runs_of(saturating, 60, 0.005, 4);
  const std::vector<int> failed{2, 11, 23, 24, 40, 59};
  for (const int i : failed) set.y[i] = -999.0;
  CHECK(found_in(set) == failed);
}

TEST_CASE("the run is told with what the others say there, and how far it is off", "[uq]") {
  surrogate::TrainingSet set = runs_of(saturating, 60, 0.005, 5);
  const double truth = saturating(set.x.row(10).transpose());
  set.y[10] *= 1.3;
  const surrogate::FitOptions options{.starts = 4, .seed = 1};
  const OutlyingRuns found = find_outlying(set, surrogate::fit(set, options), options);
  REQUIRE(found.runs == std::vector<int>{10});
  CHECK(found.expected[0] == Approx(truth).epsilon(0.02));
  CHECK(found.deviations[0] > 8.0);
  CHECK(found.scatter == Approx(1.0).margin(0.4));
}

TEST_CASE("clean tables have no outlying run: smooth, kinked, peaked, steep, with noise and without", "[uq][slow]") {
  for (const Function f : {saturating, kinked, peaked, linear, steep})
    for (const double scatter : {0.0, 0.005, 0.03})
      for (const int count : {20, 60}) {
        CAPTURE(f == saturating, f == kinked, f == peaked, f == linear, f == steep, scatter, count);
        CHECK(found_in(runs_of(f, count, scatter, 6)).empty());
      }
}
