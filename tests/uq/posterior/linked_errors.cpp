// Errors of different outputs that go together at one setting: closed forms, differences, and whether intervals hold.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "data/error.hpp"
#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "surrogate/fit.hpp"
#include "tests/uq/formula_study.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/predictive.hpp"

using namespace uq;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

const std::vector<double> speeds{0.0, 0.5, 1.0};
constexpr double torque_sd = 0.3, angle_sd = 0.2;

/// Torque and angle of one picture at each speed, with errors of correlation `r`.
data::Study pictures(double a, double b, double r, data::RandomStream& random) {
  data::Study study = formula::study({}, {}, torque_sd);
  data::ObservationSet& set = study.observations[0];
  set.outputs = {0, 1};
  for (const double x : speeds) {
    const double first = random.normal(), second = r * first + std::sqrt(1.0 - r * r) * random.normal();
    set.points.push_back(
        {.controls = {x},
         .values = {formula::torque(a, b, x) + torque_sd * first, formula::angle(a, b, x) + angle_sd * second},
         .standard_errors = {torque_sd, angle_sd}});
  }
  return study;
}

void correlate(data::Study& study, double r) {
  study.observations[0].correlations = {
      {.output = 0, .other_output = 1, .other_set = study.observations[0].name, .value = r}};
}

/// Sum over the speeds of the logarithm of the bivariate normal density.
double by_hand(const data::Study& study, double a, double b, double r) {
  double sum = 0.0;
  for (const data::Observation& point : study.observations[0].points) {
    const double x = point.controls[0], first = (point.values[0] - formula::torque(a, b, x)) / torque_sd,
                 second = (point.values[1] - formula::angle(a, b, x)) / angle_sd;
    sum -= 0.5 * (first * first - 2.0 * r * first * second + second * second) / (1.0 - r * r) +
           std::log(2.0 * std::numbers::pi * torque_sd * angle_sd * std::sqrt(1.0 - r * r));
  }
  return sum;
}

/// Processes over (a, b, speed) that learnt the two formulas.
std::vector<Emulator> processes() {
  std::vector<Emulator> all = formula::emulators();
  for (std::size_t output = 0; output < 2; ++output) {
    surrogate::TrainingSet runs{surrogate::scrambled_sobol(30, 3, 5), VectorXd(30), VectorXd::Constant(30, 1e-3)};
    for (Eigen::Index i = 0; i < 30; ++i)
      runs.y[i] = (output == 0 ? formula::torque : formula::angle)(runs.x(i, 0), runs.x(i, 1), runs.x(i, 2));
    Emulator learnt =
        make_emulator(std::make_shared<const surrogate::GaussianProcess>(surrogate::fit(runs, {.starts = 1})), "",
                      output, all[output].inputs);
    learnt.control_range = all[output].control_range;
    all[output] = learnt;
  }
  return all;
}

}  // namespace

TEST_CASE("readings with linked errors have the density of their bivariate normal law", "[uq]") {
  data::RandomStream random(1, data::Purpose::test);
  data::Study study = pictures(0.4, 0.6, 0.7, random);
  correlate(study, 0.7);
  const CaseModel model = build_case(study, formula::emulators(), 0);
  REQUIRE(model.linked_errors.size() == speeds.size());
  const MatrixXd points = surrogate::scrambled_sobol(5, 2, 1);
  const VectorXd batch = log_likelihoods(model, points);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const double exact = by_hand(study, points(i, 0), points(i, 1), 0.7);
    CHECK(log_likelihood(model, points.row(i).transpose()) == Approx(exact).epsilon(1e-12));
    CHECK(batch[i] == Approx(exact).epsilon(1e-12));
  }
}

TEST_CASE("readings of two files are one where their settings are, in order", "[uq]") {
  data::RandomStream random(1, data::Purpose::test);
  data::Study study = pictures(0.4, 0.6, 0.5, random);
  data::ObservationSet& torques = study.observations[0];
  data::ObservationSet angles{.name = "angles", .file = "angles.csv", .outputs = {1}};
  torques.outputs = {0};
  for (auto point = torques.points.rbegin(); point != torques.points.rend(); ++point)
    angles.points.push_back(
        {.controls = point->controls, .values = {point->values[1]}, .standard_errors = {point->standard_errors[1]}});
  for (data::Observation& point : torques.points) {
    point.values.pop_back();
    point.standard_errors.pop_back();
  }
  torques.points.push_back({.controls = {0.5}, .values = {17.0}, .standard_errors = {torque_sd}});  // and no angle
  angles.correlations = {{.output = 1, .other_output = 0, .other_set = "bench", .value = 0.5}};
  study.observations.push_back(angles);
  study.cases[0].observe = {"bench", "angles"};
  const CaseModel model = build_case(study, formula::emulators(), 0);
  const std::vector<RowOrigin> from = origins(model);
  REQUIRE(model.linked_errors.size() == 3);
  for (const LinkedErrors& pair : model.linked_errors) {
    CHECK(from[pair.first].set == 1);
    CHECK(from[pair.second].set == 0);
    CHECK(from[pair.first].point + from[pair.second].point == 2);  // the angles stand in the opposite order
  }
}

