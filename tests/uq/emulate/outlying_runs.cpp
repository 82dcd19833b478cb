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

TEST_CASE("accused runs that lie together at an end of an input are told from those that lie anywhere", "[uq]") {
  // 60 runs; in the first column run i has rank i + 1, in the second they come in an order that has nothing to do with
  // it.
  Eigen::MatrixXd x(60, 2);
  for (int i = 0; i < 60; ++i) x.row(i) << i / 60.0, (37 * i % 60) / 60.0;
  const auto low = at_one_end(x, {0, 1, 2, 3});
  REQUIRE(low);
  CHECK(low->input == 0);
  CHECK(low->low);
  // z = (10 - 122) / sqrt(4 * 56 * 61 / 12) = -3.3190, two-sided p 9.03e-4 by tables of the normal law, for two inputs.
  CHECK(low->p == Approx(2.0 * 9.03e-4).epsilon(0.005));
  const auto high = at_one_end(x, {55, 57, 58, 59, 54});
  REQUIRE(high);
  CHECK_FALSE(high->low);
  CHECK_FALSE(at_one_end(x, {0, 1, 2}));                // too few to say
  CHECK_FALSE(at_one_end(x, {2, 11, 23, 24, 40, 59}));  // anywhere
  CHECK(at_one_end(x, {0, 1, 2, 3, 4, 5, 6, 7}));
  CHECK_FALSE(at_one_end(x, {16, 17, 18, 19, 20, 21, 22, 23}));  // together, but at no end
  // Three speeds, 20 runs each: ranks are tied, 10.5 for the lowest. sum of t^3 - t = 3 (8000 - 20), so that
  // z = (42 - 122) / sqrt(4 * 56 / 12 * (61 - 23940 / 3540)) = -2.5147, p 0.01191.
  for (int i = 0; i < 60; ++i) x(i, 0) = i / 20;
  CHECK_FALSE(at_one_end(x.leftCols(1), {0, 5, 10, 15}));
  CHECK(at_one_end(x.leftCols(1), {0, 5, 10, 15, 19}));
}

TEST_CASE("clean tables have no outlying run: smooth, kinked, peaked, steep, with noise and without", "[uq][slow]") {
  for (const Function f : {saturating, kinked, peaked, linear, steep})
    for (const double scatter : {0.0, 0.005, 0.03})
      for (const int count : {20, 60}) {
        CAPTURE(f == saturating, f == kinked, f == peaked, f == linear, f == steep, scatter, count);
        CHECK(found_in(runs_of(f, count, scatter, 6)).empty());
      }
}
