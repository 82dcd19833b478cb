#include "surrogate/stretch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "data/error.hpp"

namespace surrogate {
namespace {

using Eigen::Index;

constexpr int runs_looked_at = 150;      // a fit takes the cube of their number
constexpr std::size_t values_least = 5;  // of an input; few levels are explained by any scale
constexpr double straight = 3.0;         // length scale in ranges from which nothing bends
constexpr double half_decade = 3.1622776601683795;
constexpr double wide = 5.0;  // own ratio from which the logarithm differs from the input

bool has_enough_values(const Eigen::VectorXd& column) {
  std::set<long> values;
  for (const double value : column) values.insert(std::lround(1e6 * value));
  return values.size() >= values_least;
}

std::vector<double> candidates_of(double own_ratio) {
  std::vector<double> ratios;
  if (own_ratio >= wide) ratios.push_back(own_ratio);
  for (const double ratio : {10.0, 100.0, 0.1, 0.01}) ratios.push_back(ratio);
  return ratios;
}

/// A fit's best end: logs of the hyper-parameters, as FitOptions::first_start takes them.
struct Best {
  double objective = -std::numeric_limits<double>::infinity();
  Eigen::VectorXd logs;
};

Best best_of(const TrainingSet& training, const FitOptions& options) {
  Best best;
  try {
    const GaussianProcess process = fit(training, options);
    for (const StartOutcome& outcome : process.diagnostics().starts)
      if (outcome.objective > best.objective) best = {outcome.objective, outcome.end};
  } catch (const data::InputError&) {  // cannot be factorised on this scale
  }
  return best;
}

/// A stretch of one input that was tried, and what the process learnt on it.
struct Trial {
  Index input = 0;
  double ratio = 1.0;
  Best fit;
};

const Trial& best_of(const std::vector<Trial>& trials) {
  return *std::max_element(trials.begin(), trials.end(),
                           [](const Trial& a, const Trial& b) { return a.fit.objective < b.fit.objective; });
}

/// Whether little of the stretched range lies beyond the outermost of n runs. Where much does, the process claims less
/// at the end than the runs tell.
bool is_resolved(double ratio, double n) { return Stretch{std::max(ratio, 1.0 / ratio)}.place(1.0 / n) <= 0.15; }

/// The gentlest trial of the best one's input and end that the likelihood hardly speaks against.
const Trial& gentlest_of(const std::vector<Trial>& trials) {
  const Trial& best = best_of(trials);
  const Trial* gentlest = &best;
  for (const Trial& trial : trials)
    if (trial.input == best.input && (trial.ratio > 1.0) == (best.ratio > 1.0) &&
        trial.fit.objective > best.fit.objective - stretch_tie &&
        std::abs(std::log(trial.ratio)) < std::abs(std::log(gentlest->ratio)))
      gentlest = &trial;
  return *gentlest;
}

}  // namespace

double Stretch::place(double u) const {
  if (is_none()) return u;
  if (u < 0.0) return slope(0.0) * u;
  if (u > 1.0) return 1.0 + slope(1.0) * (u - 1.0);
  return std::log1p((ratio - 1.0) * u) / std::log(ratio);
}

double Stretch::origin(double v) const {
  if (is_none()) return v;
  if (v < 0.0) return v / slope(0.0);
  if (v > 1.0) return 1.0 + (v - 1.0) / slope(1.0);
  return std::expm1(v * std::log(ratio)) / (ratio - 1.0);
}

double Stretch::slope(double u) const {
  if (is_none()) return 1.0;
  return (ratio - 1.0) / ((1.0 + (ratio - 1.0) * std::clamp(u, 0.0, 1.0)) * std::log(ratio));
}

std::vector<Stretch> choose_stretches(const TrainingSet& training, const FitOptions& options,
                                      const std::vector<double>& own_ratios) {
  std::vector<Stretch> chosen_stretches(static_cast<std::size_t>(training.x.cols()));
  TrainingSet runs =
      training.y.size() > runs_looked_at ? chosen(training, thin(training, runs_looked_at, options.seed)) : training;
  FitOptions looking = quick(options);
  looking.between_runs = BetweenRuns::trusted;
  Best now = best_of(runs, looking);
  const auto tried = [&](Index input, double ratio) {
    TrainingSet other = runs;
    for (double& u : other.x.col(input)) u = Stretch{ratio}.place(u);
    looking.first_start = now.logs;
    return Trial{input, ratio, best_of(other, looking)};
  };
  while (now.logs.size() > 0) {
    // One more input, by the stretch of it that raises the likelihood most.
    std::vector<Trial> trials;
    const std::vector<int> active = standardise(runs, options.scale).active;
    for (std::size_t j = 0; j < active.size(); ++j) {
      const Index input = active[j];
      if (!chosen_stretches[input].is_none() || !(std::exp(now.logs[static_cast<Index>(j)]) < straight) ||
          !has_enough_values(runs.x.col(input)))
        continue;
      for (const double ratio : candidates_of(own_ratios[input])) trials.push_back(tried(input, ratio));
    }
    if (trials.empty()) break;
    Trial found = best_of(trials);
    if (!(found.fit.objective > now.objective + stretch_gain)) break;
    if (!is_resolved(found.ratio, static_cast<double>(runs.y.size()))) {
      trials.push_back(tried(found.input, found.ratio * (found.ratio > 1.0 ? 1.0 / half_decade : half_decade)));
      found = gentlest_of(trials);
    }
    chosen_stretches[found.input].ratio = found.ratio;
    for (double& u : runs.x.col(found.input)) u = chosen_stretches[found.input].place(u);
    now = found.fit;
  }
  return chosen_stretches;
}

}  // namespace surrogate
