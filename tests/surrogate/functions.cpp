// Known functions as things to learn. Values at points: tests/reference/theory-facts.json; the functions are
// Ishigami & Homma (1990), the borehole of Morris, Mitchell & Ylvisaker (1993), Branin and Hartmann-3 (Dixon & Szego
// 1978).
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "surrogate/fit.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;
using namespace surrogate;
using std::numbers::pi;

namespace {

nlohmann::json fact(const char* name) {
  std::ifstream file(DEMCAL_SOURCE_DIR "/tests/reference/theory-facts.json");
  return nlohmann::json::parse(file).at(name);
}

double ishigami(const VectorXd& u) {
  const VectorXd x = pi * (2.0 * u.array() - 1.0);
  return std::sin(x[0]) + 7.0 * std::pow(std::sin(x[1]), 2) + 0.1 * std::pow(x[2], 4) * std::sin(x[0]);
}

double borehole_at(const VectorXd& x) {
  const double ratio = std::log(x[1] / x[0]);
  return 2.0 * pi * x[2] * (x[3] - x[5]) /
         (ratio * (1.0 + 2.0 * x[6] * x[2] / (ratio * x[0] * x[0] * x[7]) + x[2] / x[4]));
}

double borehole(const VectorXd& u) {
  VectorXd low(8), high(8);
  low << 0.05, 100, 63070, 990, 63.1, 700, 1120, 9855;
  high << 0.15, 50000, 115600, 1110, 116, 820, 1680, 12045;
  return borehole_at(low + u.cwiseProduct(high - low));
}

double branin_at(double x, double y) {
  return std::pow(y - 5.1 / (4.0 * pi * pi) * x * x + 5.0 / pi * x - 6.0, 2) +
         10.0 * (1.0 - 1.0 / (8.0 * pi)) * std::cos(x) + 10.0;
}

double branin(const VectorXd& u) { return branin_at(-5.0 + 15.0 * u[0], 15.0 * u[1]); }

double hartmann3(const VectorXd& x) {
  const double alpha[4] = {1.0, 1.2, 3.0, 3.2};
  const double a[4][3] = {{3, 10, 30}, {0.1, 10, 35}, {3, 10, 30}, {0.1, 10, 35}};
  const double p[4][3] = {
      {0.3689, 0.1170, 0.2673}, {0.4699, 0.4387, 0.7470}, {0.1091, 0.8732, 0.5547}, {0.0381, 0.5743, 0.8828}};
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    double exponent = 0.0;
    for (int k = 0; k < 3; ++k) exponent += a[i][k] * std::pow(x[k] - p[i][k], 2);
    sum -= alpha[i] * std::exp(-exponent);
  }
  return sum;
}

double learnt_q2(double (*function)(const VectorXd&), int dimension, int runs, const FitOptions& options) {
  TrainingSet training{scrambled_sobol(runs, dimension, 1), VectorXd(runs), {}};
  for (int i = 0; i < runs; ++i) training.y[i] = function(training.x.row(i));
  const GaussianProcess process = fit(training, options);
  CHECK(process.diagnostics().converged);
  const MatrixXd points = scrambled_sobol(1000, dimension, 99);
  VectorXd truth(1000);
  for (int i = 0; i < 1000; ++i) truth[i] = function(points.row(i));
  return 1.0 -
         (process.predict_marginal(points).mean - truth).squaredNorm() / (truth.array() - truth.mean()).square().sum();
}

}  // namespace

TEST_CASE("the functions to learn have their published values") {
  CHECK(borehole_at(Eigen::Map<const VectorXd>(fact("borehole")["point"].get<std::vector<double>>().data(), 8)) ==
        Approx(fact("borehole")["value"].get<double>()).epsilon(1e-12));
  const nlohmann::json branin_facts = fact("branin");
  for (const auto& minimum : branin_facts["minima"])
    CHECK(branin_at(minimum[0], minimum[1]) == Approx(branin_facts["fmin"].get<double>()).epsilon(1e-6));
  const std::vector<double> x = fact("hartmann3")["x"];
  CHECK(hartmann3(Eigen::Map<const VectorXd>(x.data(), 3)) ==
        Approx(fact("hartmann3")["f"].get<double>()).epsilon(1e-6));
}

TEST_CASE("Branin, Hartmann-3, the borehole and Ishigami's function are learnt") {
  // Bounds on Q2 with ten runs or so per input, more for the wavy ones; kernels smooth as the functions are. Ishigami's
  // sin^2 has four half-waves over its range, which 150 points (5.3 per axis) hardly see: with these scikit-learn 1.2.1
  // reaches 0.944 to 0.954 on the same model (ours 0.942), with 256 0.986 to 0.987.
  const FitOptions smooth{.kernel = Kernel::squared_exponential, .starts = 3};
  CHECK(learnt_q2(branin, 2, 40, smooth) > 0.999);
  CHECK(learnt_q2(hartmann3, 3, 100, {.starts = 3}) > 0.97);
  CHECK(learnt_q2(borehole, 8, 80, smooth) > 0.999);
  CHECK(learnt_q2(ishigami, 3, 256, {.starts = 3}) > 0.97);
}

TEST_CASE("on the torque-like function the median Q2 over 20 seeds reaches its targets at 64, 256 and 1024 runs",
          "[slow]") {
  const auto torque = [](const VectorXd& x) {
    const double mu = 0.1 + 0.7 * x[0], h = 10.0 * x[1], w = x[2];
    return 1.0 + 2.0 * mu * (1.0 + 0.5 * std::log1p(h / 2.0)) - 0.3 * h * w / (1.0 + h) + 0.4 * w * w;
  };
  const MatrixXd points = scrambled_sobol(2000, 3, 4711);
  VectorXd truth(2000);
  for (int i = 0; i < 2000; ++i) truth[i] = torque(points.row(i));
  for (const auto& [runs, target] : {std::pair{64, 0.9994}, std::pair{256, 0.9998}, std::pair{1024, 0.99995}}) {
    std::vector<double> found;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      data::RandomStream random(seed, data::Purpose::test, 5);
      TrainingSet training{scrambled_sobol(runs, 3, seed), VectorXd(runs), {}};
      for (int i = 0; i < runs; ++i) training.y[i] = torque(VectorXd(training.x.row(i))) + 0.02 * random.normal();
      const VectorXd error = fit(training, {.starts = 1}).predict_marginal(points).mean - truth;
      found.push_back(1.0 - error.squaredNorm() / (truth.array() - truth.mean()).square().sum());
    }
    std::sort(found.begin(), found.end());
    const double median = 0.5 * (found[9] + found[10]);
    CAPTURE(runs, median);
    CHECK(median >= target);
  }
}
