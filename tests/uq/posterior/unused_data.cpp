#include "uq/posterior/unused_data.hpp"

#include <gsl/gsl_cdf.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "tests/uq/formula_study.hpp"

using namespace uq;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr int grid = 60;     // points a side, of the exact posterior
constexpr double sd = 0.08;  // of each reading
const std::vector<double> used{0.0, 0.3, 0.6, 0.9}, unused{0.15, 0.45, 1.0};

/// A study that measured torque at the used speeds and holds the unused ones back.
data::Study made(double a, double b, double shared, data::RandomStream& random) {
  const double error = shared * random.normal();  // of the surrogate: the same at every speed
  const auto read = [&](double x) { return formula::torque(a, b, x) + error + sd * random.normal(); };
  std::vector<double> values;
  for (const double x : used) values.push_back(read(x));
  data::Study study = formula::study(used, values, sd);
  data::ObservationSet later{.name = "later", .file = "later.csv", .outputs = {0}};
  for (const double x : unused) later.points.push_back({.controls = {x}, .values = {read(x)}, .standard_errors = {sd}});
  study.observations.push_back(later);
  study.unused_data = {{.name = "later", .case_index = 0, .observe = {"later"}}};
  return study;
}

/// Log likelihood at (a, b) with readings that share an error: by the closed form of a constant covariance.
double log_likelihood_of(const data::Study& study, double shared, double a, double b) {
  double squares = 0.0, sum = 0.0;
  for (const data::Observation& point : study.observations[0].points) {
    const double away = point.values[0] - formula::torque(a, b, point.controls[0]);
    squares += away * away;
    sum += away;
  }
  const double n = static_cast<double>(used.size()), v = sd * sd, s = shared * shared;
  return -0.5 * (squares / v - s / (v * (v + n * s)) * sum * sum);
}

/// Points of the posterior on the grid, each as often as its weight says.
MatrixXd posterior(const data::Study& study, double shared, int count) {
  std::vector<double> weight;
  double total = 0.0;
  for (int i = 0; i < grid * grid; ++i) {
    weight.push_back(std::exp(log_likelihood_of(study, shared, (i / grid + 0.5) / grid, (i % grid + 0.5) / grid)));
    total += weight.back();
  }
  MatrixXd draws(count, 2);
  double reached = 0.0;
  int next = 0;
  for (int i = 0; i < grid * grid; ++i) {
    reached += weight[i] / total;
    for (; next < count && (next + 0.5) / count <= reached + 1e-12; ++next)
      draws.row(next) << (i / grid + 0.5) / grid, (i % grid + 0.5) / grid;
  }
  return draws.topRows(next);
}

PredictionReport predicted(const data::Study& study, double shared) {
  const auto emulators = formula::emulators(shared);
  return predict_unused(study, emulators, study.unused_data.front(), build_case(study, emulators, 0),
                        posterior(study, shared, 400));
}

}  // namespace

TEST_CASE(
    "the prediction of an unused reading is that of the exact posterior, its surrogate's error shared with the data") {
  const double shared = 0.1;
  data::RandomStream random(5, data::Purpose::test, 1);
  const data::Study study = made(0.4, 0.55, shared, random);
  const PredictionReport found = predicted(study, shared);
  REQUIRE(found.points.size() == unused.size());
  for (std::size_t j = 0; j < unused.size(); ++j) {
    // Mean and variance over the grid of m(x) + what the data's residuals say of the shared error.
    const double n = static_cast<double>(used.size()), v = sd * sd, s = shared * shared, gain = s / (v + n * s);
    double total = 0.0, mean = 0.0, square = 0.0;
    for (int i = 0; i < grid * grid; ++i) {
      const double a = (i / grid + 0.5) / grid, b = (i % grid + 0.5) / grid;
      double residuals = 0.0;
      for (const data::Observation& point : study.observations[0].points)
        residuals += point.values[0] - formula::torque(a, b, point.controls[0]);
      const double weight = std::exp(log_likelihood_of(study, shared, a, b));
      const double value = formula::torque(a, b, unused[j]) + gain * residuals;
      total += weight;
      mean += weight * value;
      square += weight * (value * value + s - n * gain * s + v);
    }
    mean /= total;
    const double exact_sd = std::sqrt(square / total - mean * mean);
    INFO("at " << unused[j] << ": " << found.points[j].point.mean << " for " << mean << ", sd " << exact_sd);
    CHECK(std::abs(found.points[j].point.mean - mean) < 0.03 * exact_sd);
    CHECK(std::abs(found.points[j].point.q95 - found.points[j].point.q05 - 2.0 * 1.6449 * exact_sd) < 0.1 * exact_sd);
    CHECK(found.points[j].z == Approx((found.points[j].point.observed - mean) / exact_sd).margin(0.1));
  }
}

TEST_CASE("nine in ten unused readings lie inside, and one prediction in a hundred is rejected") {
  const double shared = 0.1;
  int inside = 0, of = 0, rejected = 0;
  constexpr int sets = 300;
  for (int i = 0; i < sets; ++i) {
    data::RandomStream random(6, data::Purpose::test, static_cast<std::uint32_t>(i));
    const double a = random.uniform(), b = random.uniform();
    const PredictionReport found = predicted(made(a, b, shared, random), shared);
    inside += found.inside;
    of += static_cast<int>(found.points.size());
    rejected += found.predicts ? 0 : 1;
  }
  INFO(inside << " of " << of << " inside, " << rejected << " of " << sets << " rejected");
  CHECK(std::abs(inside / static_cast<double>(of) - 0.9) < 0.045);  // three binomial errors of 300 correlated triples
  CHECK(rejected <= 10);
}

