// A part of the runs in another unit: found with its factor, wherever it lies and whatever the response; none in clean
// tables.
#include "uq/emulate/scaled_runs.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "uq/emulate/outlying_runs.hpp"

using namespace uq;

namespace {

using Function = double (*)(const Eigen::VectorXd&);

double product(const Eigen::VectorXd& x) { return 20.0 + 60.0 * std::sqrt(0.1 + x[0]) * (1.0 + x[1]) - 3.0 * x[2]; }
double exponential(const Eigen::VectorXd& x) { return 3.0 * std::exp(4.0 * x[0]) * (1.0 + x[1]) * (1.0 + 0.5 * x[2]); }
double saturating(const Eigen::VectorXd& x) { return 5.0 + 50.0 * x[0] / (0.1 + x[0]) + 10.0 * x[1] + 5.0 * x[2]; }
double regime(const Eigen::VectorXd& x) {
  return (20.0 + 30.0 * x[0] + 5.0 * x[2]) * (x[0] > 0.5 && x[1] > 0.6 ? 4.0 : 1.0);
}

constexpr int runs = 60;

surrogate::TrainingSet runs_of(Function f, std::uint64_t seed) {
  constexpr double scatter = 0.005;
  surrogate::TrainingSet set{surrogate::scrambled_sobol(runs, 3, seed, 0), Eigen::VectorXd(runs),
                             Eigen::VectorXd(runs)};
  data::RandomStream random(seed, data::Purpose::measurement_noise, 1);
  for (Eigen::Index i = 0; i < runs; ++i) {
    const double y = f(set.x.row(i).transpose());
    set.y[i] = y * (1.0 + scatter * random.normal());
    set.noise_variance[i] = std::pow(scatter * y, 2);
  }
  return set;
}

/// These runs, `first` to `first + count`, in a unit `factor` times smaller, errors and all.
surrogate::TrainingSet in_another_unit(surrogate::TrainingSet set, int first, int count, double factor) {
  set.y.segment(first, count) *= factor;
  set.noise_variance.segment(first, count) *= factor * factor;
  return set;
}

std::vector<int> range(int first, int count) {
  std::vector<int> all;
  for (int i = 0; i < count; ++i) all.push_back(first + i);
  return all;
}

}  // namespace

TEST_CASE("a fifth or a third of the runs in another unit is found, and its factor", "[uq]") {
  const surrogate::FitOptions options{.starts = 4, .seed = 1};
  for (const Function f : {product, saturating})
    for (const auto& [count, factor] : {std::pair{12, 10.0}, {12, 0.001}, {20, 10.0}, {6, 60.0}, {12, 2.0}}) {
      const surrogate::TrainingSet set = in_another_unit(runs_of(f, 5), 17, count, factor);
      CAPTURE(count, factor);
      const std::vector<int> all = range(17, count), suspects = scaled_runs(set);
      CHECK(static_cast<int>(suspects.size()) >= count - 2);
      CHECK(std::includes(all.begin(), all.end(), suspects.begin(), suspects.end()));
      const OutlyingRuns found = find_outlying(set, surrogate::fit(set, options), options);
      std::vector<int> named = found.runs;
      std::sort(named.begin(), named.end());
      CHECK(std::includes(named.begin(), named.end(), all.begin(), all.end()));
      CHECK(static_cast<int>(named.size()) <= (3 * count < runs ? count : count + 1));
      std::vector<double> observed;
      for (const int run : found.runs) observed.push_back(set.y[run]);
      const auto common = common_factor(observed, found.expected);
      REQUIRE(common);
      CHECK(common->factor == Approx(factor).epsilon(0.03));
      CHECK(common->runs == count);
    }
}

TEST_CASE("where the response spans decades, rows of another unit are still seen", "[uq]") {
  CHECK(scaled_runs(in_another_unit(runs_of(exponential, 5), 0, 12, 10.0)) == range(0, 12));
}

TEST_CASE("clean runs have none in another unit, nor runs of which some are 0 or of another sign", "[uq]") {
  for (const Function f : {product, exponential, saturating})
    for (const std::uint64_t seed : {1, 2, 3, 4, 5}) CHECK(scaled_runs(runs_of(f, seed)).empty());
  surrogate::TrainingSet set = in_another_unit(runs_of(product, 1), 3, 12, 10.0);
  set.y[0] = 0.0;
  CHECK(scaled_runs(set).empty());
  set.y[0] = -1.0;
  CHECK(scaled_runs(set).empty());
}

TEST_CASE("another regime in a corner is suspected, but lies at its end", "[uq]") {
  const surrogate::TrainingSet set = runs_of(regime, 2);
  const std::vector<int> suspects = scaled_runs(set);
  REQUIRE(!suspects.empty());
  const auto end = at_one_end(set.x, suspects);
  REQUIRE(end);
  CHECK(!end->low);
}

TEST_CASE("a common factor needs three runs that agree on it", "[uq]") {
  const auto three = common_factor({10.0, 20.0, 31.0}, {1.0, 2.0, 3.0});
  REQUIRE(three);
  CHECK(three->factor == Approx(10.0));
  CHECK(three->runs == 3);
  CHECK(!common_factor({10.0, 20.0}, {1.0, 2.0}));
  CHECK(!common_factor({10.0, 20.0, 90.0}, {1.0, 2.0, 3.0}));
}
