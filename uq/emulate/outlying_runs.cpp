#include "uq/emulate/outlying_runs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "data/error.hpp"
#include "data/time_series.hpp"

namespace uq {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Errors over their predicted sd, of the runs kept and of those put aside, on the process's own scale.
struct Errors {
  VectorXd standardised, sd, expected;
};

Errors errors_of(const surrogate::TrainingSet& training, const std::vector<int>& kept, const std::vector<int>& aside,
                 const surrogate::GaussianProcess& process) {
  const Index n = training.y.size();
  Errors found{VectorXd::Zero(n), VectorXd::Zero(n), VectorXd::Zero(n)};
  const surrogate::LeaveOneOut left = process.leave_one_out();
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const auto at = static_cast<Index>(i);
    found.standardised[kept[i]] = left.standardised[at];
    found.sd[kept[i]] = std::sqrt(left.variance[at]);
    found.expected[kept[i]] = left.mean[at];
  }
  if (aside.empty()) return found;
  const surrogate::MarginalPrediction predicted = process.predict_marginal(training.x(aside, Eigen::all));
  const double nugget = process.hyper_parameters().nugget_sd;
  const bool logarithmic = process.data().scale == surrogate::OutputScale::log;
  for (std::size_t i = 0; i < aside.size(); ++i) {
    const auto at = static_cast<Index>(i);
    const double y = training.y[aside[i]], mean = predicted.mean[at], variance = predicted.variance[at];
    const double noise = training.noise_variance.size() > 0 ? training.noise_variance[aside[i]] : 0.0;
    found.expected[aside[i]] = mean;
    if (logarithmic) {
      const double spread = std::log1p(variance / (mean * mean));
      const double sd = std::sqrt(spread + nugget * nugget + noise / (y * y));
      found.standardised[aside[i]] = (std::log(y) - std::log(mean) + 0.5 * spread) / sd;
      found.sd[aside[i]] = sd * mean;
    } else {
      found.sd[aside[i]] = std::sqrt(variance + nugget * nugget + noise);
      found.standardised[aside[i]] = (y - mean) / found.sd[aside[i]];
    }
  }
  return found;
}

struct RobustScale {
  double centre = 0.0, spread = 1.0;
};

RobustScale robust_scale(const VectorXd& standardised, const std::vector<int>& kept) {
  std::vector<double> values;
  for (const int i : kept) values.push_back(standardised[i]);
  if (values.empty()) return {0.0, 0.0};
  const double centre = data::median_of(values);
  for (double& value : values) value = std::abs(value - centre);
  return {centre, 1.4826 * data::median_of(values)};
}

/// Runs at different points whose output is one and the same number, three or more of them: what a program writes that
/// has none. Sorted.
std::vector<int> repeated_outputs(const surrogate::TrainingSet& training) {
  std::map<double, std::vector<int>> runs_of;
  for (int i = 0; i < training.y.size(); ++i) runs_of[training.y[i]].push_back(i);
  std::vector<int> repeated;
  for (const auto& [unused, runs] : runs_of) {
    const bool elsewhere = std::any_of(runs.begin(), runs.end(), [&, first = runs.front()](int i) {
      return training.x.row(i) != training.x.row(first);
    });
    if (runs.size() >= 3 && elsewhere) repeated.insert(repeated.end(), runs.begin(), runs.end());
  }
  std::sort(repeated.begin(), repeated.end());
  return repeated;
}

/// A process of the runs kept, if there can be one.
std::optional<surrogate::GaussianProcess> fitted_to(const surrogate::TrainingSet& training,
                                                    const std::vector<int>& kept, const surrogate::FitOptions& fit) {
  const VectorXd noise = training.noise_variance.size() > 0 ? VectorXd(training.noise_variance(kept)) : VectorXd();
  try {
    return surrogate::fit({training.x(kept, Eigen::all), training.y(kept), noise}, quick(fit));
  } catch (const data::InputError&) {
    return {};
  }
}

}  // namespace

