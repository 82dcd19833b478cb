#include "surrogate/validation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "surrogate/judgement.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;
using namespace surrogate;

namespace {

template <class Function>
TrainingSet runs_of(Function function, int runs, int dimension, double noise_sd, std::uint64_t seed) {
  data::RandomStream random(seed, data::Purpose::test, 1);
  TrainingSet training{scrambled_sobol(runs, dimension, seed), VectorXd(runs),
                       VectorXd::Constant(runs, noise_sd * noise_sd)};
  for (int i = 0; i < runs; ++i) training.y[i] = function(VectorXd(training.x.row(i))) + noise_sd * random.normal();
  return training;
}

double smooth(const VectorXd& x) { return 2.0 + std::sin(2.0 * x[0]) + x[0] * x[1]; }
/// Far too wiggly for the few runs it gets.
double rough(const VectorXd& x) { return std::sin(40.0 * x[0]) * std::cos(35.0 * x[1]); }

}  // namespace

TEST_CASE("a smooth function with honest errors makes a good surrogate, on either scale of the output") {
  for (const OutputScale scale : {OutputScale::linear, OutputScale::log}) {
    const TrainingSet training = runs_of(smooth, 60, 2, 0.03, 3);
    const FitOptions options{.scale = scale};
    const Validation v = validate(training, options, fit(training, options));
    CAPTURE(v.finding);
    CHECK(v.verdict == SurrogateVerdict::good);
    CHECK(v.q2_held_out > 0.98);
    CHECK(v.q2_leave_one_out > 0.98);
    CHECK(v.q2_function > v.q2_held_out);
    CHECK(v.coverage_held_out.observed[2] > 0.85);
    CHECK(v.folds.size() == 5);
    CHECK(v.more_runs == 0);
  }
}

TEST_CASE("a function that the runs cannot resolve makes an unusable surrogate, with a remedy") {
  const TrainingSet training = runs_of(rough, 30, 2, 0.01, 4);
  const Validation v = validate(training, {}, fit(training));
  CHECK(v.verdict == SurrogateVerdict::unusable);
  CHECK(v.more_runs >= 8);
  CHECK(v.remedy.find("runs") != std::string::npos);
  CHECK(v.next_points.rows() == 3);
}

TEST_CASE("the halves whose errors say how many runs to add cover every input, replicates together") {
  // In the order of a design every second run lies in the same half of the second input.
  MatrixXd x(48, 2);
  x << scrambled_sobol(32, 2, 3), scrambled_sobol(16, 2, 3);  // the first sixteen points twice
  const TrainingSet training{x, VectorXd(x.col(1)), VectorXd::Zero(48)};
  std::vector<std::vector<int>> halves;
  const HeldOutModel model = [&](const std::vector<int>& kept, const std::vector<int>& left) {
    halves.push_back(kept);
    HeldOutPrediction found;
    found.prediction.mean = VectorXd::Zero(static_cast<Eigen::Index>(left.size()));
    return found;
  };
  Validation validation;
  validation.runs = 48;
  validation.verdict = SurrogateVerdict::caution;
  validation.q2_function = 0.8;
  validation.q2_attainable = 1.0;
  validation.coverage_held_out.observed = {0.5, 0.9, 0.95};
  validation.folds.resize(2);
  explain(validation, training, model, {});
  REQUIRE(halves.size() == 2);
  for (const std::vector<int>& half : halves) {
    const MatrixXd points = x(half, Eigen::all);
    CHECK(half.size() >= 16);
    for (int input = 0; input < 2; ++input) {
      CHECK(points.col(input).minCoeff() < 0.2);
      CHECK(points.col(input).maxCoeff() > 0.8);
    }
    for (int i = 0; i < 16; ++i)
      CHECK(std::count(half.begin(), half.end(), i) == std::count(half.begin(), half.end(), i + 32));
  }
}

TEST_CASE("standard errors that are far too small are seen where no nugget may explain them") {
  TrainingSet training = runs_of(smooth, 60, 2, 0.1, 5);
  training.noise_variance *= 1e-4;
  const FitOptions options{.nugget = false};
  const Validation v = validate(training, options, fit(training, options));
  CHECK(v.verdict != SurrogateVerdict::good);
}

TEST_CASE("standard errors that are too large make intervals that are too wide, which is said, and no more runs") {
  TrainingSet training = runs_of(smooth, 60, 2, 0.01, 5);
  training.noise_variance *= 9.0;
  const Validation v = validate(training, {}, fit(training));
  CAPTURE(v.finding);
  CHECK(v.verdict == SurrogateVerdict::caution);
  CHECK(v.consequence.find("wider than its errors") != std::string::npos);
  CHECK(v.remedy.find("State the runs' standard errors as small as they are") != std::string::npos);
  CHECK(v.more_runs == 0);
}

