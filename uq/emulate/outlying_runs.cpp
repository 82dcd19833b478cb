#include "uq/emulate/outlying_runs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "data/error.hpp"
#include "data/time_series.hpp"
#include "uq/emulate/scaled_runs.hpp"

namespace uq {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Errors over their predicted sd, of the runs kept and of those put aside, on the process's own scale. `sd` of those
/// put aside is that of the process alone: the error that a wrong run states is as wrong as the run.
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
      found.sd[aside[i]] = std::sqrt(spread + nugget * nugget) * mean;
    } else {
      found.sd[aside[i]] = std::sqrt(variance + nugget * nugget);
      found.standardised[aside[i]] = (y - mean) / std::sqrt(variance + nugget * nugget + noise);
    }
  }
  return found;
}

data::MedianSpread spread_of_kept(const VectorXd& standardised, const std::vector<int>& kept) {
  std::vector<double> values;
  for (const int i : kept) values.push_back(standardised[i]);
  return values.empty() ? data::MedianSpread{} : data::spread_of(values);
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

/// How suspicious the error of a run is, in robust standard deviations. `floor`: least spread that counts.
double standing_out(const Errors& errors, const data::MedianSpread& scale, int run, double floor) {
  return std::abs(errors.standardised[run] - scale.median) / std::max(scale.sd, floor);
}

/// A state of the search: what is kept and what is put aside, with the errors of all against the process of those kept.
struct Sorted {
  std::vector<int> kept, aside;
  Errors errors;
  data::MedianSpread scale;
  std::vector<bool> came_back;  ///< runs that were put aside and did not stand out then: they stay
};

/// Runs among those kept that stand out, the worst first, at most `at_once`.
std::vector<int> suspects_among(const Sorted& now, const OutlierOptions& options, std::size_t at_once) {
  // Without a floor: among runs that one outlier has made look harmless, it still stands out.
  const auto suspicion = [&](int i) { return standing_out(now.errors, now.scale, i, 1e-3); };
  std::vector<int> suspects;
  for (const int i : now.kept)
    if (!now.came_back[i] && suspicion(i) > options.screen) suspects.push_back(i);
  std::sort(suspects.begin(), suspects.end(), [&](int a, int b) { return suspicion(a) > suspicion(b); });
  // A run whose error is near the worst one's may only be pulled along by it.
  while (!suspects.empty() &&
         (suspects.size() > at_once || suspicion(suspects.back()) < 0.5 * suspicion(suspects.front())))
    suspects.pop_back();
  return suspects;
}

/// The root mean square of what is expected of the runs kept, beside what came.
double rms_error(const surrogate::TrainingSet& training, const std::vector<int>& kept, const VectorXd& expected) {
  double sum = 0.0;
  for (const int i : kept) sum += std::pow(training.y[i] - expected[i], 2);
  return std::sqrt(sum / static_cast<double>(kept.size()));
}

/// The runs put aside that are far off, the worst first.
OutlyingRuns far_off(const surrogate::TrainingSet& training, const Sorted& last, const OutlierOptions& options) {
  const VectorXd y = training.y(last.kept);
  const double spread = std::sqrt((y.array() - y.mean()).square().mean());
  const auto z = [&](int i) {
    return (last.errors.standardised[i] - last.scale.median) / std::max(last.scale.sd, 1.0);
  };
  std::vector<int> outlying;
  for (const int i : last.aside)
    if (std::abs(z(i)) > options.outlying && last.errors.sd[i] < options.spread * spread &&
        std::abs(training.y[i] - last.errors.expected[i]) > options.least * spread)
      outlying.push_back(i);
  std::sort(outlying.begin(), outlying.end(), [&](int a, int b) { return std::abs(z(a)) > std::abs(z(b)); });
  OutlyingRuns found;
  for (const int i : outlying) {
    found.runs.push_back(i);
    found.expected.push_back(last.errors.expected[i]);
    found.deviations.push_back(z(i));
  }
  return found;
}

}  // namespace

OutlyingRuns find_outlying(const surrogate::TrainingSet& training, const surrogate::GaussianProcess& process,
                           const surrogate::FitOptions& fit, const OutlierOptions& options) {
  const int n = static_cast<int>(training.y.size());
  if (n < 8) return {};
  const auto at_once = static_cast<std::size_t>(std::max(1, n / 12));
  const std::vector<int> scaled = scaled_runs(training);
  const double most = std::min(0.5 * n, options.share_max * n + static_cast<double>(scaled.size()));

  // All runs are kept at first.
  Sorted now{.kept = std::vector<int>(static_cast<std::size_t>(n)),
             .aside = {},
             .errors = {},
             .scale = {},
             .came_back = std::vector<bool>(static_cast<std::size_t>(n), false)};
  std::iota(now.kept.begin(), now.kept.end(), 0);
  now.errors = errors_of(training, now.kept, now.aside, process);
  now.scale = spread_of_kept(now.errors.standardised, now.kept);
  const VectorXd with_all = now.errors.expected;

  // Round by round the suspects are put aside, and those that the others then expect come back.
  for (int round = 0; round < options.rounds; ++round) {
    const std::vector<int> suspects = suspects_among(now, options, at_once);
    std::vector<int> next = suspects;
    if (round == 0)
      for (const std::vector<int>& together : {repeated_outputs(training), scaled})
        for (const int i : together)
          if (std::find(next.begin(), next.end(), i) == next.end()) next.push_back(i);
    if (static_cast<double>(next.size()) > most) next = suspects;  // coarse numbers, no failures
    for (const int i : now.aside) {
      if (standing_out(now.errors, now.scale, i, 1.0) > options.screen)
        next.push_back(i);
      else
        now.came_back[i] = true;
    }
    std::sort(next.begin(), next.end());
    if (next == now.aside) break;
    if (static_cast<double>(next.size()) > most) return {};  // no majority that the others could contradict
    now.aside = next;
    now.kept.clear();
    for (int i = 0; i < n; ++i)
      if (!std::binary_search(now.aside.begin(), now.aside.end(), i)) now.kept.push_back(i);
    const std::optional<surrogate::GaussianProcess> others = fitted_to(training, now.kept, fit);
    if (!others) return {};
    now.errors = errors_of(training, now.kept, now.aside, *others);
    now.scale = spread_of_kept(now.errors.standardised, now.kept);
  }

  // Runs that harm what is expected of the others, and are far off.
  const double harm =
      rms_error(training, now.kept, with_all) / std::max(rms_error(training, now.kept, now.errors.expected), 1e-300);
  OutlyingRuns found;
  if (!(harm < options.harm)) found = far_off(training, now, options);
  found.scatter = now.scale.sd;
  found.harm = harm;
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