OutlyingRuns find_outlying(const surrogate::TrainingSet& training, const surrogate::GaussianProcess& process,
                           const surrogate::FitOptions& fit, const OutlierOptions& options) {
  OutlyingRuns found;
  const int n = static_cast<int>(training.y.size());
  if (n < 8) return found;
  std::vector<int> kept(static_cast<std::size_t>(n)), aside;
  std::iota(kept.begin(), kept.end(), 0);
  std::vector<bool> came_back(static_cast<std::size_t>(n), false);
  const auto at_once = static_cast<std::size_t>(std::max(1, n / 12));
  const double most = options.share_max * n;
  std::optional<surrogate::GaussianProcess> current = process;
  Errors errors = errors_of(training, kept, aside, *current);
  RobustScale scale = robust_scale(errors.standardised, kept);
  const VectorXd with_all = errors.expected;
  for (int round = 0; round < options.rounds; ++round) {
    // Without a floor: among runs that one outlier has made look harmless, it still stands out.
    const auto suspicion = [&](int i) {
      return std::abs(errors.standardised[i] - scale.centre) / std::max(scale.spread, 1e-3);
    };
    const auto contradiction = [&](int i) {
      return std::abs(errors.standardised[i] - scale.centre) / std::max(scale.spread, 1.0);
    };
    std::vector<int> suspects;
    for (const int i : kept)
      if (!came_back[i] && suspicion(i) > options.screen) suspects.push_back(i);
    std::sort(suspects.begin(), suspects.end(), [&](int a, int b) { return suspicion(a) > suspicion(b); });
    // A run whose error is near the worst one's may only be pulled along by it.
    while (!suspects.empty() &&
           (suspects.size() > at_once || suspicion(suspects.back()) < 0.5 * suspicion(suspects.front())))
      suspects.pop_back();
    std::vector<int> next = suspects;
    if (round == 0)
      for (const int i : repeated_outputs(training))
        if (std::find(next.begin(), next.end(), i) == next.end()) next.push_back(i);
    if (static_cast<double>(next.size()) > most) next = suspects;  // coarse numbers, no failures
    for (const int i : aside) {
      if (contradiction(i) > options.screen)
        next.push_back(i);
      else
        came_back[i] = true;
    }
    std::sort(next.begin(), next.end());
    if (next == aside) break;
    if (static_cast<double>(next.size()) > most) return {};  // no majority that the others could contradict
    aside = next;
    kept.clear();
    for (int i = 0; i < n; ++i)
      if (!std::binary_search(aside.begin(), aside.end(), i)) kept.push_back(i);
    current = fitted_to(training, kept, fit);
    if (!current) return {};
    errors = errors_of(training, kept, aside, *current);
    scale = robust_scale(errors.standardised, kept);
  }
  found.scatter = scale.spread;
  const auto rms = [&](const VectorXd& expected) {
    double sum = 0.0;
    for (const int i : kept) sum += std::pow(training.y[i] - expected[i], 2);
    return std::sqrt(sum / static_cast<double>(kept.size()));
  };
  found.harm = rms(with_all) / std::max(rms(errors.expected), 1e-300);
  if (found.harm < options.harm) return found;
  const VectorXd y = training.y(kept);
  const double spread = std::sqrt((y.array() - y.mean()).square().mean());
  const auto z = [&](int i) { return (errors.standardised[i] - scale.centre) / std::max(scale.spread, 1.0); };
  std::vector<int> outlying;
  for (const int i : aside)
    if (std::abs(z(i)) > options.outlying && errors.sd[i] < options.spread * spread &&
        std::abs(training.y[i] - errors.expected[i]) > options.least * spread)
      outlying.push_back(i);
  std::sort(outlying.begin(), outlying.end(), [&](int a, int b) { return std::abs(z(a)) > std::abs(z(b)); });
  for (const int i : outlying) {
    found.runs.push_back(i);
    found.expected.push_back(errors.expected[i]);
    found.deviations.push_back(z(i));
  }
  return found;
}

std::optional<OneEnd> at_one_end(const Eigen::MatrixXd& x, const std::vector<int>& runs) {
  const auto n = static_cast<double>(x.rows()), m = static_cast<double>(runs.size());
  if (runs.size() < one_end_least || !(m < n)) return {};
  std::optional<OneEnd> found;
  for (Index k = 0; k < x.cols(); ++k) {
    std::map<double, double> count;
    for (Index i = 0; i < x.rows(); ++i) count[x(i, k)] += 1.0;
    std::map<double, double> rank;
    double below = 0.0, ties = 0.0;
    for (const auto& [value, times] : count) {
      rank[value] = below + 0.5 * (times + 1.0);
      below += times;
      ties += times * times * times - times;
    }
    double sum = 0.0;
    std::vector<double> ranks;
    for (const int i : runs) ranks.push_back(rank.at(x(i, k)));
    for (const double one : ranks) sum += one;
    const double variance = m * (n - m) / 12.0 * (n + 1.0 - ties / (n * (n - 1.0)));
    if (!(variance > 0.0)) continue;
    const double z = (sum - 0.5 * m * (n + 1.0)) / std::sqrt(variance);
    const double p = std::min(1.0, std::erfc(std::abs(z) / std::sqrt(2.0)) * static_cast<double>(x.cols()));
    const double middle = z < 0.0 ? data::median_of(ranks) : n + 1.0 - data::median_of(ranks);
    if (p <= one_end_p && middle <= 0.25 * (n + 1.0) && (!found || p < found->p))
      found = OneEnd{.input = static_cast<int>(k), .low = z < 0.0, .p = p};
  }
  return found;
}

}  // namespace uq
