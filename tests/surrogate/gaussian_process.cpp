#include "surrogate/gaussian_process.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "data/random.hpp"
#include "surrogate/design.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;
using namespace surrogate;

namespace {

/// tests/reference/theory-facts.json: closed forms evaluated by an independent program.
nlohmann::json facts() {
  std::ifstream file(DEMCAL_SOURCE_DIR "/tests/reference/theory-facts.json");
  return nlohmann::json::parse(file).at("gp1d_matern52_hetero");
}

VectorXd vector(const nlohmann::json& values) {
  VectorXd result(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) result[static_cast<Eigen::Index>(i)] = values[i].get<double>();
  return result;
}

TrainingSet fact_training() {
  const nlohmann::json fact = facts();
  return {vector(fact["x"]), vector(fact["y"]), vector(fact["noise_sd"]).cwiseAbs2()};
}

GaussianProcess fact_process(MeanBasis mean) {
  const nlohmann::json fact = facts();
  HyperParameters hyper;
  hyper.length_scales = VectorXd::Constant(1, fact["l"].get<double>());
  hyper.signal_sd = fact["sf"];
  return condition(fact_training(), {Kernel::matern52, mean, OutputScale::linear}, hyper);
}

/// A wavy function of three inputs with unequal known noise, positive everywhere.
TrainingSet wavy(int runs, std::uint64_t seed) {
  data::RandomStream random(seed, data::Purpose::test);
  TrainingSet training{scrambled_sobol(runs, 3, seed), VectorXd(runs), VectorXd(runs)};
  for (int i = 0; i < runs; ++i) {
    const VectorXd x = training.x.row(i);
    const double sd = 0.02 + 0.03 * x[2];
    training.y[i] = 2.0 + std::sin(3.0 * x[0]) * (1.0 + x[1]) + 0.3 * x[2] * x[2] + sd * random.normal();
    training.noise_variance[i] = sd * sd;
  }
  return training;
}

HyperParameters three_scales() {
  HyperParameters hyper;
  hyper.length_scales = Eigen::Vector3d(0.6, 1.1, 1.7);
  hyper.signal_sd = 0.9;
  hyper.nugget_sd = 0.03;
  return hyper;
}

double largest(const MatrixXd& difference) { return difference.cwiseAbs().maxCoeff(); }

}  // namespace

TEST_CASE("a zero-mean Matern 5/2 process with unequal known noise has the closed-form mean, variance and evidence") {
  const nlohmann::json fact = facts();
  const VectorXd points = vector(fact["xs"]);
  const GaussianProcess process = fact_process(MeanBasis::zero);
  const Prediction prediction = process.predict(points);
  CHECK(largest(prediction.mean - vector(fact["mean"])) < 1e-8);
  CHECK(largest(prediction.covariance.diagonal() - vector(fact["latent_var"])) < 1e-8);
  CHECK(std::abs(process.log_marginal_likelihood() + fact["nll_zero_mean"].get<double>()) < 1e-8);
}

TEST_CASE("leave-one-out in closed form is the leave-one-out by hand") {
  const nlohmann::json fact = facts();
  const LeaveOneOut loo = fact_process(MeanBasis::zero).leave_one_out();
  CHECK(largest(loo.mean - vector(fact["loo_mean"])) < 1e-8);
  CHECK(largest(loo.variance - vector(fact["loo_var_noisy"])) < 1e-8);
}

TEST_CASE("a generalised least-squares mean gives the closed-form coefficient, prediction and restricted likelihood") {
  const nlohmann::json fact = facts();
  const GaussianProcess process = fact_process(MeanBasis::constant);
  const Prediction prediction = process.predict(MatrixXd(vector(fact["xs"])));
  CHECK(std::abs(process.hyper_parameters().mean_coefficients[0] - fact["gls_beta"].get<double>()) < 1e-8);
  CHECK(largest(prediction.mean - vector(fact["gls_mean"])) < 1e-8);
  CHECK(largest(prediction.covariance.diagonal() - vector(fact["gls_latent_var"])) < 1e-8);
  CHECK(std::abs(process.log_marginal_likelihood() + fact["reml_nll"].get<double>()) < 1e-8);
}

