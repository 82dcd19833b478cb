// Maximum a posteriori of the high level's parameters by NLopt's BOBYQA (M. J. D. Powell, DAMTP 2009/NA06), and their
// integration about it. u = (rho / r, log q, log s / t, log nugget sd / t), two_level.hpp.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlopt.hpp>

#include "data/error.hpp"
#include "surrogate/design.hpp"
#include "surrogate/marginal.hpp"
#include "surrogate/two_level_likelihood.hpp"

namespace surrogate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void check(const GaussianProcess& low, const TrainingSet& high) {
  std::vector<data::Problem> problems;
  const auto add = [&](std::string what, std::string remedy) {
    problems.push_back({"two-level surrogate", std::move(what), std::move(remedy)});
  };
  if (high.y.size() < 3)
    add(fmt::format("{} high-level runs, but three are the least", high.y.size()), "add high-level runs");
  if (high.x.cols() != low.dimension())
    add(fmt::format("the high-level runs have {} inputs, the low-level runs {}", high.x.cols(), low.dimension()),
        "give both levels the same columns");
  if (high.x.rows() != high.y.size() || high.noise_variance.size() != high.y.size())
    add("high-level points, outputs and noise variances differ in number", "give one of each per run");
  else if (!high.x.allFinite() || !high.y.allFinite() || !high.noise_variance.allFinite() ||
           (high.noise_variance.array() < 0.0).any())
    add("a high-level run holds a value that is not finite, or a negative variance", "leave the run out");
  if (low.data().scale != OutputScale::linear)
    add("the output's scale is logarithmic, but y_high = rho y_low + delta is linear", "use the linear scale");
  if (!problems.empty()) throw data::InputError(data::ExitStatus::bad_data, std::move(problems));
}

/// Root mean square about the mean.
double spread(const VectorXd& values) { return std::sqrt((values.array() - values.mean()).square().mean()); }

/// The high level's posterior as a function of u.
struct Problem {
  HighProblem high;
  const TwoLevelOptions& options;
  double ratio = 1.0, size = 1.0;
  HyperPosterior posterior;

  TwoLevelParameters at(const VectorXd& u) const {
    return {.rho = ratio * u[0],
            .length_factor = std::exp(u[1]),
            .discrepancy_sd = size * std::exp(u[2]),
            .nugget_sd = options.nugget ? size * std::exp(u[3]) : 0.0};
  }
  double log_density(const VectorXd& u) const {
    const HighFit found = fit_high(high, at(u));
    if (!found.ok) return -std::numeric_limits<double>::infinity();
    const VectorXd deviation = u - posterior.prior_mean;
    return found.log_likelihood - 0.5 * deviation.dot(posterior.prior_precision.cwiseProduct(deviation));
  }
};

struct Named {
  const char* name;
  double low, high, prior_mean, prior_sd;
};
const Named components[] = {{"rho", -5.0, 5.0, 1.0, 1.0},
                            {"length factor of the discrepancy", std::log(0.1), std::log(50.0), 0.0, 1.0},
                            {"discrepancy", std::log(1e-5), std::log(10.0), std::log(0.3), 1.5},
                            {"nugget", std::log(1e-5), std::log(3.0), std::log(0.03), 1.5}};

StartOutcome fit_by_bobyqa(const Problem& problem, const VectorXd& start) {
  StartOutcome outcome{.start = start, .end = start, .objective = -std::numeric_limits<double>::infinity()};
  struct Call {
    const Problem& problem;
    StartOutcome& outcome;
  } call{problem, outcome};
  const HyperPosterior& box = problem.posterior;
  nlopt::opt optimiser(nlopt::LN_BOBYQA, static_cast<unsigned>(start.size()));
  optimiser.set_lower_bounds(std::vector<double>(box.low.begin(), box.low.end()));
  optimiser.set_upper_bounds(std::vector<double>(box.high.begin(), box.high.end()));
  optimiser.set_max_objective(
      [](unsigned count, const double* at, double*, void* data) -> double {
        const Call& self = *static_cast<Call*>(data);
        const VectorXd u = Eigen::Map<const VectorXd>(at, count);
        const double value = self.problem.log_density(u);
        ++self.outcome.evaluations;
        if (!(value > -1e300)) return -1e300;
        if (value > self.outcome.objective) {
          self.outcome.objective = value;
          self.outcome.end = u;
        }
        return value;
      },
      &call);
  optimiser.set_ftol_abs(1e-7);
  optimiser.set_maxeval(1000);
  std::vector<double> u(start.begin(), start.end());
  try {
    double value = 0.0;
    const nlopt::result status = optimiser.optimize(u, value);
    outcome.converged = status > 0 && status != nlopt::MAXEVAL_REACHED;
  } catch (const nlopt::roundoff_limited&) {  // BOBYQA can do no better at the optimum
    outcome.converged = true;
  } catch (const std::exception&) {
    outcome.converged = false;
  }
  outcome.points = static_cast<int>(problem.high.runs.y.size());
  return outcome;
}

}  // namespace

