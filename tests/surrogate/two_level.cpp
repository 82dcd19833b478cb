#include "surrogate/two_level.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "data/error.hpp"
#include "data/random.hpp"
#include "surrogate/design.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;
using namespace surrogate;

namespace {

// A slice under a machine: the machine's torque is 2.5 times the slice's plus a slow drift.
double slice(const VectorXd& x) { return 1.0 + std::sin(5.0 * x[0]) * (0.5 + x[1]); }
double machine(const VectorXd& x) { return 2.5 * slice(x) + 0.4 * x[0] + 0.3 * x[1] * x[1]; }

template <class Function>
TrainingSet runs_of(Function function, int runs, double noise_sd, std::uint64_t seed, int inputs = 2) {
  data::RandomStream random(seed, data::Purpose::test, 3);
  TrainingSet training{scrambled_sobol(runs, inputs, seed), VectorXd(runs),
                       VectorXd::Constant(runs, noise_sd * noise_sd)};
  for (int i = 0; i < runs; ++i) training.y[i] = function(VectorXd(training.x.row(i))) + noise_sd * random.normal();
  return training;
}

double rmse(const VectorXd& predicted, const MatrixXd& points) {
  double sum = 0.0;
  for (int i = 0; i < points.rows(); ++i) sum += std::pow(predicted[i] - machine(points.row(i)), 2);
  return std::sqrt(sum / static_cast<double>(points.rows()));
}

}  // namespace

TEST_CASE(
    "a handful of dear runs over many cheap ones predicts better than either level alone, and finds their ratio") {
  const TrainingSet low = runs_of(slice, 60, 0.02, 1), high = runs_of(machine, 8, 0.03, 2);
  const GaussianProcess cheap = fit(low, {.starts = 3});
  const TwoLevelProcess two = fit_two_level(cheap, high);
  const MatrixXd points = scrambled_sobol(200, 2, 77);
  const double together = rmse(two.predict(points).mean, points),
               dear_alone = rmse(fit(high, {.starts = 3}).predict(points).mean, points);
  // The cheap level alone, brought to the dear one's level by a straight line through the dear runs.
  MatrixXd line(8, 2);
  line << VectorXd::Ones(8), cheap.predict(high.x).mean;
  const Eigen::Vector2d coefficients = line.colPivHouseholderQr().solve(high.y);
  const VectorXd scaled = (coefficients[0] + coefficients[1] * cheap.predict(points).mean.array()).matrix();
  CAPTURE(together, dear_alone, rmse(scaled, points), two.parameters().rho, two.mean_rho());
  CHECK(together < 0.25 * dear_alone);
  CHECK(together < 0.75 * rmse(scaled, points));
  CHECK(two.parameters().rho == Approx(2.5).epsilon(0.1));
  CHECK(two.mean_rho() == Approx(2.5).epsilon(0.1));
  // The discrepancy, 0.4 x + 0.3 y^2, at the corners where it differs most.
  const MatrixXd corners = (MatrixXd(2, 2) << 0.1, 0.1, 0.9, 0.9).finished();
  const VectorXd found = two.predict(corners).mean - 2.5 * cheap.predict(corners).mean;
  CHECK(found[1] - found[0] == Approx(0.32 + 0.3 * 0.8).margin(0.2));
}