TEST_CASE("readings of another law are rejected, and the farthest is named") {
  data::RandomStream random(7, data::Purpose::test, 1);
  data::Study study = made(0.4, 0.55, 0.0, random);
  study.observations[1].points[2].values[0] += 8.0 * sd;
  const PredictionReport found = predicted(study, 0.0);
  CHECK_FALSE(found.predicts);
  CHECK(found.sentence.find("does not predict") != std::string::npos);
  CHECK(found.sentence.find("torque at speed 1,") != std::string::npos);
}

TEST_CASE(
    "an error that the case's own data do not have widens the prediction: of another meter, of the machine's scale") {
  data::RandomStream random(6, data::Purpose::test, 2);
  const data::Study plain = made(0.4, 0.55, 0.0, random);
  const auto width_of = [](const PredictedPoint& one) { return (one.point.q95 - one.point.q05) / (2.0 * 1.645); };
  constexpr double error = 0.05, scale = 20.0;

  data::Study metered = plain;
  metered.observations[1].common_errors = {{0, {.relative = error}}};
  metered.observations[1].meter = "new-cell";

  data::Study machine = plain;
  data::Parameter unknown{.name = "scale", .target = "scale", .low = 14.0, .high = 26.0};
  unknown.prior = {.kind = data::PriorKind::normal, .low = 14.0, .high = 26.0, .mean = scale, .sd = error * scale};
  machine.scale = {.value = scale, .unknown = data::Nuisance{data::NuisanceKind::scale, 0, unknown}};
  machine.observations[1].of_machine = true;
  for (data::Observation& point : machine.observations[1].points) {
    point.values[0] *= scale;
    point.standard_errors[0] *= scale;
  }

  const PredictionReport before = predicted(plain, 0.0);
  for (const auto& [study, factor] : {std::pair{metered, 1.0}, {machine, scale}}) {
    const PredictionReport after = predicted(study, 0.0);
    for (std::size_t j = 0; j < unused.size(); ++j) {
      const double mean = before.points[j].point.mean;
      CHECK(after.points[j].point.mean == Approx(factor * mean).epsilon(1e-3));
      CHECK(width_of(after.points[j]) ==
            Approx(factor * std::hypot(width_of(before.points[j]), error * mean)).epsilon(0.02));
    }
  }
}

TEST_CASE("where the noise is unknown, a prediction is judged by the tails of its mixture") {
  // a and b known, errors k s with k drawn: chi-squared is k^2 / mean(k^2) times a chi-squared variable of three.
  data::RandomStream random(7, data::Purpose::test, 1);
  data::Study study = made(0.4, 0.55, 0.0, random);
  data::Parameter factor{.name = "k", .target = "k", .low = 0.0, .high = 10.0};
  factor.prior = {.low = 0.0, .high = 10.0};
  study.cases[0].nuisances = {{data::NuisanceKind::noise_scale, {}, factor}};
  MatrixXd draws(400, 3);
  VectorXd square(400);
  for (int i = 0; i < 400; ++i) {
    const double k = std::exp(0.8 * random.normal());
    square[i] = std::min(k * k, 99.0);
    draws.row(i) << 0.4, 0.55, std::sqrt(square[i]) / 10.0;
  }
  for (const double off : {1.0, 3.0, 6.0}) {
    for (std::size_t j = 0; j < unused.size(); ++j)
      study.observations[1].points[j].values[0] = formula::torque(0.4, 0.55, unused[j]) + off * sd;
    const auto emulators = formula::emulators(0.0);
    const PredictionReport found =
        predict_unused(study, emulators, study.unused_data.front(), build_case(study, emulators, 0), draws);
    const double chi2 = 3.0 * off * off;  // over k^2
    double exact = 0.0;
    for (const double k2 : square) exact += gsl_cdf_chisq_Q(chi2 / k2, 3.0) / 400.0;
    INFO(off << ": " << found.p << " for " << exact);
    CHECK(found.p == Approx(exact).margin(4.0 * std::sqrt(exact * (1.0 - exact) / 10000.0)));
  }
}

TEST_CASE("readings where no run speaks are counted, and said to be extrapolated") {
  data::RandomStream random(5, data::Purpose::test, 3);
  const data::Study study = made(0.4, 0.55, 0.1, random);
  auto emulators = formula::emulators(0.1);
  auto cloud = std::make_shared<RunCloud>();
  cloud->points = surrogate::scrambled_sobol(60, 3, 1, 0);
  cloud->points.col(2) *= 0.7;  // of the unused speeds 1.0 lies beyond
  cloud->length_scales = Eigen::Vector3d::Ones();
  cloud->prior_variance = 100.0;
  for (Emulator& one : emulators) one.runs = cloud;
  const PredictionReport found = predict_unused(study, emulators, study.unused_data.front(),
                                                build_case(study, emulators, 0), posterior(study, 0.1, 400));
  CHECK(found.unsupported == 1);
  CHECK_THAT(found.sentence, Catch::Contains("No run speaks at 1 of them"));
  CHECK(predicted(study, 0.1).unsupported == 0);
}
