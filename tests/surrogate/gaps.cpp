// What is not known between the values of an input that were run, and what validation says of it.
#include "surrogate/gaps.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "surrogate/fit.hpp"
#include "surrogate/validation.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;
using namespace surrogate;

namespace {

/// levels x 5 x 5 runs of a response to the first input and a plane in the others.
template <class Response>
TrainingSet factorial(int levels, Response response) {
  data::RandomStream random(1, data::Purpose::test, 3);
  TrainingSet training{MatrixXd(25 * levels, 3), VectorXd(25 * levels), VectorXd::Constant(25 * levels, 1e-4)};
  for (int i = 0; i < 25 * levels; ++i) {
    training.x.row(i) << static_cast<double>(i / 25) / (levels - 1), 0.25 * (i % 5), 0.25 * (i / 5 % 5);
    training.y[i] = response(training.x(i, 0)) + training.x(i, 1) + 0.5 * training.x(i, 2) + 0.01 * random.normal();
  }
  return training;
}

double saturating(double x) { return 3.0 * (1.0 - std::exp(-x / 0.2)); }

const FitOptions doubted{.starts = 3, .between_runs = BetweenRuns::doubted};
const FitOptions trusted{.starts = 3};

}  // namespace

TEST_CASE("between two levels nothing is known: the interval holds a saturating and a straight response alike") {
  const MatrixXd middle = Eigen::RowVector3d(0.2, 0.5, 0.5);
  for (const bool bent : {true, false}) {
    const auto response = [&](double x) { return bent ? saturating(x) : 3.0 * x; };
    const TrainingSet training = factorial(2, response);
    const MarginalPrediction p = fit(training, doubted).predict_marginal(middle);
    const double truth = response(0.2) + 0.75;
    CAPTURE(p.mean[0], std::sqrt(p.variance[0]), truth);
    CHECK(std::abs(p.mean[0] - truth) < 2.0 * std::sqrt(p.variance[0]));
    if (!bent) continue;
    // The fit alone is certain of what it cannot know.
    const MarginalPrediction sure = fit(training, trusted).predict_marginal(middle);
    CHECK(std::sqrt(p.variance[0]) > 2.0 * std::sqrt(sure.variance[0]));
  }
}

TEST_CASE("at the runs and in a design that fills the space the doubt changes nothing") {
  const TrainingSet table = factorial(3, saturating);
  const GaussianProcess with = fit(table, doubted), without = fit(table, trusted);
  CHECK_FALSE(with.data().gaps.empty());
  CHECK((with.predict_marginal(table.x).variance - without.predict_marginal(table.x).variance).cwiseAbs().maxCoeff() <
        1e-12);
  CHECK(with.log_marginal_likelihood() == without.log_marginal_likelihood());

  TrainingSet filling{scrambled_sobol(60, 3, 2), VectorXd(60), VectorXd::Constant(60, 1e-4)};
  for (int i = 0; i < 60; ++i) filling.y[i] = saturating(filling.x(i, 0)) + filling.x(i, 1);
  CHECK(fit(filling, doubted).data().gaps.empty());
}

TEST_CASE("the doubt is a covariance, and falls as levels come closer") {
  double before = 1e300;
  for (const int levels : {2, 3, 4, 5, 6, 7}) {
    const GaussianProcess process = fit(factorial(levels, saturating), doubted);
    const GaussianProcess plain = fit(factorial(levels, saturating), trusted);
    MatrixXd points(40, 3);
    points << scrambled_sobol(40, 3, 5);
    points.rightCols(2) = (4.0 * points.rightCols(2)).array().round() / 4.0;  // on levels of the other inputs
    const MatrixXd more = process.predict(points).covariance - plain.predict(points).covariance;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> spectrum(more);
    CHECK(spectrum.eigenvalues()[0] > -1e-9 * (1.0 + more.diagonal().maxCoeff()));
    const double largest = more.diagonal().maxCoeff();
    CHECK(largest <= before);
    before = largest;
  }
  CHECK(before < 1e-12);  // seven levels speak for themselves
}