TEST_CASE("90 % intervals of the dear level cover 90 %, integrated over its parameters", "[slow]") {
  // Functions drawn from the model: both levels' processes with known length scales, the rest from the priors' middle.
  constexpr int draws = 200, cheap_runs = 30, tests = 20;
  double plugged = 0.0, integrated = 0.0;
  for (std::uint64_t draw = 0; draw < draws; ++draw) {
    data::RandomStream random(draw, data::Purpose::test, 6);
    const int dear_runs = 5 + static_cast<int>(draw % 4);
    const int n = cheap_runs + dear_runs + tests;
    MatrixXd x(n, 2);
    x << scrambled_sobol(cheap_runs, 2, draw), scrambled_sobol(dear_runs, 2, draw + 300),
        scrambled_sobol(tests, 2, draw + 600);
    const double rho = 1.0 + 0.5 * random.normal(), q = 2.0 * std::exp(0.5 * random.normal());
    const double s = 0.3 * std::abs(rho) * std::exp(0.7 * random.normal());
    const auto draw_process = [&](double length, double sd) -> VectorXd {
      MatrixXd covariance(n, n);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          double square = (x.row(i) - x.row(j)).squaredNorm() / (length * length), value = 0.0;
          correlate(Kernel::matern52, {{&square, 1}, {&value, 1}, {nullptr, 0}});
          covariance(i, j) = value + (i == j ? 1e-9 : 0.0);
        }
      VectorXd normal(n);
      for (double& value : normal) value = random.normal();
      return sd * (MatrixXd(covariance.llt().matrixL()) * normal);
    };
    const VectorXd cheap = draw_process(0.6, 1.0), dear = rho * cheap + draw_process(0.6 * q, s);
    TrainingSet low{x.topRows(cheap_runs), cheap.head(cheap_runs), VectorXd::Constant(cheap_runs, 4e-4)};
    TrainingSet high{x.middleRows(cheap_runs, dear_runs), dear.segment(cheap_runs, dear_runs),
                     VectorXd::Constant(dear_runs, 1e-3)};
    for (double& y : low.y) y += 0.02 * random.normal();
    for (double& y : high.y) y += std::sqrt(1e-3) * random.normal();
    const GaussianProcess process = fit(low, {.starts = 2});
    for (const HyperUncertainty how : {HyperUncertainty::plug_in, HyperUncertainty::integrated}) {
      const Prediction p = fit_two_level(process, high, {.hyper_uncertainty = how}).predict(x.bottomRows(tests));
      const double inside = static_cast<double>(
          ((dear.tail(tests) - p.mean).array().abs() <= 1.6449 * p.covariance.diagonal().array().sqrt()).count());
      (how == HyperUncertainty::plug_in ? plugged : integrated) += inside / (draws * tests);
    }
  }
  CAPTURE(plugged, integrated);
  CHECK(integrated > plugged);
  CHECK(integrated > 0.88);
  CHECK(integrated < 0.94);
}

TEST_CASE("90 % intervals hold where the levels differ by what is no draw from the model", "[slow]") {
  // Torques of friction, cohesion and speed, and a cheaper level of an interplay or of another power.
  using Law = double (*)(const VectorXd&);
  const std::vector<Law> torques{
      [](const VectorXd& x) {
        const double speed = 2.0 * x[2] - 1.0, cohesion = 10.0 / 6.0 * x[1];
        return 8.0 * std::sqrt((1.0 + cohesion) * (0.25 + 1.75 * x[0])) * (1.0 + 0.12 * speed - 0.3 * speed * cohesion);
      },
      [](const VectorXd& x) {
        return 12.0 * std::pow(0.1 + 0.7 * x[0] + 0.5 * x[1], 0.6) * (1.0 + 0.2 / (0.63 + 1.67 * x[2]));
      }};
  const std::vector<std::function<double(double, const VectorXd&)>> cheaper{
      [](double y, const VectorXd& x) { return 0.8 * y + 1.0 + (0.05 + 0.35 * x[0]) * (2.0 * x[2] - 1.0); },
      [](double y, const VectorXd&) { return 3.0 * std::pow(y, 0.6); }};
  int inside = 0, all = 0;
  for (const Law torque : torques)
    for (const auto& other : cheaper)
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const TrainingSet low =
            runs_of([&](const VectorXd& x) { return other(torque(x), x); }, 80, 0.15, seed + 100, 3);
        const TrainingSet high = runs_of(torque, 14, 0.08, seed, 3);
        const MatrixXd points = scrambled_sobol(64, 3, seed + 500);
        const Prediction found = fit_two_level(fit(low, {.starts = 2}), high).predict(points);
        for (int i = 0; i < points.rows(); ++i, ++all)
          inside += std::abs(torque(points.row(i)) - found.mean[i]) < 1.6449 * std::sqrt(found.covariance(i, i));
      }
  CAPTURE(inside, all);
  CHECK(inside > 0.89 * all);
}