TEST_CASE("the gradient of the evidence is the closed-form one") {
  const nlohmann::json fact = facts();
  Standardised data = standardise(fact_training(), OutputScale::linear, Centre::zero);
  Likelihood likelihood(data, Kernel::matern52, MeanBasis::zero, false);
  const double signal = fact["sf"].get<double>() / data.unit;
  const LikelihoodGradient at =
      likelihood.evaluate(to_logs({VectorXd::Constant(1, fact["l"].get<double>()), signal * signal, 0.0}, false));
  REQUIRE(at.ok);
  CHECK(std::abs(-2.0 * at.gradient[1] - fact["grad_logsf_logl"][0].get<double>()) <
        1e-8);  // of log sd, not log variance
  CHECK(std::abs(-at.gradient[0] - fact["grad_logsf_logl"][1].get<double>()) < 1e-8);
}

TEST_CASE("the gradient of the evidence agrees with differences for every kernel, mean and with replicates") {
  TrainingSet training = wavy(30, 5);
  training.x.row(4) = training.x.row(9);  // replicates with unequal noise
  training.x.row(17) = training.x.row(9);
  training.x.row(20) = training.x.row(3);
  const Standardised data = standardise(training, OutputScale::linear);
  CHECK(data.points.rows() == 27);
  for (const Kernel kernel : {Kernel::matern32, Kernel::matern52, Kernel::squared_exponential})
    for (const MeanBasis mean : {MeanBasis::zero, MeanBasis::constant, MeanBasis::linear, MeanBasis::quadratic}) {
      Likelihood likelihood(data, kernel, mean, true);
      const VectorXd u = to_logs({Eigen::Vector3d(0.5, 0.8, 1.3), 1.7, 0.01}, true);
      const LikelihoodGradient at = likelihood.evaluate(u);
      REQUIRE(at.ok);
      for (int j = 0; j < u.size(); ++j) {
        constexpr double h = 1e-4;
        VectorXd up = u, down = u;
        up[j] += h;
        down[j] -= h;
        const double difference = (likelihood.evaluate(up).value - likelihood.evaluate(down).value) / (2.0 * h);
        CAPTURE(to_text(kernel), to_text(mean), j);
        CHECK(at.gradient[j] == Approx(difference).epsilon(1e-6).margin(1e-6));
      }
      CHECK(at.value == Approx(likelihood.factorise(from_logs(u, true)).log_likelihood).epsilon(1e-12));
    }
}

TEST_CASE("prediction gradients agree with differences on both output scales and for every mean") {
  for (const OutputScale scale : {OutputScale::linear, OutputScale::log})
    for (const MeanBasis mean : {MeanBasis::zero, MeanBasis::constant, MeanBasis::linear, MeanBasis::quadratic}) {
      HyperParameters hyper = three_scales();
      const GaussianProcess process = condition(wavy(30, 6), {Kernel::matern52, mean, scale}, hyper);
      const MatrixXd points = scrambled_sobol(5, 3, 99);
      const std::vector<int> coordinates{0, 1, 2};
      const PredictionGradient at = process.predict_with_gradient(points, coordinates);
      CHECK(largest(at.value.covariance - process.predict(points).covariance) < 1e-12);
      CHECK(largest(at.value.mean - process.predict_mean(points)) < 1e-12);
      for (const int k : coordinates) {
        constexpr double h = 1e-5;
        MatrixXd up = points, down = points;
        up.col(k).array() += h;
        down.col(k).array() -= h;
        const Prediction above = process.predict(up), below = process.predict(down);
        CAPTURE(to_text(scale), to_text(mean), k);
        CHECK(largest((above.mean - below.mean) / (2.0 * h) - at.mean_gradient[k]) < 1e-6);
        CHECK(largest((above.covariance - below.covariance) / (2.0 * h) - at.covariance_gradient[k]) < 1e-6);
      }
    }
}

