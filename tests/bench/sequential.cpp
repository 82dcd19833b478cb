// Sequential training on the four test functions of PUQ (O. Surer, M. Plumlee, S. M. Wild, Technometrics 66:157
// (2024)), with the product's own surrogate and criterion: bench_sequential [key=value ...].
//   repeats 30, runs 105, filling 210 (runs of the space-filling design), batch 5, noise 0 (sd of a run's scatter, in
//   the measurement's sd), functions unimodal,banana,bimodal,unidentifiable, designs sequential,filling
// Error: mean absolute difference of the density N(y; f, E) from its expectation, on a 50 x 50 grid.
// Prints one line per state: function, design, noise, repeat, runs, error, CPU seconds so far.
#include <fmt/core.h>

#include <cmath>
#include <ctime>
#include <map>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "surrogate/fit.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/refine/next_runs.hpp"

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector2d, Eigen::VectorXd;

struct Function {
  std::string name;
  Vector2d low, high;
  VectorXd observed, variance;
  VectorXd (*value)(const Vector2d& theta);
};

std::vector<Function> functions() {
  const auto pair = [](double a, double b) { return VectorXd(Vector2d(a, b)); };
  return {
      {"unimodal",
       {-4, -4},
       {4, 4},
       VectorXd::Constant(1, -6.0),
       VectorXd::Constant(1, 4.0),
       [](const Vector2d& t) { return VectorXd(VectorXd::Constant(1, t[0] * t[0] + t[0] * t[1] + t[1] * t[1])); }},
      {"banana",
       {-20, -10},
       {20, 5},
       pair(1, 3),
       pair(100, 1),
       [](const Vector2d& t) { return VectorXd(Vector2d(t[0], t[1] + 0.03 * t[0] * t[0])); }},
      {"bimodal",
       {-6, -4},
       {6, 8},
       pair(0, 2),
       pair(1 / std::sqrt(0.2), 1 / std::sqrt(0.75)),
       [](const Vector2d& t) { return VectorXd(Vector2d(t[1] - t[0] * t[0], t[1] - t[0])); }},
      {"unidentifiable",
       {-8, -8},
       {8, 8},
       pair(0, 0),
       pair(100, 1),
       [](const Vector2d& t) { return VectorXd(Vector2d(t[0], t[1])); }},
  };
}

struct Settings {
  int repeats = 30, runs = 105, filling = 210, batch = 5, first = 1;
  double noise = 0.0;
  std::string functions = "unimodal,banana,bimodal,unidentifiable", designs = "sequential,filling";
  surrogate::FitOptions fit;
};

bool listed(const std::string& list, const std::string& name) {
  std::stringstream items(list);
  for (std::string item; std::getline(items, item, ',');)
    if (item == name) return true;
  return false;
}

struct Runs {
  MatrixXd x, y;  // one row a run; x in the unit cube
};

/// The values at more points; the scatter of the n-th run of a repeat is the same in every design.
void add_runs(const Function& function, const Settings& settings, int repeat, const MatrixXd& points, Runs& runs) {
  for (Index i = 0; i < points.rows(); ++i) {
    const Index n = runs.x.rows();
    runs.x.conservativeResize(n + 1, 2);
    runs.x.row(n) = points.row(i);
    const Vector2d theta = function.low + (function.high - function.low).cwiseProduct(points.row(i).transpose());
    VectorXd value = function.value(theta);
    data::RandomStream random(static_cast<std::uint64_t>(repeat), data::Purpose::test, static_cast<std::uint32_t>(n));
    for (Index k = 0; k < value.size(); ++k)
      value[k] += settings.noise * std::sqrt(function.variance[k]) * random.normal();
    runs.y.conservativeResize(n + 1, value.size());
    runs.y.row(n) = value.transpose();
  }
}

/// The case of the runs so far: one surrogate and one measured number an output.
std::shared_ptr<const uq::CaseModel> make_model(const Function& function, const Settings& settings, const Runs& runs) {
  auto model = std::make_shared<uq::CaseModel>();
  model->name = function.name;
  for (const char* name : {"theta1", "theta2"}) {
    data::Parameter parameter;
    parameter.name = name;
    model->unknowns.push_back({.label = name, .prior = uq::ScaledPrior(parameter, parameter.prior), .cut = {}});
  }
  for (Index k = 0; k < runs.y.cols(); ++k) {
    surrogate::FitOptions fit = settings.fit;
    fit.nugget = settings.noise > 0.0;
    const surrogate::TrainingSet set{
        runs.x, runs.y.col(k), VectorXd::Constant(runs.x.rows(), std::pow(settings.noise, 2) * function.variance[k])};
    uq::RowGroup group{.emulator = {},
                       .base = MatrixXd::Zero(1, 2),
                       .unknown = Eigen::RowVector2i(0, 1),
                       .observed = function.observed.segment(k, 1),
                       .variance = function.variance.segment(k, 1),
                       .origin = {{}},
                       .coordinate = {}};
    group.emulator =
        uq::make_emulator(std::make_shared<const surrogate::GaussianProcess>(surrogate::fit(set, fit)), "",
                          static_cast<std::size_t>(k), {{uq::InputKind::parameter, 0}, {uq::InputKind::parameter, 1}});
    uq::find_coordinates(group, 2);
    model->groups.push_back(std::move(group));
  }
  return model;
}