TEST_CASE("a two-level prediction is that of the joint normal density of all runs of both levels") {
  // Kennedy & O'Hagan's joint covariance, with the zero-mean processes written out in full.
  const TrainingSet low = runs_of(slice, 15, 0.05, 3), high = runs_of(machine, 4, 0.04, 4);
  HyperParameters hyper;
  hyper.length_scales = Eigen::Vector2d(0.5, 0.9);
  hyper.signal_sd = 1.2;
  hyper.nugget_sd = 0.02;
  const GaussianProcess process = condition(low, {Kernel::matern52, MeanBasis::zero, OutputScale::linear}, hyper);
  const TwoLevelParameters p{.rho = 2.2, .length_factor = 1.7, .discrepancy_sd = 0.5, .nugget_sd = 0.03};
  const TwoLevelProcess two(process, {.runs = high, .discrepancy_mean = MeanBasis::zero, .settings = {p}});
  const MatrixXd points = scrambled_sobol(3, 2, 5);

  const auto kernel = [&](const VectorXd& a, const VectorXd& b, double factor) {
    double square = ((a - b).array() / (factor * hyper.length_scales.array())).square().sum(), value = 0.0;
    correlate(Kernel::matern52, {{&square, 1}, {&value, 1}, {nullptr, 0}});
    return value;
  };
  MatrixXd all(22, 2);
  all << low.x, high.x, points;
  const auto level = [](int i) { return i < 15 ? 1.0 : 2.2; };
  MatrixXd joint(22, 22);
  for (int i = 0; i < 22; ++i)
    for (int j = 0; j < 22; ++j) {
      const VectorXd a = all.row(i), b = all.row(j);
      joint(i, j) = level(i) * level(j) * 1.44 * kernel(a, b, 1.0);
      if (i >= 15 && j >= 15) joint(i, j) += 0.25 * kernel(a, b, 1.7);
    }
  MatrixXd data = joint.topLeftCorner(19, 19);
  data.diagonal().head(15).array() += 0.05 * 0.05 + 0.02 * 0.02;
  data.diagonal().tail(4).array() += 0.04 * 0.04 + 0.03 * 0.03;
  VectorXd y(19);
  y << low.y, high.y;
  const MatrixXd cross = joint.topRightCorner(19, 3);
  const Eigen::LLT<MatrixXd> factor(data);
  const VectorXd mean = cross.transpose() * factor.solve(y);
  const MatrixXd covariance = joint.bottomRightCorner(3, 3) - cross.transpose() * factor.solve(cross);
  const Prediction found = two.predict(points);
  CHECK((found.mean - mean).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((found.covariance - covariance).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("too few high-level runs, and other columns than the low level's, are bad input") {
  const GaussianProcess low = fit(runs_of(slice, 20, 0.02, 1), {.starts = 1});
  CHECK_THROWS_WITH(fit_two_level(low, runs_of(machine, 2, 0.03, 2)), Catch::Contains("2 high-level runs"));
  TrainingSet high = runs_of(machine, 5, 0.03, 2);
  high.x.conservativeResize(Eigen::NoChange, 1);
  CHECK_THROWS_AS(fit_two_level(low, high), data::InputError);
}

TEST_CASE("gradients and batches of a two-level process agree with single predictions") {
  const TwoLevelProcess two =
      fit_two_level(fit(runs_of(slice, 30, 0.02, 1), {.starts = 1}), runs_of(machine, 6, 0.03, 2));
  const MatrixXd points = scrambled_sobol(6, 2, 8);
  const std::vector<Prediction> batch = two.predict_batch(points, 3);
  const Prediction second = two.predict(points.bottomRows(3));
  CHECK((batch[1].mean - second.mean).cwiseAbs().maxCoeff() < 1e-10);
  CHECK((batch[1].covariance - second.covariance).cwiseAbs().maxCoeff() < 1e-10);
  const std::vector<int> coordinates{1};
  const PredictionGradient gradient = two.predict_with_gradient(points, coordinates);
  MatrixXd moved = points;
  moved.col(1).array() += 1e-3;
  const VectorXd difference = (two.predict(moved).mean - gradient.value.mean) / 1e-3;
  CHECK((gradient.mean_gradient[0] - difference).cwiseAbs().maxCoeff() < 0.02);
}

TEST_CASE("a two-level process is judged by its dear runs, each held out in turn") {
  const GaussianProcess low = fit(runs_of(slice, 60, 0.02, 1), {.starts = 2});
  const TwoLevelProcess good = fit_two_level(low, runs_of(machine, 9, 0.03, 2));
  const Validation validation = validate(good, {});
  CAPTURE(validation.finding, validation.q2_function);
  CHECK(validation.folds.size() == 9);
  CHECK(validation.q2_function > 0.95);
  CHECK(validation.verdict != SurrogateVerdict::unusable);
  // A dear level that has nothing to do with the cheap one.
  const auto other = [](const VectorXd& x) { return std::cos(40.0 * x[0] * x[1]); };
  CHECK(validate(fit_two_level(low, runs_of(other, 9, 0.03, 2)), {}).verdict != SurrogateVerdict::good);
}