TEST_CASE("beyond the outermost run and in a hole the doubt grows with the distance from runs") {
  data::RandomStream random(2, data::Purpose::test);
  TrainingSet training{scrambled_sobol(60, 2, 4), VectorXd(60), VectorXd::Constant(60, 1e-4)};
  for (int i = 0; i < 60; ++i) {
    double& x = training.x(i, 0);
    x = x < 0.5 ? 0.2 * x : 0.5 + 0.4 * (x - 0.5);  // 0 to 0.1, 0.5 to 0.7
    training.y[i] = saturating(x) + training.x(i, 1);
  }
  const GaussianProcess process = fit(training, doubted), plain = fit(training, trusted);
  MatrixXd points(4, 2);
  points << 0.15, 0.5, 0.3, 0.5, 0.75, 0.5, 0.95, 0.5;
  const VectorXd more = process.predict_marginal(points).variance - plain.predict_marginal(points).variance;
  CHECK(more[1] > more[0]);
  CHECK(more[3] > more[2]);
  CHECK(more[2] > 0.0);
}

TEST_CASE("gradients and batches with gaps agree with differences and single predictions") {
  for (const OutputScale scale : {OutputScale::linear, OutputScale::log}) {
    FitOptions options = doubted;
    options.scale = scale;
    TrainingSet training = factorial(3, saturating);
    training.y.array() += 2.0;
    const GaussianProcess process = fit(training, options);
    MatrixXd points(4, 3);
    points << 0.2, 0.1, 0.3, 0.2, 0.6, 0.9, 0.7, 0.2, 0.4, 0.8, 0.9, 0.1;
    const std::vector<int> coordinates{0, 1};
    const PredictionGradient at = process.predict_with_gradient(points, coordinates);
    const std::vector<Prediction> batch = process.predict_batch(points, 2);
    CHECK((batch[1].covariance - at.value.covariance.bottomRightCorner(2, 2)).cwiseAbs().maxCoeff() < 1e-10);
    CHECK((process.predict_marginal(points).variance - at.value.covariance.diagonal()).cwiseAbs().maxCoeff() < 1e-10);
    for (const int k : coordinates) {
      constexpr double h = 1e-5;
      MatrixXd up = points, down = points;
      up.col(k).array() += h;
      down.col(k).array() -= h;
      const Prediction above = process.predict(up), below = process.predict(down);
      CHECK(((above.mean - below.mean) / (2.0 * h) - at.mean_gradient[k]).cwiseAbs().maxCoeff() < 1e-5);
      CHECK(((above.covariance - below.covariance) / (2.0 * h) - at.covariance_gradient[k]).cwiseAbs().maxCoeff() <
            1e-5);
    }
  }
}

TEST_CASE("a run inside a gap parts it, and the function is known there") {
  const GaussianProcess process = fit(factorial(2, saturating), doubted);
  const VectorXd place = Eigen::Vector3d(0.4, 0.5, 0.5);
  const GaussianProcess grown = process.with_run(place, 3.3, 1e-4);
  CHECK(grown.data().gaps.size() > process.data().gaps.size());
  const MatrixXd at = place.transpose();
  CHECK(grown.predict_marginal(at).variance[0] < 0.1 * process.predict_marginal(at).variance[0]);
}

TEST_CASE("validation leaves out whole levels, and says where nothing is known") {
  const TrainingSet two = factorial(2, saturating);
  const Validation v = validate(two, doubted, fit(two, doubted));
  CHECK(v.verdict == SurrogateVerdict::caution);
  REQUIRE(v.levels.size() == 3);
  CHECK(v.levels[0].levels == 2);
  CHECK_THAT(v.finding, Catch::Contains("nothing is known between the 2 levels of input 1"));
  CHECK_THAT(v.remedy, Catch::Contains("between the levels of input 1"));

  // Single runs left out are predicted almost without error, whole levels are not.
  const TrainingSet three = factorial(3, saturating);
  const Validation w = validate(three, doubted, fit(three, doubted));
  CHECK(w.q2_leave_one_out > 0.99);
  REQUIRE(w.levels[0].levels == 3);
  CHECK(w.levels[0].predicted == 25);
  CHECK(w.levels[0].q2 < 0.9);
  CHECK(w.levels[0].coverage95 > 0.9);
  CHECK(w.verdict == SurrogateVerdict::caution);

  const TrainingSet straight = factorial(5, [](double x) { return 3.0 * x; });
  const Validation good = validate(straight, doubted, fit(straight, doubted));
  CAPTURE(good.finding);
  CHECK(good.verdict == SurrogateVerdict::good);
}