TEST_CASE("standard errors that are right are not blamed for intervals that are wide where the response is small") {
  const auto product = [](const VectorXd& x) { return (0.1 + x[0]) * (0.1 + x[1]) * (0.2 + x[2]) * (1.0 + x[3]); };
  int careful = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    TrainingSet training = runs_of(product, 80, 4, 0.0, seed);
    data::RandomStream random(seed, data::Purpose::test);
    for (Eigen::Index i = 0; i < training.y.size(); ++i) {
      training.noise_variance[i] = std::pow(0.005 * training.y[i], 2);
      training.y[i] *= 1.0 + 0.005 * random.normal();
    }
    const Validation v = validate(training, {}, fit(training));
    CAPTURE(seed, v.finding, v.remedy);
    CHECK(v.remedy.find("standard errors as small") == std::string::npos);
    careful += v.consequence.find("wider than its errors") != std::string::npos;
  }
  CHECK(careful > 0);
}

TEST_CASE("an exact code of a smooth response makes a good surrogate, however careful its tiny intervals are") {
  const auto parabola = [](const VectorXd& x) { return 1.0 + x[0] * x[0] + 0.3 * x[1] + 0.2 * x[0] * x[1]; };
  const auto wave = [](const VectorXd& x) { return std::sin(9.0 * x[0]) + x[1]; };
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    TrainingSet exact = runs_of(parabola, 60, 2, 0.0, seed);
    const Validation v = validate(exact, {}, fit(exact));
    CAPTURE(seed, v.finding, v.held_out_reach);
    CHECK(v.held_out_reach < 0.02);
    CHECK(v.verdict == SurrogateVerdict::good);
    // What the response does between few runs is felt.
    exact = runs_of(wave, 15, 2, 0.0, seed);
    CHECK(validate(exact, {}, fit(exact)).held_out_reach > 0.1);
  }
}

TEST_CASE("runs that move one input at a time leave their interplay unknown, which is said") {
  constexpr int steps = 12;
  const auto star = [](bool with_joint) {
    TrainingSet training{MatrixXd::Constant(2 * steps + (with_joint ? 1 : 0), 2, 0.5), {}, {}, {"friction", "rpm"}};
    for (int k = 0; k < 2 * steps; ++k) training.x(k, k / steps) = (k % steps + 0.5) / steps;
    if (with_joint) training.x.row(2 * steps) << 0.9, 0.9;
    training.y.resize(training.x.rows());
    for (int i = 0; i < training.y.size(); ++i) training.y[i] = smooth(VectorXd(training.x.row(i)));
    training.noise_variance = VectorXd::Constant(training.y.size(), 1e-4);
    return training;
  };
  const TrainingSet apart = star(false), joint = star(true);
  const Validation v = validate(apart, {}, fit(apart));
  CHECK(v.verdict == SurrogateVerdict::caution);
  CHECK_THAT(v.finding, Catch::Contains("no run moves friction and rpm together"));
  CHECK_THAT(v.remedy, Catch::Contains("move all inputs at once"));
  CHECK(v.more_runs > 0);
  CHECK(validate(joint, {}, fit(joint)).apart.empty());
}

TEST_CASE("an output that is all noise is not called good") {
  const TrainingSet training = runs_of([](const VectorXd&) { return 1.0; }, 40, 2, 0.1, 6);
  const Validation v = validate(training, {}, fit(training));
  CHECK(v.verdict != SurrogateVerdict::good);
}

TEST_CASE("three runs are too few to say anything") {
  const TrainingSet training = runs_of(smooth, 3, 2, 0.01, 7);
  const FitOptions options{.mean = MeanBasis::constant};
  CHECK(validate(training, options, fit(training, options)).verdict == SurrogateVerdict::unusable);
}

TEST_CASE("jitter, a bound and a maximisation that did not converge are each said, and make no good surrogate") {
  FitDiagnostics met;
  met.converged = false;
  met.jitter = 3e-11;
  met.bound_hits = {{"signal", true, 300.0, false}, {"nugget", false, 1e-5, true}};
  const std::vector<std::string> notes = fit_notes(met);
  REQUIRE(notes.size() == 4);
  CHECK_THAT(notes[0], Catch::Contains("did not converge"));
  CHECK_THAT(notes[1], Catch::Contains("jitter of 3.0e-11"));
  CHECK_THAT(notes[2], Catch::Contains("signal is on its upper bound, 300"));
  CHECK_THAT(notes[3], Catch::Contains("no run-to-run scatter"));

  // Numbers of a good validation, so that only the fit's own trouble counts.
  Validation numbers;
  numbers.runs = 40;
  numbers.coverage_held_out.observed = {0.5, 0.9, 0.95};
  numbers.q2_attainable = numbers.q2_function = 0.99;
  numbers.mahalanobis_probability = 0.5;
  FitDiagnostics clean;
  clean.converged = true;
  CHECK(judge(numbers, 40, clean, {}) == SurrogateVerdict::good);
  CHECK(judge(numbers, 40, met, {}) == SurrogateVerdict::caution);
  met.converged = true;
  CHECK(judge(numbers, 40, met, {}) == SurrogateVerdict::caution);  // the signal's bound
  met.bound_hits.erase(met.bound_hits.begin());
  CHECK(judge(numbers, 40, met, {}) == SurrogateVerdict::good);
}

