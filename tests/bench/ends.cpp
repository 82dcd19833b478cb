// Do predictions hold at the ends of a range where the function bends?
//   bench_ends [--runs N] [--designs N] [--noise SHARE]
// Thirteen functions of two inputs: poles, powers, saturations and exponentials that bend at one end, and others that
// bend alike all over or not at all. Each design is a scrambled Sobol one with runs of 1 % (--noise), learnt on the
// inputs' own scales and on those that choose_stretches chooses. Printed, own -> chosen: the share of 90 % intervals
// that hold at 200 points with b below 0.15, above 0.85 and anywhere, the mean square of the deviations in predicted
// sds, and the root of the mean squared error over that on the own scales.
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "surrogate/stretch.hpp"

using Eigen::Index;
using Eigen::MatrixXd;
using namespace surrogate;

namespace {

struct Named {
  std::string name;
  std::function<double(double a, double b)> value;
};

const std::vector<Named> functions{
    {"1 + a + b", [](double a, double b) { return 1.0 + a + b; }},
    {"1 + a b", [](double a, double b) { return 1.0 + a * b; }},
    {"2 + sin(3 a) + b^2", [](double a, double b) { return 2.0 + std::sin(3.0 * a) + b * b; }},
    {"3 + a + sin(6 b)", [](double a, double b) { return 3.0 + a + std::sin(6.0 * b); }},
    {"3 + a + tanh(10 (b - 0.5))", [](double a, double b) { return 3.0 + a + std::tanh(10.0 * (b - 0.5)); }},
    {"(1 + a) sqrt(0.1 + 0.9 b)", [](double a, double b) { return (1.0 + a) * std::sqrt(0.1 + 0.9 * b); }},
    {"(1 + a) sqrt(0.01 + b)", [](double a, double b) { return (1.0 + a) * std::sqrt(0.01 + b); }},
    {"(0.5 + a) / (0.05 + b)", [](double a, double b) { return (0.5 + a) / (0.05 + b); }},
    {"(1 + a) / sqrt(1.05 - b)", [](double a, double b) { return (1.0 + a) / std::sqrt(1.05 - b); }},
    {"(1 + a) (1 + min(b / 0.15, 1))", [](double a, double b) { return (1.0 + a) * (1.0 + std::min(b / 0.15, 1.0)); }},
    {"(1 + a) tanh(5 b)", [](double a, double b) { return (1.0 + a) * std::tanh(5.0 * b); }},
    {"(1 + a) exp(3 b)", [](double a, double b) { return (1.0 + a) * std::exp(3.0 * b); }},
    {"sqrt(0.01 + a) + 0.3 / (0.1 + b)", [](double a, double b) { return std::sqrt(0.01 + a) + 0.3 / (0.1 + b); }},
};

constexpr Index points_a_part = 200;

/// Sums over the points of one part of the range.
struct Held {
  double inside = 0.0, deviation = 0.0, error = 0.0;
};

/// Points with b at the low end, at the high end, and anywhere.
MatrixXd points_of(std::uint64_t seed) {
  MatrixXd points = scrambled_sobol(3 * points_a_part, 2, seed);
  for (Index i = 0; i < points_a_part; ++i) {
    points(i, 1) *= 0.15;
    points(points_a_part + i, 1) = 0.85 + 0.15 * points(points_a_part + i, 1);
  }
  return points;
}

MatrixXd stretched(MatrixXd points, const std::vector<Stretch>& stretches) {
  for (Index k = 0; k < points.cols(); ++k)
    for (double& u : points.col(k)) u = stretches[k].place(u);
  return points;
}

}  // namespace

int main(int count, char** arguments) {
  int runs = 40, designs = 10;
  double noise = 0.01;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string key = arguments[i];
    if (key == "--runs") runs = std::stoi(arguments[i + 1]);
    if (key == "--designs") designs = std::stoi(arguments[i + 1]);
    if (key == "--noise") noise = std::stod(arguments[i + 1]);
  }
  const FitOptions options{
      .seed = 1, .hyper_uncertainty = HyperUncertainty::integrated_if_few, .between_runs = BetweenRuns::doubted};
  fmt::print("| function | designs with a stretch | b below 0.15 | b above 0.85 | anywhere |\n|---|---|---|---|---|\n");
  for (const Named& function : functions) {
    std::array<std::array<Held, 3>, 2> held{};
    int chosen = 0;
    for (int design = 0; design < designs; ++design) {
      data::RandomStream random(static_cast<std::uint64_t>(design), data::Purpose::test, 5);
      TrainingSet training{scrambled_sobol(runs, 2, 1 + design), Eigen::VectorXd(runs), Eigen::VectorXd(runs)};
      for (Index i = 0; i < runs; ++i) {
        const double y = function.value(training.x(i, 0), training.x(i, 1));
        training.y[i] = y * (1.0 + noise * random.normal());
        training.noise_variance[i] = std::pow(noise * y, 2);
      }
      const std::vector<Stretch> best = choose_stretches(training, options, {1.0, 1.0});
      chosen += !best[0].is_none() || !best[1].is_none();
      const MatrixXd points = points_of(1000 + design);
      for (const bool with : {false, true}) {
        const std::vector<Stretch> stretches = with ? best : std::vector<Stretch>(2);
        TrainingSet learnt = training;
        learnt.x = stretched(training.x, stretches);
        const MarginalPrediction found = fit(learnt, options).predict_marginal(stretched(points, stretches));
        for (Index i = 0; i < points.rows(); ++i) {
          const double error = found.mean[i] - function.value(points(i, 0), points(i, 1));
          const double deviation = error * error / found.variance[i];
          Held& part = held[with][i / points_a_part];
          part.inside += deviation < 1.645 * 1.645;
          part.deviation += deviation;
          part.error += error * error;
        }
      }
    }
    fmt::print("| {} | {} of {}", function.name, chosen, designs);
    const double all = static_cast<double>(points_a_part * designs);
    for (int part = 0; part < 3; ++part) {
      const Held &own = held[0][part], &other = held[1][part];
      fmt::print(" | {:.2f} -> {:.2f}, {:.2f} -> {:.2f}, {:.2f}", own.inside / all, other.inside / all,
                 own.deviation / all, other.deviation / all, std::sqrt(other.error / own.error));
    }
    fmt::print(" |\n");
    std::fflush(stdout);
  }
}
