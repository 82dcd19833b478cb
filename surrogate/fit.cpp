#include "surrogate/fit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "data/error.hpp"
#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "surrogate/gaps.hpp"
#include "surrogate/marginal.hpp"
#include "surrogate/maximise.hpp"

namespace surrogate {
namespace {

using Eigen::Index;

/// Where the starts lie: an ordinary process of standardised data.
struct StartBox {
  Range length_scale{0.15, 4.0};     ///< unit cube
  Range signal_variance{0.3, 10.0};  ///< as a variance of z
  Range nugget_variance{1e-6, 0.1};  ///< as a variance of z
};

std::vector<Eigen::VectorXd> make_starts(int d, const FitOptions& options) {
  const int count = d + (options.nugget ? 2 : 1);
  const StartBox box;
  std::vector<Eigen::VectorXd> starts;
  ScaledParameters first;
  first.length_scales = Eigen::VectorXd::Constant(d, 0.5 * std::sqrt(static_cast<double>(std::max(d, 1))));
  first.signal_variance = 1.0;
  first.nugget_variance = 1e-3;
  starts.push_back(options.first_start.size() == count ? options.first_start : to_logs(first, options.nugget));
  if (options.starts <= 1) return starts;
  const Eigen::MatrixXd cube = scrambled_sobol(options.starts - 1, std::min(count, sobol_max_dimension), options.seed);
  for (Index i = 0; i < cube.rows(); ++i) {
    Eigen::VectorXd u(count);
    for (int j = 0; j < count; ++j) {
      const Range range = j < d ? box.length_scale : (j == d ? box.signal_variance : box.nugget_variance);
      const double t = cube(i, j % sobol_max_dimension);
      u[j] = std::log(range.low) + t * std::log(range.high / range.low);
    }
    starts.push_back(u);
  }
  return starts;
}

/// The runs of every point whose index is in `rows`.
Standardised subset(const Standardised& data, const std::vector<int>& rows) {
  Standardised result = data;
  result.points = data.points(rows, Eigen::all);
  std::vector<int> place(static_cast<std::size_t>(data.points.rows()), -1);
  for (std::size_t j = 0; j < rows.size(); ++j) place[rows[j]] = static_cast<int>(j);
  std::vector<int> runs;
  result.point_of_run.clear();
  result.runs_of_point.assign(rows.size(), 0);
  for (std::size_t i = 0; i < data.point_of_run.size(); ++i)
    if (const int j = place[data.point_of_run[i]]; j >= 0) {
      runs.push_back(static_cast<int>(i));
      result.point_of_run.push_back(j);
      ++result.runs_of_point[j];
    }
  result.z = data.z(runs);
  result.noise = data.noise(runs);
  return result;
}

std::vector<int> random_rows(int count, int total, std::uint64_t seed) {
  std::vector<int> rows(static_cast<std::size_t>(total));
  std::iota(rows.begin(), rows.end(), 0);
  data::RandomStream random(seed, data::Purpose::optimiser_starts);
  for (int i = 0; i < count; ++i) std::swap(rows[i], rows[i + static_cast<int>(random.uniform() * (total - i))]);
  rows.resize(static_cast<std::size_t>(count));
  std::sort(rows.begin(), rows.end());
  return rows;
}

bool better(const StartOutcome& a, const StartOutcome& b) {
  return std::pair(a.points, a.objective) < std::pair(b.points, b.objective);
}

void mark_agreeing(std::vector<StartOutcome>& outcomes) {
  const StartOutcome& best = *std::max_element(outcomes.begin(), outcomes.end(), better);
  const double objective = best.objective;
  for (StartOutcome& outcome : outcomes) outcome.agrees = outcome.objective > objective - 0.1;
}

/// Every start is followed to its end; where points are many, on a quarter of them (and so on), and the best two
/// distinct ends are followed on all points.
std::vector<StartOutcome> search(const Standardised& data, const std::vector<Eigen::VectorXd>& starts,
                                 const FitOptions& options) {
  constexpr int few = 256;       // up to this many points every start sees all of them
  constexpr double apart = 0.5;  // in logarithms: ends closer than this are the same
  const auto points = static_cast<int>(data.points.rows());
  std::vector<StartOutcome> outcomes;
  std::vector<std::size_t> followed;
  if (points > few) {
    outcomes = search(subset(data, random_rows(points / 4, points, options.seed)), starts, options);
    std::vector<std::size_t> order(outcomes.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return better(outcomes[b], outcomes[a]); });
    followed.push_back(order[0]);
    for (const std::size_t i : order)
      if (followed.size() < 2 && outcomes[i].points == outcomes[order[0]].points &&
          outcomes[i].objective > outcomes[order[0]].objective - 3.0 &&
          (outcomes[i].end - outcomes[order[0]].end).cwiseAbs().maxCoeff() > apart)
        followed.push_back(i);
  } else {
    outcomes.resize(starts.size());
    for (std::size_t i = 0; i < starts.size(); ++i) {
      outcomes[i].start = outcomes[i].end = starts[i];
      followed.push_back(i);
    }
  }
  Likelihood likelihood(data, options.kernel, options.mean, options.nugget);
  const Objective objective = make_objective(likelihood, options);
  for (const std::size_t i : followed) {
    StartOutcome outcome = maximise(objective, outcomes[i].end, options);
    outcome.start = outcomes[i].start;
    outcome.points = points;
    outcome.evaluations += outcomes[i].evaluations;
    outcome.agrees = outcomes[i].agrees;
    outcomes[i] = outcome;
  }
  if (points <= few) mark_agreeing(outcomes);
  return outcomes;
}

std::vector<BoundHit> find_bound_hits(const Objective& objective, const Eigen::VectorXd& u, const Standardised& data,
                                      const TrainingSet& training) {
  std::vector<BoundHit> hits;
  const auto d = static_cast<Index>(data.active.size());
  for (Index j = 0; j < u.size(); ++j) {
    const bool at_low = u[j]<objective.low[j] + 1e-3, at_high = u[j]> objective.high[j] - 1e-3;
    if (!at_low && !at_high) continue;
    BoundHit hit;
    hit.upper = at_high;
    hit.parameter = j < d ? "length scale of " + training.name_of(data.active[j]) : (j == d ? "signal" : "nugget");
    hit.value = std::exp((at_high ? objective.high[j] : objective.low[j]) * (j < d ? 1.0 : 0.5));
    hit.input = j < d ? static_cast<int>(j) : -1;
    hit.harmless = (j < d && at_high) || (j == d + 1 && at_low);
    hits.push_back(hit);
  }
  return hits;
}

}  // namespace

