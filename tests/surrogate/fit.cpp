#include "surrogate/fit.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/error.hpp"
#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "surrogate/maximise.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;
using namespace surrogate;

namespace {

/// T = 1 + 2 mu (1 + 0.5 log1p(H/2)) - 0.3 H w/(1+H) + 0.4 w^2 on mu [0.1, 0.8], H [0, 10], w [0, 1].
double torque(const VectorXd& x) {
  const double mu = 0.1 + 0.7 * x[0], h = 10.0 * x[1], w = x[2];
  return 1.0 + 2.0 * mu * (1.0 + 0.5 * std::log1p(h / 2.0)) - 0.3 * h * w / (1.0 + h) + 0.4 * w * w;
}

TrainingSet torque_runs(int runs, std::uint64_t seed, double noise_sd, bool noise_known) {
  data::RandomStream random(seed, data::Purpose::test);
  TrainingSet training{scrambled_sobol(runs, 3, seed), VectorXd(runs),
                       VectorXd::Constant(runs, noise_known ? noise_sd * noise_sd : 0.0)};
  for (int i = 0; i < runs; ++i) training.y[i] = torque(training.x.row(i)) + noise_sd * random.normal();
  return training;
}

double q2(const GaussianProcess& process, std::uint64_t seed) {
  const MatrixXd points = scrambled_sobol(2000, 3, seed + 1000);
  VectorXd truth(2000);
  for (int i = 0; i < 2000; ++i) truth[i] = torque(points.row(i));
  const VectorXd error = process.predict_marginal(points).mean - truth;
  return 1.0 - error.squaredNorm() / (truth.array() - truth.mean()).square().sum();
}

}  // namespace

TEST_CASE("a fit learns a torque-like function from 64 noisy runs") {
  const GaussianProcess process = fit(torque_runs(64, 1, 0.02, false));
  CHECK(q2(process, 1) > 0.998);
  CHECK(process.diagnostics().converged);
  CHECK(process.hyper_parameters().nugget_sd == Approx(0.02).epsilon(0.35));
}

TEST_CASE("known noise is not fitted again as nugget") {
  const GaussianProcess process = fit(torque_runs(256, 2, 0.02, true), {.starts = 2});
  // The noise of 256 runs is itself known to 1/sqrt(2 * 256) = 4.4 %: three times that.
  CHECK(std::hypot(process.hyper_parameters().nugget_sd, 0.02) < 0.02 * 1.132);
  CHECK(q2(process, 2) > 0.9995);
}

TEST_CASE("the same seed gives the same fit to the bit, and every start's outcome is told") {
  const TrainingSet training = torque_runs(40, 3, 0.02, true);
  const GaussianProcess a = fit(training, {.seed = 5}), b = fit(training, {.seed = 5});
  CHECK(a.hyper_parameters().length_scales == b.hyper_parameters().length_scales);
  CHECK(a.log_marginal_likelihood() == b.log_marginal_likelihood());
  REQUIRE(a.diagnostics().starts.size() == 8);
  CHECK(a.diagnostics().agreeing_starts >= 1);
  for (const StartOutcome& outcome : a.diagnostics().starts) CHECK(outcome.evaluations > 0);
}

TEST_CASE("Newton on the average information and L-BFGS find the same maximum") {
  for (const std::uint64_t seed : {4, 5, 6}) {
    const TrainingSet training = torque_runs(50, seed, 0.02, false);
    FitOptions options;
    options.seed = seed;
    Likelihood likelihood(standardise(training, options.scale), options.kernel, options.mean, options.nugget);
    const Objective objective = make_objective(likelihood, options);
    const VectorXd start = to_logs({Eigen::Vector3d(0.8, 0.8, 0.8), 1.0, 1e-3}, true);
    const StartOutcome newton = maximise(objective, start, options), lbfgs = maximise_lbfgs(objective, start, options);
    CHECK(newton.converged);
    CHECK(newton.objective == Approx(lbfgs.objective).margin(1e-3));
  }
}