TEST_CASE("batches and marginal predictions are the predictions one by one") {
  const GaussianProcess process = condition(wavy(40, 7), {}, three_scales());
  const MatrixXd points = scrambled_sobol(300 * 6, 3, 17);
  const std::vector<Prediction> batch = process.predict_batch(points, 6);
  const MarginalPrediction marginal = process.predict_marginal(points);
  REQUIRE(batch.size() == 300);
  for (int g = 0; g < 300; g += 29) {
    const Prediction one = process.predict(points.middleRows(6 * g, 6));
    CHECK(largest(one.mean - batch[g].mean) < 1e-12);
    CHECK(largest(one.covariance - batch[g].covariance) < 1e-12);
    CHECK(largest(one.mean - marginal.mean.segment(6 * g, 6)) < 1e-12);
    CHECK(largest(one.covariance.diagonal() - marginal.variance.segment(6 * g, 6)) < 1e-12);
  }
}

TEST_CASE("pooled replicates predict what the runs taken one by one do") {
  TrainingSet training = wavy(24, 8);
  training.x.row(4) = training.x.row(9);
  training.x.row(17) = training.x.row(9);
  TrainingSet apart = training;  // the same points, but too far apart in the last digits to be pooled
  apart.x(4, 0) += 1e-9;
  apart.x(17, 0) -= 1e-9;
  const GaussianProcess pooled = condition(training, {}, three_scales()), single = condition(apart, {}, three_scales());
  CHECK(pooled.data().points.rows() == 22);
  CHECK(single.data().points.rows() == 24);
  const MatrixXd points = scrambled_sobol(10, 3, 3);
  CHECK(largest(pooled.predict(points).mean - single.predict(points).mean) < 1e-6);
  CHECK(largest(pooled.predict(points).covariance - single.predict(points).covariance) < 1e-6);
  CHECK(std::abs(pooled.log_marginal_likelihood() - single.log_marginal_likelihood()) < 1e-5);
}

TEST_CASE("leave-one-out with a mean to estimate is a refit without the point, replicates left out together") {
  TrainingSet training = wavy(20, 9);
  training.x.row(4) = training.x.row(9);
  for (const MeanBasis mean : {MeanBasis::constant, MeanBasis::linear}) {
    const GaussianProcess process = condition(training, {Kernel::matern32, mean, OutputScale::linear}, three_scales());
    const LeaveOneOut loo = process.leave_one_out();
    for (const int left : {4, 9, 15}) {
      std::vector<int> kept;
      for (int i = 0; i < 20; ++i)
        if (training.x.row(i) != training.x.row(left)) kept.push_back(i);
      const TrainingSet rest{training.x(kept, Eigen::all), training.y(kept), training.noise_variance(kept)};
      const Prediction prediction =
          condition(rest, {Kernel::matern32, mean, OutputScale::linear}, three_scales()).predict(training.x.row(left));
      CHECK(loo.mean[left] == Approx(prediction.mean[0]).epsilon(1e-9));
      CHECK(loo.latent_variance[left] == Approx(prediction.covariance(0, 0)).epsilon(1e-7));
      CHECK(loo.variance[left] ==
            Approx(prediction.covariance(0, 0) + training.noise_variance[left] + 0.03 * 0.03).epsilon(1e-7));
    }
  }
}

