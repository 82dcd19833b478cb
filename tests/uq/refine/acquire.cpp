// The criterion of sequential training against brute force: outcomes of runs are drawn, the surrogate is told of them,
// and the variance of the density is taken from its law, with none of the formulas of uq/refine/acquire.hpp.
#include "uq/refine/acquire.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "data/random.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/refine/next_runs.hpp"

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double error_variance = 0.09;  // of each measured number
constexpr double run_variance = 0.01;    // of a run

/// A surrogate of f(theta, x) on the unit square from five runs.
surrogate::GaussianProcess make_process() {
  MatrixXd x(5, 2);
  x << 0.1, 0.2, 0.9, 0.3, 0.5, 0.8, 0.2, 0.9, 0.7, 0.6;
  VectorXd y(5);
  y << 0.3, 1.4, 0.9, 0.6, 1.2;
  const surrogate::HyperParameters hyper{
      .length_scales = Eigen::Vector2d(0.35, 0.6), .signal_sd = 0.8, .nugget_sd = 0.0, .mean_coefficients = {}};
  return surrogate::condition({x, y, VectorXd::Constant(5, run_variance)}, {}, hyper);
}

/// theta unknown, measured at two settings of the control x.
uq::CaseModel make_model(const surrogate::GaussianProcess& process) {
  uq::CaseModel model;
  data::Parameter parameter;
  parameter.name = "theta";
  model.unknowns.push_back({.label = "theta", .prior = uq::ScaledPrior(parameter, parameter.prior), .cut = {}});
  uq::RowGroup group{.emulator = uq::make_emulator(std::make_shared<const surrogate::GaussianProcess>(process), "", 0,
                                                   {{uq::InputKind::parameter, 0}, {uq::InputKind::control, 0}}),
                     .base = MatrixXd::Zero(2, 2),
                     .unknown = MatrixXd::Constant(2, 2, -1).cast<int>(),
                     .observed = Eigen::Vector2d(0.8, 1.0),
                     .variance = VectorXd::Constant(2, error_variance),
                     .origin = {{}, {}},
                     .coordinate = {}};
  group.unknown.col(0).setZero();
  group.base.col(1) = Eigen::Vector2d(0.25, 0.75);
  uq::find_coordinates(group, 1);
  model.groups.push_back(group);
  return model;
}

double normal_density(const VectorXd& r, const MatrixXd& covariance) {
  return std::exp(-0.5 * r.dot(covariance.inverse() * r)) /
         std::sqrt(std::pow(2.0 * std::numbers::pi, r.size()) * covariance.determinant());
}

/// Mean of the density and of its square at theta over draws of the surrogate's function.
struct Moments {
  double mean = 0.0, square = 0.0;
};
Moments density_moments(const uq::CaseModel& model, double theta, int draws) {
  const uq::RowGroup& group = model.groups.front();
  MatrixXd rows = group.base;
  rows.col(0).setConstant(theta);
  const surrogate::Prediction law = group.emulator.predict(rows);
  const MatrixXd root = law.covariance.llt().matrixL();
  data::RandomStream random(5, data::Purpose::test);
  Moments moments;
  for (int i = 0; i < draws; ++i) {
    const VectorXd f = law.mean + root * Eigen::Vector2d(random.normal(), random.normal());
    const double p = normal_density(group.observed - f, error_variance * MatrixXd::Identity(2, 2));
    moments.mean += p / draws;
    moments.square += p * p / draws;
  }
  return moments;
}

uq::ReferencePoints one_point(double theta) {
  return {.u = MatrixXd::Constant(1, 1, theta), .log_weight = VectorXd::Zero(1)};
}

uq::RunPoint run(double theta, double x) {
  return {.material = "", .parameters = VectorXd::Constant(1, theta), .controls = VectorXd::Constant(1, x)};
}

const std::vector<uq::RunNoise> noise{{.absolute = run_variance, .relative = 0.0}};

}  // namespace

TEST_CASE("the integrated variance of a density is that of draws of the surrogate's function", "[acquire]") {
  const uq::CaseModel model = make_model(make_process());
  for (const double theta : {0.35, 0.8}) {
    const Moments drawn = density_moments(model, theta, 400000);
    const uq::IntegratedVariance integral(model, one_point(theta), {}, noise);
    CHECK(integral.variance() == Approx(1.0 - drawn.mean * drawn.mean / drawn.square).margin(0.006));
  }
}