TEST_CASE("the gradient of linked errors is that of differences, with their size unknown", "[uq]") {
  data::RandomStream random(1, data::Purpose::test);
  data::Study study = pictures(0.4, 0.6, 0.7, random);
  correlate(study, 0.7);
  data::Parameter noise{.name = "noise", .target = "noise", .low = 0.1, .high = 10.0, .scale = data::Scale::log};
  noise.prior = {.kind = data::PriorKind::log_normal, .low = 0.1, .high = 10.0, .mean = 1.0, .sd = 0.5};
  study.cases[0].nuisances = {{data::NuisanceKind::noise_scale, {}, noise}};
  for (const std::vector<Emulator>& emulators : {formula::emulators(0.1), processes()}) {
    const CaseModel model = build_case(study, emulators, 0);
    REQUIRE(model.dimension() == 3);
    const VectorXd u = Eigen::Vector3d(0.35, 0.55, 0.45);
    const Evaluation found = log_likelihood_gradient(model, u);
    CHECK(found.value == Approx(log_likelihood(model, u)).epsilon(1e-12));
    for (int s = 0; s < 3; ++s) {
      VectorXd up = u, down = u;
      up[s] += 1e-5;
      down[s] -= 1e-5;
      const double difference = (log_likelihood(model, up) - log_likelihood(model, down)) / 2e-5;
      CHECK(found.gradient[s] == Approx(difference).epsilon(1e-4).margin(1e-4));
    }
  }
}

TEST_CASE("replicate data have the linked errors' correlation, and no other", "[uq]") {
  data::RandomStream random(1, data::Purpose::test);
  data::Study study = pictures(0.4, 0.6, 0.7, random);
  correlate(study, 0.7);
  const CaseModel model = build_case(study, formula::emulators(), 0);
  const MatrixXd draws = Eigen::RowVector2d(0.4, 0.6).replicate(4000, 1);
  MatrixXd made = replicates(model, draws, 1);
  made.rowwise() -= made.colwise().mean().eval();
  const MatrixXd covariance = made.transpose() * made / 4000.0;
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < i; ++j)  // torques in the first three rows, angles in the last
      CHECK(covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j)) ==
            Approx(i == j + 3 ? 0.7 : 0.0).margin(0.06));
}

TEST_CASE(
    "intervals hold the truth as often as they say where errors are linked, and less often where that is not said",
    "[uq]") {
  // Steep in the same direction, so that the two outputs of a picture tell nearly the same of b.
  constexpr int truths = 400, grid = 48;
  int inside = 0, inside_unlinked = 0;
  for (int t = 0; t < truths; ++t) {
    data::RandomStream random(static_cast<std::uint64_t>(t), data::Purpose::test, 4);
    const double a = random.uniform(), b = random.uniform();
    data::Study study = pictures(a, b, -0.9, random);
    for (const bool linked : {true, false}) {
      if (linked)
        correlate(study, -0.9);
      else
        study.observations[0].correlations.clear();
      const CaseModel model = build_case(study, formula::emulators(), 0);
      MatrixXd points(grid * grid, 2);
      for (int i = 0; i < grid * grid; ++i) points.row(i) << (i / grid + 0.5) / grid, (i % grid + 0.5) / grid;
      VectorXd weight = log_likelihoods(model, points);
      weight = (weight.array() - weight.maxCoeff()).exp();
      // The share of the posterior of b below the truth.
      const double below = weight.dot((points.col(1).array() < b).cast<double>().matrix()) / weight.sum();
      (linked ? inside : inside_unlinked) += below > 0.05 && below < 0.95 ? 1 : 0;
    }
  }
  CAPTURE(inside, inside_unlinked);
  CHECK(std::abs(inside - 0.9 * truths) < 3.0 * std::sqrt(truths * 0.9 * 0.1));
  CHECK(inside_unlinked < 0.85 * truths);
}

TEST_CASE("correlations that no errors can have together are refused", "[uq]") {
  data::RandomStream random(1, data::Purpose::test);
  data::Study study = pictures(0.4, 0.6, 0.0, random);
  data::ObservationSet again = study.observations[0];
  again.name = "again";
  again.file = "again.csv";
  for (data::Observation& point : again.points) point.values[0] += 0.1;
  study.observations.push_back(again);
  study.cases[0].observe = {"bench", "again"};
  const auto link = [](std::size_t output, const char* set, double value) {
    return data::ErrorCorrelation{
        .output = output, .other_output = 1, .other_set = set, .value = value, .place = "study.toml:9"};
  };
  study.observations[0].correlations = {link(0, "bench", 0.9), link(0, "again", 0.9)};
  study.observations[1].correlations = {link(1, "bench", -0.9)};
  CHECK_THROWS_WITH(
      build_case(study, formula::emulators(), 0),
      Catch::Contains("study.toml:9") && Catch::Contains("correlations of case 'powder' contradict each other"));
}