TEST_CASE("every start ends at a maximum, also where one input has no influence and the box cuts the steps") {
  // Exact values of a function of the second input alone, replicated: the length scale of the first belongs on its
  // bound, and the way there is along ridges.
  TrainingSet training{scrambled_sobol(30, 2, 3), VectorXd(30), VectorXd::Constant(30, 1e-6)};
  training.x.bottomRows(5) = training.x.topRows(5);
  for (int i = 0; i < 30; ++i) training.y[i] = 3.0 + std::sin(1.0 + 5.0 * training.x(i, 1));
  const GaussianProcess process = fit(training, {.seed = 3, .estimate = Estimate::maximum_likelihood});
  const FitDiagnostics& diagnostics = process.diagnostics();
  CHECK(diagnostics.agreeing_starts == 8);
  for (const StartOutcome& start : diagnostics.starts) {
    CHECK(start.converged);
    CHECK(start.gradient_norm < 0.1);
  }
  REQUIRE_FALSE(diagnostics.bound_hits.empty());
  CHECK(diagnostics.bound_hits[0].parameter == "length scale of input 1");
  CHECK(diagnostics.bound_hits[0].harmless);
}

TEST_CASE("the unit of the output and a constant column do not change a fit") {
  const TrainingSet training = torque_runs(40, 7, 0.02, true);
  TrainingSet tiny{MatrixXd(40, 4), 1e-5 * training.y, 1e-10 * training.noise_variance};
  tiny.x << training.x, VectorXd::Constant(40, 0.5);
  const GaussianProcess a = fit(training), b = fit(tiny);
  CHECK((a.hyper_parameters().length_scales - b.hyper_parameters().length_scales.head(3)).cwiseAbs().maxCoeff() < 1e-3);
  CHECK(a.hyper_parameters().signal_sd == Approx(1e5 * b.hyper_parameters().signal_sd).epsilon(1e-3));
}

TEST_CASE("a constant output, two runs and a single varying point are fitted without trouble") {
  TrainingSet flat{scrambled_sobol(10, 2, 1), VectorXd::Constant(10, 3.0), VectorXd::Constant(10, 1e-4)};
  CHECK(fit(flat).predict(flat.x).mean[0] == Approx(3.0).epsilon(1e-6));
  flat.noise_variance.setZero();
  CHECK(fit(flat).predict(flat.x).mean[0] == Approx(3.0).epsilon(1e-6));
  const TrainingSet two{scrambled_sobol(2, 2, 1), Eigen::Vector2d(1.0, 2.0), {}};
  CHECK(std::isfinite(fit(two).predict(two.x).mean[0]));
}

TEST_CASE("a hyper-parameter on its bound is reported") {
  FitOptions options;
  options.bounds.length_scale.high = 0.2;
  const GaussianProcess process = fit(torque_runs(40, 8, 0.02, true), options);
  REQUIRE_FALSE(process.diagnostics().bound_hits.empty());
  CHECK(process.diagnostics().bound_hits[0].parameter.substr(0, 12) == "length scale");
  CHECK(process.diagnostics().bound_hits[0].upper);
}

TEST_CASE("what cannot train a surrogate is bad input with its place") {
  TrainingSet training = torque_runs(10, 1, 0.02, true);
  training.y[3] = std::nan("");
  CHECK_THROWS_WITH(fit(training), Catch::Contains("run 4"));
  training = torque_runs(10, 1, 0.02, true);
  training.noise_variance[2] = -1.0;
  CHECK_THROWS_WITH(fit(training), Catch::Contains("run 3"));
  training = torque_runs(10, 1, 0.02, true);
  training.y[0] = -1.0;
  CHECK_THROWS_WITH(fit(training, {.scale = OutputScale::log}), Catch::Contains("run 1"));
  CHECK_THROWS_AS(fit(torque_runs(8, 1, 0.02, true), {.mean = MeanBasis::quadratic}), data::InputError);
}