TEST_CASE("what a run is expected to take from the variance is the mean over its outcomes", "[acquire]") {
  const surrogate::GaussianProcess process = make_process();
  const uq::CaseModel model = make_model(process);
  const double theta = 0.35;
  const std::vector<uq::RunPoint> candidates{run(0.4, 0.5), run(0.9, 0.1), run(0.5, 0.8)};  // the last has a run
  const uq::IntegratedVariance integral(model, one_point(theta), candidates, noise);
  const VectorXd reductions = integral.reductions();
  const uq::RowGroup& group = model.groups.front();
  MatrixXd rows = group.base;
  rows.col(0).setConstant(theta);
  const surrogate::Prediction before = process.predict(rows);
  const MatrixXd error = error_variance * MatrixXd::Identity(2, 2);
  const double mean_square = density_moments(model, theta, 400000).square;
  const double square_before = std::pow(normal_density(group.observed - before.mean, before.covariance + error), 2);
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const VectorXd x = Eigen::Vector2d(candidates[c].parameters[0], candidates[c].controls[0]);
    const surrogate::Prediction at = process.predict(x.transpose());
    const double sd = std::sqrt(at.covariance(0, 0) + run_variance);
    // Outcomes at equal steps of their normal law, out to six sd: the rectangle rule, exact for such integrands.
    double square_after = 0.0;
    for (double z = -6.0; z <= 6.0; z += 0.05) {
      const surrogate::Prediction told = process.with_run(x, at.mean[0] + sd * z, run_variance).predict(rows);
      const double p = normal_density(group.observed - told.mean, told.covariance + error);
      square_after += 0.05 * std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi) * p * p;
    }
    CAPTURE(c);
    CHECK(reductions[c] * mean_square == Approx(square_after - square_before).epsilon(0.01).margin(1e-6));
    CHECK(reductions[c] > 0.0);
  }
}

TEST_CASE("runs of a batch take together what they take one after the other", "[acquire]") {
  const surrogate::GaussianProcess process = make_process();
  const uq::CaseModel model = make_model(process);
  uq::ReferencePoints reference{.u = VectorXd::LinSpaced(9, 0.1, 0.9), .log_weight = VectorXd::Zero(9)};
  const std::vector<uq::RunPoint> candidates{run(0.4, 0.5), run(0.8, 0.2), run(0.4, 0.5)};
  uq::IntegratedVariance one(model, reference, candidates, noise);
  const double start = one.variance();
  const double first = one.reductions()[0];
  one.add(0);
  CHECK(one.variance() == Approx(start - first).epsilon(1e-9));
  const double second = one.reductions()[1];
  one.add(1);
  CHECK(one.variance() == Approx(start - first - second).epsilon(1e-9));
  uq::IntegratedVariance other(model, reference, candidates, noise);
  other.add(1);
  other.add(0);
  CHECK(other.variance() == Approx(one.variance()).epsilon(1e-9));
  // A second run at the same place tells less than the first did, and not nothing: runs scatter.
  uq::IntegratedVariance twice(model, reference, candidates, noise);
  twice.add(0);
  CHECK(twice.reductions()[2] < first);
  CHECK(twice.reductions()[2] > 0.0);
}

TEST_CASE("a run without scatter at a point that has one tells nothing", "[acquire]") {
  MatrixXd x(3, 1);
  x << 0.1, 0.5, 0.9;
  const surrogate::HyperParameters hyper{
      .length_scales = VectorXd::Constant(1, 0.3), .signal_sd = 1.0, .nugget_sd = 0.0, .mean_coefficients = {}};
  const surrogate::GaussianProcess process =
      surrogate::condition({x, Eigen::Vector3d(0.2, 1.0, 0.4), VectorXd(0)}, {}, hyper);
  uq::CaseModel model = make_model(make_process());
  uq::RowGroup& group = model.groups.front();
  group.emulator = uq::make_emulator(std::make_shared<const surrogate::GaussianProcess>(process), "", 0,
                                     {{uq::InputKind::parameter, 0}});
  group.base = MatrixXd::Zero(2, 1);
  group.unknown = Eigen::MatrixXi::Zero(2, 1);
  uq::find_coordinates(group, 1);
  const uq::ReferencePoints reference{.u = VectorXd::LinSpaced(9, 0.1, 0.9), .log_weight = VectorXd::Zero(9)};
  const uq::IntegratedVariance integral(model, reference, {run(0.5, 0.0), run(0.3, 0.0)}, {uq::RunNoise{}});
  CHECK(std::abs(integral.reductions()[0]) < 1e-9);
  CHECK(integral.reductions()[1] > 1e-4);
}

TEST_CASE("reference points integrate a posterior density to its evidence", "[acquire]") {
  const uq::CaseModel model = make_model(make_process());
  // Evidence by the midpoint rule; draws by its quantiles.
  constexpr Index cells = 4000;
  const MatrixXd grid = VectorXd::LinSpaced(cells, 0.5 / cells, 1.0 - 0.5 / cells);
  const VectorXd density = uq::log_likelihoods(model, grid).array().exp();
  const double evidence = density.mean();
  MatrixXd draws(500, 1);
  double sum = 0.0;
  for (Index i = 0, j = 0; i < cells && j < 500; ++i) {
    sum += density[i] / density.sum();
    while (j < 500 && (static_cast<double>(j) + 0.5) / 500.0 < sum) draws(j++, 0) = grid(i, 0);
  }
  for (const double known : {std::log(evidence), std::numeric_limits<double>::quiet_NaN()}) {
    const uq::ReferencePoints found = uq::reference_points(model, draws, known, {.seed = 3});
    const VectorXd values = uq::log_likelihoods(model, found.u).array().exp();
    const double integral = (found.log_weight.array().exp() * values.array()).mean();
    CHECK(integral == Approx(evidence).epsilon(0.02));
  }
}