TEST_CASE("two runs of an exact code almost at one point need jitter, and the fit says how much") {
  TrainingSet training{scrambled_sobol(12, 2, 4), VectorXd(12), {}};
  training.x.row(1) = training.x.row(0);
  training.x(1, 0) += 1e-9;
  for (int i = 0; i < 12; ++i) training.y[i] = 1.0 + training.x(i, 0);
  HyperParameters hyper;
  hyper.length_scales = Eigen::Vector2d(20.0, 20.0);
  hyper.signal_sd = 1.0;
  const GaussianProcess process = condition(training, {.kernel = Kernel::squared_exponential}, hyper);
  CHECK(process.diagnostics().jitter > 0.0);
  CHECK_THAT(fit_notes(process.diagnostics()).at(0), Catch::Contains("jitter"));
}

TEST_CASE("pivoted errors are a whitening: uncorrelated, and their squares add up to the Mahalanobis distance") {
  data::RandomStream random(8, data::Purpose::test);
  MatrixXd root(6, 6);
  VectorXd error(6);
  for (int i = 0; i < 6; ++i) {
    error[i] = random.normal();
    for (int j = 0; j < 6; ++j) root(i, j) = random.normal();
  }
  const MatrixXd covariance = root * root.transpose();
  const PivotedErrors pivoted = pivoted_errors(error, covariance);
  CHECK(pivoted.errors.squaredNorm() == Approx(error.dot(covariance.llt().solve(error))).epsilon(1e-10));
  // The first pivot is the largest variance, and its error the plain standardised one.
  Eigen::Index largest = 0;
  covariance.diagonal().maxCoeff(&largest);
  CHECK(pivoted.order[0] == largest);
  CHECK(pivoted.errors[0] == Approx(error[largest] / std::sqrt(covariance(largest, largest))));
}

TEST_CASE("a covariance of lower rank yields as many pivoted errors as its rank") {
  const VectorXd direction = Eigen::Vector3d(1.0, 2.0, -1.0);
  const PivotedErrors pivoted = pivoted_errors(0.5 * direction, direction * direction.transpose());
  REQUIRE(pivoted.errors.size() == 1);
  CHECK(std::abs(pivoted.errors[0]) == Approx(0.5));
}

TEST_CASE("over processes that are true the Mahalanobis distance follows its F law and intervals cover as they say",
          "[slow]") {
  // Data drawn from the model itself at known correlation; hyper-parameters other than the variance are given, so the
  // law is exact but for the variance's estimate: p-values of 200 draws against uniform, Kolmogorov's 0.1 % bound 1.95.
  const MatrixXd x = scrambled_sobol(30, 2, 9);
  HyperParameters hyper;
  hyper.length_scales = Eigen::Vector2d(0.4, 0.7);
  hyper.signal_sd = 1.0;
  data::RandomStream random(9, data::Purpose::test);
  // Prior draws: the process conditioned on nothing, through its prior covariance.
  MatrixXd prior(30, 30);
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < 30; ++j) {
      double square = ((x.row(i) - x.row(j)).array() / hyper.length_scales.transpose().array()).square().sum();
      double value = 0.0;
      correlate(Kernel::matern52, {{&square, 1}, {&value, 1}, {nullptr, 0}});
      prior(i, j) = value;
    }
  const MatrixXd root = prior.llt().matrixL();
  std::vector<double> probabilities;
  double inside = 0.0;
  for (int draw = 0; draw < 200; ++draw) {
    VectorXd normal(30);
    for (double& value : normal) value = random.normal();
    const VectorXd y = root * normal;
    const TrainingSet training{x.topRows(20), y.head(20), {}};
    // Signal variance by restricted likelihood in closed form: with s^2 = 1, 2 (log-likelihood terms) hold the
    // quadratic form.
    const GaussianProcess unit = condition(training, {}, hyper);
    const Eigen::VectorXd& m = unit.parts().front().factorised.pooled.mean;
    const double scale2 = m.dot(unit.parts().front().factorised.residual_weights) / 19.0;
    HyperParameters fitted = hyper;
    fitted.signal_sd = std::sqrt(scale2);
    const Prediction p = condition(training, {}, fitted).predict(x.bottomRows(10));
    const VectorXd error = y.tail(10) - p.mean;
    const PivotedErrors pivoted = pivoted_errors(error, p.covariance);
    const double probability = mahalanobis_probability(pivoted.errors.squaredNorm(), 10, 19);
    probabilities.push_back(probability);
    inside += coverage((error.array() / p.covariance.diagonal().array().sqrt()).matrix()).observed[2] / 200.0;
  }
  std::sort(probabilities.begin(), probabilities.end());
  double distance = 0.0;
  for (int i = 0; i < 200; ++i) distance = std::max(distance, std::abs(probabilities[i] - (i + 0.5) / 200.0));
  CHECK(distance * std::sqrt(200.0) < 1.95);
  CHECK(inside > 0.90);  // Student's t with 19 degrees of freedom against the normal's 1.96: 93.5 % expected
  CHECK(inside < 0.97);
}