double density_error(const Function& function, const uq::CaseModel& model) {
  MatrixXd grid(2500, 2);
  for (int i = 0; i < 50; ++i)
    for (int j = 0; j < 50; ++j) grid.row(50 * i + j) << i / 49.0, j / 49.0;
  const VectorXd logs = uq::log_likelihoods(model, grid);
  double sum = 0.0;
  for (Index i = 0; i < grid.rows(); ++i) {
    const Vector2d theta = function.low + (function.high - function.low).cwiseProduct(grid.row(i).transpose());
    const Eigen::ArrayXd residual = (function.observed - function.value(theta)).array();
    const double exact = std::exp(-0.5 * (residual.square() / function.variance.array() +
                                          (2.0 * std::numbers::pi * function.variance.array()).log())
                                             .sum());
    sum += std::abs(exact - std::exp(logs[i]));
  }
  return sum / static_cast<double>(grid.rows());
}

/// Draws of the posterior by systematic resampling of 4096 scrambled Sobol points, and its evidence.
uq::CaseState state_of(std::shared_ptr<const uq::CaseModel> model, std::uint64_t seed) {
  const MatrixXd points = surrogate::scrambled_sobol(4096, 2, seed + 77);
  const VectorXd logs = uq::log_likelihoods(*model, points);
  const VectorXd weight = (logs.array() - logs.maxCoeff()).exp();
  uq::CaseState state{.model = std::move(model), .draws = MatrixXd(512, 2), .log_evidence = 0.0};
  state.log_evidence = logs.maxCoeff() + std::log(weight.mean());
  double reached = 0.0;
  Index row = 0;
  for (Index i = 0; i < 512; ++i) {
    while (row + 1 < weight.size() && reached + weight[row] < (static_cast<double>(i) + 0.5) / 512.0 * weight.sum())
      reached += weight[row++];
    state.draws.row(i) = points.row(row);
  }
  return state;
}

void run_one(const Function& function, const Settings& settings, const std::string& design, int repeat) {
  const std::clock_t begin = std::clock();
  const auto seed = static_cast<std::uint64_t>(1000 + repeat);
  Runs runs{MatrixXd(0, 2), MatrixXd(0, function.observed.size())};
  add_runs(function, settings, repeat, surrogate::scrambled_sobol(10, 2, seed), runs);
  const int most = design == "filling" ? settings.filling : settings.runs;
  for (;;) {
    const std::shared_ptr<const uq::CaseModel> model = make_model(function, settings, runs);
    fmt::print("{},{},{},{},{},{:.4e},{:.2f}\n", function.name, design, settings.noise, repeat, runs.x.rows(),
               density_error(function, *model),
               static_cast<double>(std::clock() - begin) / static_cast<double>(CLOCKS_PER_SEC));
    std::fflush(stdout);
    const int count = std::min(settings.batch, most - static_cast<int>(runs.x.rows()));
    if (count <= 0) return;
    if (design == "filling") {
      add_runs(function, settings, repeat, surrogate::scrambled_sobol(count, 2, seed, static_cast<int>(runs.x.rows())),
               runs);
      continue;
    }
    uq::Acquisition acquisition{.cases = {state_of(model, seed)}, .existing = {}, .noise = {}, .rounded = {}};
    for (Index i = 0; i < runs.x.rows(); ++i)
      acquisition.existing.push_back({"", runs.x.row(i).transpose(), VectorXd(0)});
    acquisition.noise = [&](const uq::Emulator& emulator) {
      return uq::RunNoise{.absolute =
                              std::pow(settings.noise, 2) * function.variance[static_cast<Index>(emulator.output)]};
    };
    const uq::Batch batch =
        uq::next_batch(acquisition, {.runs = count,
                                     .seed = seed + 1000 * static_cast<std::uint64_t>(runs.x.rows()),
                                     .candidates = {},
                                     .reference = {}});
    MatrixXd points(static_cast<Index>(batch.runs.size()), 2);
    for (std::size_t i = 0; i < batch.runs.size(); ++i)
      points.row(static_cast<Index>(i)) = batch.runs[i].point.parameters.transpose();
    if (points.rows() == 0) return;
    add_runs(function, settings, repeat, points, runs);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  const std::map<std::string, int*> numbers{{"repeats", &settings.repeats},
                                            {"runs", &settings.runs},
                                            {"first", &settings.first},
                                            {"filling", &settings.filling},
                                            {"batch", &settings.batch}};
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const std::string key = option.substr(0, option.find('=')), value = option.substr(option.find('=') + 1);
    if (numbers.contains(key)) {
      *numbers.at(key) = std::stoi(value);
    } else if (key == "noise") {
      settings.noise = std::stod(value);
    } else if (key == "functions") {
      settings.functions = value;
    } else if (key == "designs") {
      settings.designs = value;
    } else if (key == "hyper") {
      settings.fit.hyper_uncertainty =
          value == "integrated" ? surrogate::HyperUncertainty::integrated : surrogate::HyperUncertainty::plug_in;
    } else if (key == "kernel") {
      settings.fit.kernel = value == "se" ? surrogate::Kernel::squared_exponential : surrogate::Kernel::matern52;
    } else {
      fmt::print(stderr, "unknown option {}\n", option);
      return 64;
    }
  }
  fmt::print("function,design,noise,repeat,runs,error,cpu_seconds\n");
  for (int repeat = settings.first; repeat < settings.first + settings.repeats; ++repeat)
    for (const Function& function : functions())
      for (const std::string design : {"sequential", "filling"})
        if (listed(settings.functions, function.name) && listed(settings.designs, design))
          run_one(function, settings, design, repeat);
}