TEST_CASE("candidates whose control is free are spread over all of its range", "[acquire]") {
  const auto model = std::make_shared<const uq::CaseModel>(make_model(make_process()));
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    std::vector<double> free;
    uq::Acquisition acquisition;
    acquisition.cases = {{.model = model, .draws = VectorXd::LinSpaced(96, 0.2, 0.6), .log_evidence = std::nan("")}};
    acquisition.noise = [](const uq::Emulator&) { return noise.front(); };
    acquisition.rounded = [&free](const uq::RunPoint& point) {
      const double x = point.controls[0];
      if (x != 0.25 && x != 0.75) free.push_back(x);  // not at a measured setting
      return point;
    };
    uq::next_batch(acquisition, {.runs = 1, .seed = seed, .candidates = {.filling = 0, .replicates = 0}});
    std::sort(free.begin(), free.end());
    CAPTURE(seed, free.size());
    REQUIRE(free.size() >= 30);
    double widest = std::max(free.front(), 1.0 - free.back());
    for (std::size_t i = 1; i < free.size(); ++i) widest = std::max(widest, free[i] - free[i - 1]);
    CHECK(widest < 0.15);
  }
}

TEST_CASE("a batch goes where the posterior is open, and is the same again", "[acquire]") {
  const surrogate::GaussianProcess process = make_process();
  uq::Acquisition acquisition;
  const auto model = std::make_shared<const uq::CaseModel>(make_model(process));
  acquisition.cases = {{.model = model, .draws = VectorXd::LinSpaced(50, 0.2, 0.6), .log_evidence = std::nan("")}};
  acquisition.noise = [](const uq::Emulator&) { return noise.front(); };
  acquisition.existing = {run(0.1, 0.2), run(0.9, 0.3), run(0.5, 0.8)};
  const uq::Batch batch = uq::next_batch(acquisition, {.runs = 4, .seed = 9, .candidates = {}, .reference = {}});
  REQUIRE(batch.runs.size() == 4);
  CHECK(batch.variance_after[0] < batch.variance_before[0]);
  const uq::Batch again = uq::next_batch(acquisition, {.runs = 4, .seed = 9, .candidates = {}, .reference = {}});
  for (std::size_t i = 0; i < batch.runs.size(); ++i) CHECK(uq::same_run(batch.runs[i].point, again.runs[i].point));
  // The expected share is reached on average: tell the surrogate of outcomes of its own law, and look again.
  double after = 0.0;
  constexpr int worlds = 200;
  data::RandomStream random(11, data::Purpose::test);
  const uq::ReferencePoints reference =
      uq::reference_points(*model, acquisition.cases[0].draws, std::nan(""), {.seed = 9});
  uq::IntegratedVariance expected(*model, reference, {batch.runs[0].point, batch.runs[1].point}, noise);
  expected.add(0);
  expected.add(1);
  const auto total = [&](const uq::CaseModel& one) {  // integral of E p^2 minus (E p)^2, and of E p^2
    Eigen::Vector2d sums(0.0, 0.0);
    for (Index j = 0; j < reference.u.rows(); ++j) {
      const uq::RowGroup& group = one.groups.front();
      MatrixXd rows = group.base;
      rows.col(0).setConstant(reference.u(j, 0));
      const surrogate::Prediction law = group.emulator.predict(rows);
      const VectorXd r = group.observed - law.mean;
      const MatrixXd error = error_variance * MatrixXd::Identity(2, 2);
      const double square = normal_density(r, law.covariance + 0.5 * error) / (4.0 * std::numbers::pi * error_variance);
      const double mean = normal_density(r, law.covariance + error);
      sums += std::exp(reference.log_weight[j]) * Eigen::Vector2d(square - mean * mean, square);
    }
    return sums;
  };
  const double scale = total(*model)[1];
  for (int world = 0; world < worlds; ++world) {
    surrogate::GaussianProcess told = process;
    for (int i = 0; i < 2; ++i) {
      const uq::RunPoint& point = batch.runs[i].point;
      const VectorXd x = Eigen::Vector2d(point.parameters[0], point.controls[0]);
      const surrogate::Prediction at = told.predict(x.transpose());
      told =
          told.with_run(x, at.mean[0] + std::sqrt(at.covariance(0, 0) + run_variance) * random.normal(), run_variance);
    }
    after += total(make_model(told))[0] / scale / worlds;
  }
  CHECK(after == Approx(expected.variance()).epsilon(0.08));
}