TEST_CASE("a run added without refitting gives what conditioning on all runs gives") {
  const TrainingSet all = wavy(25, 10);
  const TrainingSet first{all.x.topRows(24), all.y.head(24), all.noise_variance.head(24)};
  for (const OutputScale scale : {OutputScale::linear, OutputScale::log})
    for (const MeanBasis mean : {MeanBasis::constant, MeanBasis::linear}) {
      const ModelForm form{Kernel::matern52, mean, scale};
      const GaussianProcess grown =
          condition(first, form, three_scales()).with_run(all.x.row(24), all.y[24], all.noise_variance[24]);
      const GaussianProcess whole = condition(all, form, three_scales());
      const MatrixXd points = scrambled_sobol(10, 3, 3);
      CHECK(largest(grown.predict(points).mean - whole.predict(points).mean) < 1e-9);
      CHECK(largest(grown.predict(points).covariance - whole.predict(points).covariance) < 1e-9);
      CHECK(grown.log_marginal_likelihood() == Approx(whole.log_marginal_likelihood()).epsilon(1e-9));
      CHECK(grown.runs() == 25);
    }
  // A replicate of a run that is there.
  const GaussianProcess process = condition(first, {}, three_scales());
  TrainingSet again = first;
  again.x.conservativeResize(25, Eigen::NoChange);
  again.x.row(24) = first.x.row(3);
  again.y.conservativeResize(25);
  again.y[24] = first.y[3] + 0.05;
  again.noise_variance.conservativeResize(25);
  again.noise_variance[24] = 1e-3;
  const MatrixXd points = scrambled_sobol(10, 3, 3);
  CHECK(largest(process.with_run(first.x.row(3), first.y[3] + 0.05, 1e-3).predict(points).mean -
                condition(again, {}, three_scales()).predict(points).mean) < 1e-9);
}

TEST_CASE("known noise enters on the scale of the output, whatever the unit") {
  const TrainingSet training = wavy(30, 11);
  constexpr double unit = 1e-5;  // N m
  const TrainingSet tiny{training.x, unit * training.y, unit * unit * training.noise_variance};
  HyperParameters small = three_scales();
  small.signal_sd *= unit;
  small.nugget_sd *= unit;
  const GaussianProcess a = condition(training, {}, three_scales()), b = condition(tiny, {}, small);
  const MatrixXd points = scrambled_sobol(10, 3, 3);
  CHECK(largest(a.predict(points).mean - b.predict(points).mean / unit) < 1e-10);
  CHECK(largest(a.predict(points).covariance - b.predict(points).covariance / unit / unit) < 1e-10);
  CHECK(b.log_marginal_likelihood() == Approx(a.log_marginal_likelihood() - 29.0 * std::log(unit)).epsilon(1e-10));
}

TEST_CASE("a constant column changes nothing, and a point off it is named as outside the training range") {
  const TrainingSet training = wavy(20, 12);
  TrainingSet padded{MatrixXd(20, 4), training.y, training.noise_variance};
  padded.x << training.x.leftCols(1), VectorXd::Constant(20, 0.25), training.x.rightCols(2);
  HyperParameters hyper = three_scales();
  hyper.length_scales = Eigen::Vector4d(0.6, std::numeric_limits<double>::infinity(), 1.1, 1.7);
  const GaussianProcess process = condition(padded, {}, hyper);
  const MatrixXd points = scrambled_sobol(4, 3, 3);
  MatrixXd off(4, 4);
  off << points.leftCols(1), VectorXd::Constant(4, 0.5), points.rightCols(2);
  CHECK(largest(process.predict(off).mean - condition(training, {}, three_scales()).predict(points).mean) < 1e-12);
  const std::vector<int> coordinates{1};
  CHECK(process.predict_with_gradient(off, coordinates).mean_gradient[0].isZero(0.0));
  CHECK(std::isinf(process.hyper_parameters().length_scales[1]));
  const std::vector<OutsideRange> outside = process.outside_training_range(off);
  REQUIRE(outside.size() >= 4);
  CHECK(outside[0].coordinate == 1);
  CHECK(outside[0].low == 0.25);
  CHECK(process.outside_training_range(padded.x).empty());
}