TwoLevelProcess fit_two_level(const GaussianProcess& low, const TrainingSet& high_runs,
                              const TwoLevelOptions& options) {
  TrainingSet high = high_runs;
  if (high.noise_variance.size() == 0) high.noise_variance = VectorXd::Zero(high.y.size());
  check(low, high);
  Problem problem{high_problem(low, high, options.discrepancy_mean), options};
  const double high_spread = spread(high.y), low_spread = spread(problem.high.low_at_high.mean);
  problem.size = high_spread > 0.0 ? high_spread : std::max(high.y.cwiseAbs().maxCoeff(), 1e-300);
  problem.ratio = low_spread > 0.0 && high_spread > 0.0 ? high_spread / low_spread : 1.0;

  const Index count = options.nugget ? 4 : 3;
  HyperPosterior& posterior = problem.posterior;
  posterior.low.resize(count);
  posterior.high = posterior.prior_mean = posterior.prior_precision = posterior.low;
  for (Index j = 0; j < count; ++j) {
    posterior.low[j] = components[j].low;
    posterior.high[j] = components[j].high;
    posterior.prior_mean[j] = components[j].prior_mean;
    posterior.prior_precision[j] = 1.0 / (components[j].prior_sd * components[j].prior_sd);
  }
  const MatrixXd cube = scrambled_sobol(std::max(options.starts, 1), static_cast<int>(count), options.seed);
  HighLevel fitted{.runs = high, .discrepancy_mean = options.discrepancy_mean};
  FitDiagnostics& diagnostics = fitted.diagnostics;
  for (Index start = 0; start < cube.rows(); ++start) {
    VectorXd u = posterior.prior_mean;
    for (Index j = 0; j < count && start > 0; ++j) u[j] += components[j].prior_sd * (2.0 * cube(start, j) - 1.0);
    diagnostics.starts.push_back(fit_by_bobyqa(problem, u.cwiseMax(posterior.low).cwiseMin(posterior.high)));
  }
  const StartOutcome best =
      *std::max_element(diagnostics.starts.begin(), diagnostics.starts.end(),
                        [](const StartOutcome& a, const StartOutcome& b) { return a.objective < b.objective; });
  diagnostics.converged = best.converged;
  for (StartOutcome& outcome : diagnostics.starts) {
    outcome.agrees = outcome.objective > best.objective - 0.1;
    diagnostics.agreeing_starts += outcome.agrees;
  }
  for (Index j = 0; j < count; ++j) {
    const bool at_low = best.end[j]<posterior.low[j] + 1e-3, at_high = best.end[j]> posterior.high[j] - 1e-3;
    if (!at_low && !at_high) continue;
    const double bound = at_high ? posterior.high[j] : posterior.low[j];
    diagnostics.bound_hits.push_back({.parameter = components[j].name,
                                      .upper = at_high,
                                      .value = j == 0 ? problem.ratio * bound : std::exp(bound),
                                      .harmless = j >= 2 && at_low});
  }
  std::vector<HyperNode> nodes{{best.end, 1.0}};
  if (options.hyper_uncertainty == HyperUncertainty::integrated) {
    posterior.mode = best.end;
    posterior.covariance = posterior.prior_precision.cwiseInverse().asDiagonal();
    posterior.log_density = [&problem](const VectorXd& u) { return problem.log_density(u); };
    nodes = integration_nodes(posterior, integration_options(high.y.size(), options.seed));
  }
  for (const HyperNode& node : nodes) {
    fitted.settings.push_back(problem.at(node.u));
    fitted.settings.back().weight = node.weight;
  }
  return {low, std::move(fitted)};
}

}  // namespace surrogate
