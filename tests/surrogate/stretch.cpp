// Scales on which a function bends alike all over, on functions whose bend is known.
#include "surrogate/stretch.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"
#include "surrogate/design.hpp"

using Eigen::VectorXd;
using namespace surrogate;

namespace {

const FitOptions fit_options{.starts = 4, .seed = 1};

/// Runs of (1 + a) f(b) with one per cent of scatter.
template <class Function>
TrainingSet runs_of(Function f, int runs, std::uint64_t seed) {
  data::RandomStream random(seed, data::Purpose::test, 4);
  TrainingSet training{scrambled_sobol(runs, 2, seed), VectorXd(runs), VectorXd(runs)};
  for (int i = 0; i < runs; ++i) {
    const double y = (1.0 + training.x(i, 0)) * f(training.x(i, 1));
    training.y[i] = y * (1.0 + 0.01 * random.normal());
    training.noise_variance[i] = std::pow(0.01 * y, 2);
  }
  return training;
}

std::vector<Stretch> chosen_for(const TrainingSet& training) {
  return choose_stretches(training, fit_options, {1.0, 1.0});
}

/// Mean squared error, in predicted variances, at b below 0.15.
template <class Function>
double deviation_at_low_end(TrainingSet training, const std::vector<Stretch>& stretches, Function f) {
  const auto learnt = [&](Eigen::MatrixXd points) {
    for (Eigen::Index k = 0; k < 2; ++k)
      for (double& u : points.col(k)) u = stretches[k].place(u);
    return points;
  };
  Eigen::MatrixXd points = scrambled_sobol(100, 2, 99);
  points.col(1) *= 0.15;
  training.x = learnt(training.x);
  const MarginalPrediction found = fit(training, fit_options).predict_marginal(learnt(points));
  double sum = 0.0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    sum += std::pow(found.mean[i] - (1.0 + points(i, 0)) * f(points(i, 1)), 2) / found.variance[i];
  return sum / static_cast<double>(points.rows());
}

}  // namespace

TEST_CASE("a stretch takes the unit interval to itself, smoothly beyond it, and back") {
  for (const double ratio : {1.0, 8.0, 100.0, 0.1, 0.01}) {
    const Stretch stretch{ratio};
    CAPTURE(ratio);
    CHECK(stretch.place(0.0) == 0.0);
    CHECK(stretch.place(1.0) == Approx(1.0));
    CHECK(stretch.slope(0.0) == Approx(ratio * stretch.slope(1.0)));
    for (const double u : {-0.5, -1e-9, 0.0, 0.03, 0.5, 0.97, 1.0, 1.0 + 1e-9, 1.5}) {
      CAPTURE(u);
      CHECK(stretch.origin(stretch.place(u)) == Approx(u).margin(1e-12));
      const double h = 1e-6;
      CHECK(stretch.slope(u) == Approx((stretch.place(u + h) - stretch.place(u - h)) / (2.0 * h)).epsilon(1e-4));
    }
  }
}

TEST_CASE("the stretch by the ratio of a range's ends is its logarithm") {
  const double low = 0.02, high = 1.6;
  const Stretch stretch{high / low};
  for (const double x : {0.02, 0.05, 0.3, 1.2, 1.6})
    CHECK(stretch.place((x - low) / (high - low)) == Approx(std::log(x / low) / std::log(high / low)));
}

TEST_CASE("an input is stretched at the end where the function bends") {
  const auto pole = [](double b) { return 1.0 / (0.05 + b); };
  const auto mirrored = [](double b) { return 1.0 / std::sqrt(1.05 - b); };
  for (const std::uint64_t seed : {1, 2, 3}) {
    const std::vector<Stretch> low = chosen_for(runs_of(pole, 40, seed));
    const std::vector<Stretch> high = chosen_for(runs_of(mirrored, 40, seed));
    CHECK(low[0].is_none());
    CHECK(low[1].ratio > 1.0);
    CHECK(high[0].is_none());
    CHECK(high[1].ratio < 1.0);
  }
}

TEST_CASE("functions that bend alike all over, or not at all, are learnt as they are") {
  int stretched = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    for (const auto& training : {runs_of([](double b) { return 1.0 + b; }, 40, seed),
                                 runs_of([](double b) { return 3.0 + std::sin(6.0 * b); }, 40, seed),
                                 runs_of([](double b) { return 3.0 + std::tanh(10.0 * (b - 0.5)); }, 40, seed)})
      for (const Stretch& stretch : chosen_for(training)) stretched += !stretch.is_none();
  }
  CHECK(stretched <= 1);  // of 30 inputs
}

TEST_CASE("at a steep end the deviations are those that are stated, which they are not on the input's own scale") {
  const auto power = [](double b) { return std::sqrt(0.01 + b); };
  double own = 0.0, stretched = 0.0;
  constexpr int designs = 6;
  for (std::uint64_t seed = 1; seed <= designs; ++seed) {
    const TrainingSet training = runs_of(power, 40, seed);
    own += deviation_at_low_end(training, {Stretch{}, Stretch{}}, power) / designs;
    stretched += deviation_at_low_end(training, chosen_for(training), power) / designs;
  }
  CAPTURE(own, stretched);
  CHECK(own > 2.0);
  CHECK(stretched < 1.5);
}

TEST_CASE("four values of an input tell no scale, and a constant input has none") {
  TrainingSet training = runs_of([](double b) { return 1.0 / (0.05 + b); }, 40, 1);
  for (double& b : training.x.col(1)) b = std::round(3.0 * b) / 3.0;
  CHECK(chosen_for(training)[1].is_none());
  training.x.col(1).setConstant(0.4);
  CHECK(chosen_for(training)[1].is_none());
}

TEST_CASE("a response that rises at its low end and levels off is known at that end, whatever the stretch") {
  // It changes by 1.5 over the stretched end, and by 0.17 between the end and the outermost of 60 runs.
  const auto levels_off = [](double b) { return 1.0 + std::min(b, 0.15) / 0.15; };
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    TrainingSet training = runs_of(levels_off, 60, seed);
    const std::vector<Stretch> stretches = chosen_for(training);
    CAPTURE(seed, stretches[1].ratio);
    for (Eigen::Index k = 0; k < 2; ++k)
      for (double& u : training.x.col(k)) u = stretches[k].place(u);
    Eigen::MatrixXd end(1, 2);
    end << stretches[0].place(0.5), 0.0;
    const MarginalPrediction found = fit(training, fit_options).predict_marginal(end);
    CHECK(std::sqrt(found.variance[0]) < 0.25);
    CHECK(std::abs(found.mean[0] - 1.5) < 0.25);
  }
}