FitOptions quick(FitOptions options) {
  options.starts = std::min(options.starts, 2);
  options.hyper_uncertainty = HyperUncertainty::plug_in;
  options.first_start = {};
  return options;
}

GaussianProcess fit(const TrainingSet& training, const FitOptions& options) {
  Standardised data = standardise(training, options.scale, centre_of(options.mean));
  const int d = static_cast<int>(data.active.size()), p = flat_coefficients(options.mean, d);
  if (data.points.rows() <= p)
    throw data::InputError(data::ExitStatus::bad_data,
                           {"training set of the surrogate",
                            fmt::format("{} distinct points cannot fit a {} mean of {} coefficients",
                                        data.points.rows(), to_text(options.mean), p),
                            "add runs, or use a simpler mean"});
  Likelihood likelihood(data, options.kernel, options.mean, options.nugget);
  const Objective objective = make_objective(likelihood, options);

  FitDiagnostics diagnostics;
  const int points = static_cast<int>(data.points.rows());
  diagnostics.starts = points > options.hyper_points
                           ? search(subset(data, random_rows(options.hyper_points, points, options.seed)),
                                    make_starts(d, options), options)
                           : search(data, make_starts(d, options), options);
  const StartOutcome& best = *std::max_element(diagnostics.starts.begin(), diagnostics.starts.end(), better);
  diagnostics.converged = best.converged;
  diagnostics.agreeing_starts = static_cast<int>(
      std::count_if(diagnostics.starts.begin(), diagnostics.starts.end(), [](const auto& s) { return s.agrees; }));
  diagnostics.bound_hits = find_bound_hits(objective, best.end, data, training);

  const auto conditioned = [&](const Eigen::VectorXd& u) {
    Conditioned part;
    part.parameters = from_logs(u, options.nugget);
    part.factorised = likelihood.factorise(part.parameters);
    if (!part.factorised.ok)
      throw data::InputError(data::ExitStatus::bad_data,
                             {"surrogate", "the covariance of the training runs cannot be factorised even with jitter",
                              "give the runs their standard errors, or use a process with a nugget"});
    part.scaled_points = data.points * part.parameters.length_scales.cwiseInverse().asDiagonal();
    return part;
  };
  std::vector<HyperNode> nodes{{best.end, 1.0}};
  const bool few = data.points.rows() < enough_points * data.points.cols();
  if (options.hyper_uncertainty == HyperUncertainty::integrated ||
      (options.hyper_uncertainty == HyperUncertainty::integrated_if_few && few)) {
    constexpr int looked_at = 8;  // points at which the nodes' predictions are compared
    HyperPosterior posterior = hyper_posterior(objective, best.end);
    Standardised unscaled = data;
    unscaled.scale = OutputScale::linear;  // a logarithm's own predictions, whose moments are finite
    if (training.x.cols() <= sobol_max_dimension)
      posterior.predict = [&, seen = scrambled_sobol(looked_at, static_cast<int>(training.x.cols()), options.seed)](
                              const Eigen::VectorXd& u) {
        return GaussianProcess(options.kernel, options.mean, options.nugget, unscaled, {conditioned(u)}, {})
            .predict_marginal(seen);
      };
    nodes = integration_nodes(posterior, integration_options(data.points.rows(), options.seed));
  }
  std::vector<Conditioned> parts;
  for (const HyperNode& node : nodes) {
    Conditioned part = conditioned(node.u);
    part.weight = node.weight;
    diagnostics.jitter = std::max(diagnostics.jitter, part.factorised.jitter);
    parts.push_back(std::move(part));
  }
  if (options.between_runs == BetweenRuns::doubted) data.gaps = find_gaps(data);
  const bool unused = std::any_of(diagnostics.bound_hits.begin(), diagnostics.bound_hits.end(),
                                  [](const BoundHit& hit) { return hit.input >= 0 && hit.upper; });
  if (data.gaps.empty() && !unused)
    return {options.kernel, options.mean, options.nugget, std::move(data), std::move(parts), std::move(diagnostics)};

  // What an input does decides how far the function may leave the fit between its values, and what a length scale on
  // its bound means: nothing depends on the input, or all that does is a straight line.
  Standardised plain = data;
  plain.gaps.clear();
  const Eigen::VectorXd effects =
      input_effects({options.kernel, options.mean, options.nugget, std::move(plain), parts, {}});
  for (InputGap& gap : data.gaps) gap.sd *= gap_share * (effects[gap.input] + gap_floor);
  for (BoundHit& hit : diagnostics.bound_hits)
    if (hit.input >= 0) hit.effect = effects[hit.input];
  return {options.kernel, options.mean, options.nugget, std::move(data), std::move(parts), std::move(diagnostics)};
}

}  // namespace surrogate
