// Masses of normal hills by the normal distribution; what counts as a hill of its own.
#include "uq/verdict/hills.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"
#include "tests/uq/formula_study.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/profile.hpp"

using namespace uq;
using Eigen::VectorXd;

namespace {

/// -2 log of a sum of normal densities (weight, mean, sd), less its least, on an even grid of [0, 1].
VectorXd deviance_of(const VectorXd& u, const std::vector<std::array<double, 3>>& hills) {
  VectorXd deviance(u.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    double sum = 0.0;
    for (const auto& [weight, mean, sd] : hills) sum += weight / sd * std::exp(-0.5 * std::pow((u[i] - mean) / sd, 2));
    deviance[i] = -2.0 * std::log(sum + 1e-80);
  }
  return deviance.array() - deviance.minCoeff();
}

}  // namespace

TEST_CASE("hills of a mixture of normal densities have its weights", "[uq]") {
  const VectorXd u = VectorXd::LinSpaced(201, 0.0, 1.0), flat = VectorXd::Zero(201);
  const std::vector<Hill> hills =
      find_hills(u, deviance_of(u, {{0.03, 0.2, 0.02}, {0.9, 0.5, 0.03}, {0.07, 0.85, 0.04}}), flat);
  REQUIRE(hills.size() == 3);
  CHECK(hills[0].mass == Approx(0.03).epsilon(0.02));
  CHECK(hills[1].mass == Approx(0.90).epsilon(0.02));
  CHECK(hills[2].mass == Approx(0.07).epsilon(0.02));
  CHECK(u[hills[0].best] == Approx(0.2));
  CHECK(hills[0].first == 0);
  CHECK(hills[0].last == hills[1].first);
  CHECK(hills[2].last == 200);
  // A prior that falls by e per 0.1 moves mass: the means' ratios are e^3 and e^-3.5 but for the widths.
  VectorXd falling = -10.0 * u;
  const std::vector<Hill> moved = find_hills(u, deviance_of(u, {{0.03, 0.2, 0.02}, {0.97, 0.5, 0.03}}), falling);
  const double low = 0.03 * std::exp(-2.0 + 0.5 * 100.0 * 4e-4), high = 0.97 * std::exp(-5.0 + 0.5 * 100.0 * 9e-4);
  REQUIRE(moved.size() == 2);
  CHECK(moved[0].mass == Approx(low / (low + high)).epsilon(0.02));
}

TEST_CASE("what hardly falls on one side is no hill, and one at the end of the path is", "[uq]") {
  const VectorXd flat = VectorXd::Zero(7), u = VectorXd::LinSpaced(7, 0.0, 1.0);
  VectorXd deviance(7);
  deviance << 9.0, 3.0, 3.9, 0.0, 5.0, 8.0, 6.0;
  const std::vector<Hill> hills = find_hills(u, deviance, flat);
  REQUIRE(hills.size() == 2);
  CHECK(hills[0].best == 3);
  CHECK(hills[1].best == 6);
  CHECK(hills[1].peak == 8.0);
  deviance << 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0;
  REQUIRE(find_hills(u, deviance, flat).size() == 1);
  CHECK(find_hills(u, deviance, flat).front().mass == Approx(1.0));
}

TEST_CASE("a value that the 95 % interval excludes, and that holds a share of the posterior, is one of several",
          "[uq]") {
  // Two values of a fit; the second is off by so many of the reading's errors. One draw in fifty is about it.
  for (const auto& [apart, parts] : {std::pair{1.0, 2u}, {2.3, 2u}, {6.0, 1u}}) {
    data::RandomStream random(3, data::Purpose::test);
    Eigen::MatrixXd draws(200, 2);
    for (Eigen::Index i = 0; i < draws.rows(); ++i) {
      const bool second = i % 50 == 0 && parts > 1;
      draws.row(i) << (second ? 0.7 : 0.3) + 0.02 * random.normal(), random.uniform();
    }
    const double error = 0.01;
    const formula::Pair two{[apart = apart, error](double a, double, double) {
                              return 100.0 * std::pow((a - 0.3) * (a - 0.7), 2) + (a > 0.5 ? apart * error : 0.0);
                            },
                            formula::angle};
    const data::Study study = formula::study({0.5}, {0.0}, error);
    const CaseModel model = build_case(study, formula::emulators(0.0, two), 0);
    const Profiles all = profile_likelihood(model, {.draws = draws, .log_likelihood = log_likelihoods(model, draws)});
    INFO("apart by " << apart << " errors");
    CHECK(all.profiles[0].parts.size() == parts);
  }
}
