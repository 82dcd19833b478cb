#include "uq/posterior/prior_conflict.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "uq/posterior/curvature.hpp"
#include "uq/posterior/posterior.hpp"

namespace uq {
namespace {

constexpr double told_by_draws = 0.2;  // contraction: below, 1 - v of the draws is much of it their own scatter
constexpr double told_least = 0.05;    // below, nearly all of it
constexpr double told_at_all = 1e-3;   // below, the data say nothing that slope and curvature could show safely

double normal_score(const ScaledPrior& prior, double u) {
  constexpr double tail = 1e-300;
  const double below = prior.cdf(u);
  return gsl_cdf_ugaussian_Pinv(std::clamp(below, tail, 1.0 - 1e-16));
}

/// A conflict, and the contraction 1 - v that the data make of the prior's score.
struct Conflict {
  double z = 0.0, told = 0.0;
};

/// z by the slope and the curvature of the likelihood at u: with J what the data tell of the prior's normal score
/// beside all other unknowns, they want s* = s + slope / J there, and z = s* sqrt(J / (J + 1)). Nothing where they tell
/// nothing.
Conflict conflict_at(const CaseModel& model, const Eigen::VectorXd& u, Eigen::Index k) {
  const std::optional<Eigen::MatrixXd> all = curvature(model, u, KnownBeside::all);
  if (!all) return {};
  const ScaledPrior& prior = model.unknowns[static_cast<std::size_t>(k)].prior;
  std::vector<Eigen::Index> others;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    if (i != k) others.push_back(i);
  const Eigen::VectorXd column = (*all)(others, k);
  double information = (*all)(k, k) - std::pow(prior.sd(), -2);
  if (!others.empty()) information -= column.dot(Eigen::MatrixXd((*all)(others, others)).llt().solve(column));
  const double step = 1e-2 * prior.sd();
  const double rise = (normal_score(prior, u[k] + step) - normal_score(prior, u[k] - step)) / (2.0 * step);
  const double of_score = information / (rise * rise);
  if (!(rise > 0.0) || !(of_score > 1e-12)) return {};
  const double slope = log_likelihood_gradient(model, u).gradient[k] / rise;
  const double told = of_score / (of_score + 1.0);
  return {(normal_score(prior, u[k]) + slope / of_score) * std::sqrt(told), told};
}

/// Whether the draws' mean score is the one that a conflict leads to. On a curved ridge it is not: there slope and
/// curvature at the posterior's mean, which lies beside the ridge, say nothing of the posterior.
bool explains(const Conflict& conflict, double mean_score) {
  constexpr double scatter = 0.08, share = 0.3;
  return conflict.told > told_at_all &&
         std::abs(conflict.z * std::sqrt(conflict.told) - mean_score) < scatter + share * std::abs(mean_score);
}

}  // namespace

std::vector<PriorConflict> prior_conflicts(const CaseModel& model, const Eigen::MatrixXd& draws, double most) {
  std::vector<PriorConflict> found;
  const Eigen::VectorXd centre = draws.colwise().mean();
  for (int k = 0; k < model.dimension(); ++k) {
    const Unknown& unknown = model.unknowns[k];
    if (!unknown.cut_from.empty() || !unknown.prior.is_informative()) continue;
    const Eigen::ArrayXd score =
        draws.col(k).unaryExpr([&](double u) { return normal_score(unknown.prior, u); }).array();
    const double told = 1.0 - (score - score.mean()).square().mean();
    double z = score.mean() / (told > told_least ? std::sqrt(told) : 1.0);
    if (told < told_by_draws)
      if (const Conflict at_centre = conflict_at(model, centre, k); explains(at_centre, score.mean())) z = at_centre.z;
    if (std::abs(z) > most) found.push_back({k, z});
  }
  return found;
}

}  // namespace uq
