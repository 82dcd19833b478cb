#include "surrogate/marginal.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"
#include "surrogate/design.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;
using namespace surrogate;

namespace {

TrainingSet few_runs(int runs, std::uint64_t seed) {
  data::RandomStream random(seed, data::Purpose::test, 2);
  TrainingSet training{scrambled_sobol(runs, 1, seed), VectorXd(runs), VectorXd::Constant(runs, 1e-4)};
  for (int i = 0; i < runs; ++i) training.y[i] = std::sin(5.0 * training.x(i, 0)) + 0.01 * random.normal();
  return training;
}

double correlation(double distance, double length) {
  double square = distance * distance / (length * length), value = 0.0;
  correlate(Kernel::matern52, {{&square, 1}, {&value, 1}, {nullptr, 0}});
  return value;
}

}  // namespace

TEST_CASE("integrated predictions come near those of quadrature over the hyper-parameters, to a stated limit") {
  // Without a nugget u has two components: length scale and signal variance, summed on a fine grid of the posterior.
  const TrainingSet training = few_runs(7, 1);
  const FitOptions options{.nugget = false, .hyper_uncertainty = HyperUncertainty::integrated};
  const MatrixXd points = Eigen::Vector4d(0.05, 0.35, 0.6, 0.99);
  const MarginalPrediction found = fit(training, options).predict_marginal(points);
  const MarginalPrediction plugged = fit(training, {.nugget = false}).predict_marginal(points);

  const Standardised data = standardise(training, options.scale);
  Likelihood likelihood(data, options.kernel, options.mean, false);
  const Objective objective = make_objective(likelihood, options);
  double total = 0.0, top = -1e300;
  VectorXd first = VectorXd::Zero(4), second = first;
  std::vector<std::pair<double, MarginalPrediction>> grid;
  for (double length = -4.0; length < 4.0; length += 0.1)
    for (double signal = -6.0; signal < 11.0; signal += 0.2) {
      const Eigen::Vector2d u(length, signal);
      if (u[0] < objective.low[0] || u[0] > objective.high[0] || u[1] < objective.low[1] || u[1] > objective.high[1])
        continue;
      const LikelihoodGradient at = evaluate(objective, u);
      REQUIRE(at.ok);
      HyperParameters hyper;
      hyper.length_scales = VectorXd::Constant(1, std::exp(length));
      hyper.signal_sd = data.unit * std::exp(0.5 * signal);
      grid.emplace_back(at.value, condition(training, {}, hyper).predict_marginal(points));
      top = std::max(top, at.value);
    }
  for (const auto& [value, prediction] : grid) {
    const double weight = std::exp(value - top);
    total += weight;
    first += weight * prediction.mean;
    second += weight * (prediction.variance + prediction.mean.cwiseAbs2());
  }
  const VectorXd mean = first / total, sd = (second / total - mean.cwiseAbs2()).cwiseSqrt();
  for (int i = 0; i < 4; ++i) {
    CAPTURE(i, plugged.mean[i], std::sqrt(plugged.variance[i]), mean[i], sd[i]);
    CHECK(std::abs(found.mean[i] - mean[i]) < 0.25 * sd[i]);
    // Within a fifth, or at least a quarter of what plugging in leaves out: a shoulder of the posterior at short length
    // scales (a thousandth of its mass, with an sd as large as the signal's) is out of reach of nodes about the mode.
    const double error = std::abs(std::sqrt(found.variance[i]) - sd[i]);
    CHECK(error < std::max(0.2 * sd[i], 0.75 * std::abs(std::sqrt(plugged.variance[i]) - sd[i])));
  }
}

TEST_CASE("gradients and batches of an integrated process agree with differences and single predictions") {
  data::RandomStream random(3, data::Purpose::test);
  TrainingSet training{scrambled_sobol(20, 2, 3), VectorXd(20), {}};
  for (int i = 0; i < 20; ++i)
    training.y[i] = 2.0 + std::sin(3.0 * training.x(i, 0)) * training.x(i, 1) + 0.05 * random.normal();
  for (const OutputScale scale : {OutputScale::linear, OutputScale::log}) {
    const GaussianProcess process =
        fit(training, {.scale = scale, .starts = 2, .hyper_uncertainty = HyperUncertainty::integrated});
    REQUIRE(process.parts().size() > 3);
    const MatrixXd points = scrambled_sobol(4, 2, 8);
    const std::vector<int> coordinates{0, 1};
    const PredictionGradient at = process.predict_with_gradient(points, coordinates);
    const std::vector<Prediction> batch = process.predict_batch(points, 2);
    CHECK((batch[0].covariance - at.value.covariance.topLeftCorner(2, 2)).cwiseAbs().maxCoeff() < 1e-12);
    CHECK((process.predict_marginal(points).variance - at.value.covariance.diagonal()).cwiseAbs().maxCoeff() < 1e-12);
    for (const int k : coordinates) {
      constexpr double h = 1e-5;
      MatrixXd up = points, down = points;
      up.col(k).array() += h;
      down.col(k).array() -= h;
      const Prediction above = process.predict(up), below = process.predict(down);
      CHECK(((above.mean - below.mean) / (2.0 * h) - at.mean_gradient[k]).cwiseAbs().maxCoeff() < 1e-6);
      CHECK(((above.covariance - below.covariance) / (2.0 * h) - at.covariance_gradient[k]).cwiseAbs().maxCoeff() <
            1e-6);
    }
  }
}

TEST_CASE("with few runs integrating the hyper-parameters brings coverage up towards its nominal value", "[slow]") {
  // 100 functions drawn from the model (length scale from the prior used by the fit, on [0.1, 3]), six runs each, no
  // noise.
  constexpr int draws = 100, runs = 6, tests = 20;
  double plugged = 0.0, integrated = 0.0;
  for (std::uint64_t draw = 0; draw < draws; ++draw) {
    data::RandomStream random(draw, data::Purpose::test, 4);
    const double length = std::clamp(std::exp(1.5 * random.normal()), 0.1, 3.0);
    MatrixXd x(runs + tests, 1);
    x << scrambled_sobol(runs, 1, draw), scrambled_sobol(tests, 1, draw + 500);
    MatrixXd prior(runs + tests, runs + tests);
    for (int i = 0; i < runs + tests; ++i)
      for (int j = 0; j < runs + tests; ++j)
        prior(i, j) = correlation(x(i, 0) - x(j, 0), length) + (i == j ? 1e-9 : 0.0);
    VectorXd normal(runs + tests);
    for (double& value : normal) value = random.normal();
    const VectorXd y = MatrixXd(prior.llt().matrixL()) * normal;
    const TrainingSet training{x.topRows(runs), y.head(runs), {}};
    for (const HyperUncertainty how : {HyperUncertainty::plug_in, HyperUncertainty::integrated}) {
      const FitOptions options{
          .nugget = false, .starts = 3, .estimate = Estimate::maximum_a_posteriori, .hyper_uncertainty = how};
      const MarginalPrediction p = fit(training, options).predict_marginal(x.bottomRows(tests));
      const double inside = static_cast<double>(
          ((y.tail(tests) - p.mean).array().abs() <= 1.96 * p.variance.array().sqrt() + 1e-9).count());
      (how == HyperUncertainty::plug_in ? plugged : integrated) += inside / (draws * tests);
    }
  }
  CAPTURE(plugged, integrated);
  CHECK(integrated > plugged);
  CHECK(integrated > 0.90);
}
