#include "surrogate/marginal.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <utility>

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

/// Probability of at most y under the mixture of the process's parts.
VectorXd probabilities(const GaussianProcess& process, const MatrixXd& points, const VectorXd& y) {
  VectorXd total = VectorXd::Zero(y.size());
  for (Conditioned part : process.parts()) {
    const double weight = std::exchange(part.weight, 1.0);
    const GaussianProcess one(process.kernel(), process.mean(), process.nugget(), process.data(), {part}, {});
    const MarginalPrediction p = one.predict_marginal(points);
    for (Eigen::Index i = 0; i < y.size(); ++i)
      total[i] += weight * 0.5 * std::erfc((p.mean[i] - y[i]) / std::sqrt(2.0 * p.variance[i] + 1e-18));
  }
  return total;
}

}  // namespace

TEST_CASE("the nodes' weights are those of a law with known means, in every component") {
  // Independent components with the law of log(-log U) each, shifted: its mean is minus Euler's constant, its variance
  // pi^2 / 6, and it is skewed. As many nodes as draws, so that what is seen is the weights of these.
  const int size = GENERATE(2, 3, 6);
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  HyperPosterior posterior;
  posterior.log_density = [](const VectorXd& u) { return (u.array() - u.array().exp()).sum(); };
  posterior.low = VectorXd::Constant(size, -12.0);
  posterior.high = VectorXd::Constant(size, 4.0);
  posterior.prior_mean = VectorXd::Zero(size);
  posterior.prior_precision = VectorXd::Constant(size, 0.02);  // wide: the prior's draws see both tails
  posterior.mode = VectorXd::Zero(size);
  posterior.covariance = MatrixXd::Identity(size, size);
  const auto nodes = integration_nodes(posterior, {.nodes = 4000, .seed = seed});
  VectorXd mean = VectorXd::Zero(size), square = mean, above = mean;
  for (const HyperNode& node : nodes) {
    mean += node.weight * node.u;
    square += node.weight * node.u.cwiseAbs2();
    above += node.weight * (node.u.array() > 0.0).cast<double>().matrix();
  }
  const double sd = std::numbers::pi / std::sqrt(6.0);
  const double error = size > 3 ? 0.1 : 0.04;  // the weighted draws are worth 1,000 of the law, in six dimensions 600
  for (int j = 0; j < size; ++j) {
    CAPTURE(size, seed, j, nodes.size());
    CHECK(std::abs(mean[j] + std::numbers::egamma) < error * sd);
    CHECK(std::sqrt(square[j] - mean[j] * mean[j]) == Approx(sd).epsilon(error));
    CHECK(above[j] == Approx(std::exp(-1.0)).margin(0.5 * error));
  }
}

TEST_CASE("integrated predictions are those of quadrature over the hyper-parameters") {
  // Without a nugget u has two components: length scale and signal variance, summed on a fine grid of the posterior.
  const TrainingSet training = few_runs(7, 1);
  FitOptions options{.nugget = false, .hyper_uncertainty = HyperUncertainty::integrated};
  const MatrixXd points = Eigen::Vector4d(0.05, 0.35, 0.6, 0.99);
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
  // Whatever the seed: a short length scale has 0.6 % of the weight and a third of the variance.
  for (const std::uint64_t seed : {0, 1, 2, 3, 4, 5}) {
    options.seed = seed;
    const MarginalPrediction found = fit(training, options).predict_marginal(points);
    for (int i = 0; i < 4; ++i) {
      CAPTURE(seed, i, plugged.mean[i], std::sqrt(plugged.variance[i]), mean[i], sd[i]);
      CHECK(std::abs(found.mean[i] - mean[i]) < 0.06 * sd[i]);
      CHECK(std::sqrt(found.variance[i]) == Approx(sd[i]).epsilon(0.1));
    }
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
    CHECK((process.predict_mean(points) - at.value.mean).cwiseAbs().maxCoeff() < 1e-12);
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

TEST_CASE("with 7 to 12 runs integrated hyper-parameters bring 90 % intervals to their nominal coverage", "[slow]") {
  // Functions drawn from the model itself, their hyper-parameters from its prior: integrating over these is then exact
  // Bayes (but for the signal variance, whose prior is about the data's own), and plugging in the best setting claims
  // too much.
  constexpr int draws = 300, tests = 20;
  const FitOptions model{.nugget = false, .starts = 3};
  double plugged = 0.0, integrated = 0.0, by_moments = 0.0;
  for (std::uint64_t draw = 0; draw < draws; ++draw) {
    data::RandomStream random(draw, data::Purpose::test, 4);
    const int runs = 7 + static_cast<int>(draw % 6);
    Eigen::Vector2d length;
    for (double& l : length)
      l = std::clamp(model.priors.length_scale.median * std::exp(model.priors.length_scale.log_sd * random.normal()),
                     model.bounds.length_scale.low, model.bounds.length_scale.high);
    MatrixXd x(runs + tests, 2);
    x << scrambled_sobol(runs, 2, draw), scrambled_sobol(tests, 2, draw + 500);
    MatrixXd prior(runs + tests, runs + tests);
    for (int i = 0; i < runs + tests; ++i)
      for (int j = 0; j < runs + tests; ++j) {
        const Eigen::Vector2d apart = x.row(i) - x.row(j);
        prior(i, j) = correlation(apart.cwiseQuotient(length).norm(), 1.0) + (i == j ? 1e-9 : 0.0);
      }
    VectorXd normal(runs + tests);
    for (double& value : normal) value = random.normal();
    const VectorXd y = MatrixXd(prior.llt().matrixL()) * normal;
    const TrainingSet training{x.topRows(runs), y.head(runs), {}};
    for (const HyperUncertainty how : {HyperUncertainty::plug_in, HyperUncertainty::integrated}) {
      FitOptions options = model;
      options.hyper_uncertainty = how;
      const GaussianProcess process = fit(training, options);
      const MarginalPrediction p = process.predict_marginal(x.bottomRows(tests));
      const VectorXd level = probabilities(process, x.bottomRows(tests), y.tail(tests));
      const double inside = static_cast<double>((level.array() > 0.05 && level.array() < 0.95).count());
      (how == HyperUncertainty::plug_in ? plugged : integrated) += inside / (draws * tests);
      if (how == HyperUncertainty::integrated)
        by_moments += static_cast<double>(
                          ((y.tail(tests) - p.mean).array().abs() <= 1.6449 * p.variance.array().sqrt()).count()) /
                      (draws * tests);
    }
  }
  CAPTURE(plugged, integrated, by_moments);
  CHECK(integrated > plugged);
  CHECK(integrated > 0.88);
  CHECK(integrated < 0.92);
  CHECK(by_moments > 0.88);  // what the likelihood uses: one normal density with the mixture's mean and covariance
}
