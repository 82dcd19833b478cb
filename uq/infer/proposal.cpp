#include "uq/infer/proposal.hpp"

#include <algorithm>
#include <cmath>

#include "uq/infer/factor.hpp"
#include "uq/infer/resample.hpp"

namespace uq {
namespace {

/// Keeps at most `count` points, by systematic resampling of their shares.
void thin(Adaptation& state, Eigen::Index count, data::RandomStream& random) {
  if (state.points.rows() <= count) return;
  std::vector<Eigen::Index> kept;
  std::vector<double> weight;
  for (const Eigen::Index i : resample(state.shares, count, random.uniform())) {
    if (kept.empty() || kept.back() != i) {
      kept.push_back(i);
      weight.push_back(0.0);
    }
    weight.back() += 1.0;
  }
  state.points = Eigen::MatrixXd(state.points(kept, Eigen::all));
  state.shares = Eigen::Map<const Eigen::VectorXd>(weight.data(), static_cast<Eigen::Index>(weight.size())) /
                 static_cast<double>(count);
}

/// Points of equal weight.
Adaptation of_points(const Eigen::MatrixXd& points) {
  Adaptation state;
  state.points = points;
  state.shares = Eigen::VectorXd::Constant(points.rows(), 1.0 / static_cast<double>(points.rows()));
  return state;
}

/// The weight of a point that the populations' moves made from another: it counts as half a draw.
constexpr double half = 0.5;

/// The weights of a point that was known already and of a weighted draw.
struct Counts {
  double point = 1.0, draw = 1.0;
};

/// Weighted draws join what is known, in proportion to how well they stand for the density; large weights are cut at
/// sqrt(n) times the mean (E. L. Ionides, J. Comput. Graph. Stat. 17 (2008) 295), so that one of them cannot make a
/// component of its own.
void gather(Adaptation& state, const Proposals& made, const Weights& weights, const Counts& counts,
            Eigen::Index points_max, data::RandomStream& random) {
  const double count = static_cast<double>(made.x.rows());
  const double cut = weights.values.mean() * std::sqrt(count);
  const Eigen::VectorXd cut_weights = weights.values.cwiseMin(cut);
  const double before = counts.point * static_cast<double>(state.points.rows()), trust = counts.draw * count;
  Eigen::MatrixXd all(state.points.rows() + made.x.rows(), made.x.cols());
  all << state.points, made.x;
  Eigen::VectorXd shares(all.rows());
  shares << state.shares * (before / (before + trust)), cut_weights * (trust / (before + trust) / cut_weights.sum());
  state.points = std::move(all);
  state.shares = std::move(shares);
  thin(state, points_max, random);
}

}  // namespace

Adaptation begin_proposal(const Eigen::MatrixXd& points, data::RandomStream& random, const ProposalOptions& options) {
  Adaptation state = of_points(points);
  state.current = state.best = fit_mixture(state.points, state.shares, random, options.mixture);
  return state;
}

Adaptation begin_proposal(const Eigen::MatrixXd& points, const Proposals& made, data::RandomStream& random,
                          const ProposalOptions& options) {
  Adaptation state = of_points(points);
  const Weights weights = importance_weights(made);
  if (weights.efficiency > 0.0)
    gather(state, made, weights, {.point = half, .draw = weights.efficiency}, options.points_max, random);
  state.current = state.best = fit_mixture(state.points, state.shares, random, options.mixture);
  return state;
}

void adapt(const Target& target, Adaptation& state, data::RandomStream& random, const ProposalOptions& options) {
  int misses = 0;
  for (int refit = 0;; ++refit) {
    const bool poor = state.efficiency < options.poor;
    const int count = options.refit_draws * (poor && refit > 3 ? 4 : 1);
    const Proposals made = propose(target, state.current, count, random);
    state.evaluations += count;
    const Weights weights = importance_weights(made);
    const bool better = weights.efficiency > state.efficiency;
    if (better) {
      state.best = state.current;
      state.efficiency = weights.efficiency;
      state.log_evidence = weights.log_evidence;
    }
    misses = better ? 0 : misses + 1;
    const bool hard = state.efficiency < options.poor && misses < 4;
    if (state.efficiency > 0.85 || (refit > 1 && !better && !hard) || weights.efficiency == 0.0) break;
    if (refit >= (hard ? options.hard_refits_max : options.refits_max)) break;
    // Points gathered before give way slowly to a refit's few draws. Points of the mixture's first fit give way faster:
    // each counts half.
    gather(state, made, weights, {.point = refit == 0 ? half : 1.0, .draw = std::max(weights.efficiency, 0.05)},
           options.points_max, random);
    state.current =
        with_kept(fit_mixture(state.points, state.shares, random, options.mixture, &state.current), state.kept);
  }
}

void add_modes(Adaptation& state, const std::vector<Peak>& modes, double share) {
  std::vector<MixtureComponent> added;
  for (const Peak& mode : modes)
    added.push_back({.weight = share / static_cast<double>(modes.size()),
                     .mean = mode.x,
                     .factor = factor_for_proposal(mode.covariance)});
  state.current = with_components(state.best, added);
  // Nothing is known of how good it is.
  state.best = state.current;
  state.efficiency = 0.0;
  // The modes stay with twice their mass, so that p / q is bounded there whatever the fits do.
  for (std::size_t i = 0; i < modes.size(); ++i) {
    added[i].weight = std::clamp(2.0 * std::exp(modes[i].log_mass - state.log_evidence), 0.002, 0.1);
    state.kept.push_back(added[i]);
  }
}

}  // namespace uq