TEST_CASE("a long length scale is called no influence only where there is none") {
  TrainingSet training{scrambled_sobol(40, 2, 6), VectorXd(40), VectorXd::Constant(40, 1e-6)};
  for (int i = 0; i < 40; ++i) training.y[i] = 3.0 * training.x(i, 0) + std::sin(6.0 * training.x(i, 1));
  FitOptions options = trusted;
  options.estimate = Estimate::maximum_likelihood;
  options.mean = MeanBasis::linear;
  for (const std::string& note : fit_notes(fit(training, options).diagnostics()))
    CHECK_THAT(note, !Catch::Contains("hardly depends"));
  for (int i = 0; i < 40; ++i) training.y[i] = std::sin(6.0 * training.x(i, 1));
  const std::vector<std::string> notes = fit_notes(fit(training, options).diagnostics());
  CHECK(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.find("input 1") != std::string::npos && note.find("hardly depends") != std::string::npos;
  }));
}

TEST_CASE("a trend with proper priors has the evidence and predictions of its own covariance") {
  // z = N(0, H B H' + s^2 C + noise) with a wide prior on the constant in place of the flat one.
  const TrainingSet training = factorial(2, [](double x) { return 3.0 * x; });
  HyperParameters hyper;
  hyper.length_scales = Eigen::Vector3d(0.7, 0.9, 1.3);
  hyper.signal_sd = 0.4;
  hyper.nugget_sd = 0.02;
  const GaussianProcess process = condition(training, {.mean = MeanBasis::trend}, hyper);
  const Standardised& data = process.data();
  const ScaledParameters& p = process.parts().front().parameters;
  const auto kernel = [&](const MatrixXd& a, const MatrixXd& b) {
    MatrixXd square = MatrixXd::Zero(a.rows(), b.rows()), value(a.rows(), b.rows());
    for (Eigen::Index j = 0; j < b.rows(); ++j)
      for (Eigen::Index i = 0; i < a.rows(); ++i)
        square(i, j) = ((a.row(i) - b.row(j)).transpose().array() / p.length_scales.array()).square().sum();
    correlate(Kernel::matern52, {{square.data(), square.size()}, {value.data(), value.size()}, {nullptr, 0}});
    MatrixXd scaled = basis_matrix(MeanBasis::trend, a);
    scaled.col(0) *= 1e6;  // variance 1e6
    scaled.rightCols(scaled.cols() - 1) *= trend_sd * trend_sd;
    return MatrixXd(p.signal_variance * value + scaled * basis_matrix(MeanBasis::trend, b).transpose());
  };
  MatrixXd covariance = kernel(data.points, data.points);
  covariance.diagonal() += data.noise;
  covariance.diagonal().array() += p.nugget_variance;
  const MatrixXd points = scrambled_sobol(3, 3, 7);
  const MatrixXd cross = kernel(points, data.points);
  const Eigen::LDLT<MatrixXd> factor(covariance);
  const VectorXd mean = cross * factor.solve(data.z);
  const MatrixXd rest = kernel(points, points) - cross * factor.solve(cross.transpose());
  const Prediction found = process.predict(points);
  CHECK(((found.mean.array() - data.shift) / data.unit - mean.array()).abs().maxCoeff() < 1e-4);
  CHECK((found.covariance / (data.unit * data.unit) - rest).cwiseAbs().maxCoeff() < 1e-4);

  // Its gradient against differences.
  Likelihood likelihood(data, Kernel::matern52, MeanBasis::trend, true);
  const VectorXd u = to_logs(p, true);
  const LikelihoodGradient at = likelihood.evaluate(u);
  REQUIRE(at.ok);
  for (Eigen::Index j = 0; j < u.size(); ++j) {
    VectorXd up = u, down = u;
    up[j] += 1e-5;
    down[j] -= 1e-5;
    const double slope = (likelihood.evaluate(up).value - likelihood.evaluate(down).value) / 2e-5;
    CHECK(at.gradient[j] == Approx(slope).epsilon(1e-4).margin(1e-5));
  }
}
