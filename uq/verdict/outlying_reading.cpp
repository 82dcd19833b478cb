#include "uq/verdict/outlying_reading.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>

#include "uq/infer/factor.hpp"
#include "uq/posterior/fisher.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/interval_drop.hpp"
#include "uq/verdict/profile.hpp"

namespace uq {
namespace {

/// How far each reading lies from what the others say, and the sd of that.
struct LeftOut {
  Eigen::VectorXd distance, sd;
};

LeftOut left_out(const CaseModel& model, const Eigen::VectorXd& u) {
  const StackedPrediction prediction = predict(model, u);
  Eigen::MatrixXd covariance = prediction.total();
  add_free_unknowns(model, u, covariance);
  const Eigen::Index rows = covariance.rows();
  const Factor root = factor(covariance, "the data about the best fit");
  const Eigen::MatrixXd inverse = root.llt.solve(Eigen::MatrixXd::Identity(rows, rows));
  const Eigen::VectorXd residual = observed(model) - prediction.mean;
  return {(inverse * residual).cwiseQuotient(inverse.diagonal()), inverse.diagonal().cwiseSqrt().cwiseInverse()};
}

/// The best fit, the errors' size sought from a small one, too.
Eigen::VectorXd fit_again(const CaseModel& model, const Eigen::VectorXd& best) {
  Eigen::MatrixXd starts = best.transpose().replicate(2, 1);
  for (std::size_t s = 0; s < model.unknowns.size(); ++s)
    if (model.unknowns[s].only_widens())
      starts(1, static_cast<Eigen::Index>(s)) = model.unknowns[s].prior.inverse_cdf(0.2);
  return maximum_likelihood(model, starts).x;
}

double own_sd(const CaseModel& model, const Eigen::VectorXd& u, Eigen::Index row) {
  const StackedPrediction prediction = predict(model, u);
  return std::sqrt(prediction.covariance(row, row) + prediction.noise[row]);
}

}  // namespace

std::optional<OutlyingReading> outlying_reading(const CaseModel& model, const Eigen::VectorXd& best,
                                                const VerdictThresholds& thresholds) {
  if (!errors_unknown(model)) return {};
  const LeftOut all = left_out(model, best);
  Eigen::Index farthest = 0;
  all.distance.cwiseQuotient(all.sd).cwiseAbs().maxCoeff(&farthest);

  // The others alone: in the place of the reading stands what they say of it, until that no longer moves.
  constexpr int rounds_most = 8;
  constexpr double still = 0.01;  // sd
  const double read = observed(model)[farthest];
  CaseModel others = model;
  Eigen::VectorXd at = best;
  LeftOut found = all;
  for (int round = 0; round < rounds_most; ++round) {
    Eigen::VectorXd y = observed(others);
    y[farthest] -= found.distance[farthest];
    others = with_data(model, y, observed_variance(model));
    at = fit_again(others, at);
    found = left_out(others, at);
    if (std::abs(found.distance[farthest]) < still * found.sd[farthest]) break;
  }
  const double count = model.row_count(), dof = count - 1.0 - fisher_spectrum(others, at).known_directions;
  if (dof < 2.0) return {};
  const double t = std::abs(read - observed(others)[farthest]) / found.sd[farthest] * std::sqrt(dof / count);
  const double chance = std::min(1.0, count * 2.0 * gsl_cdf_tdist_Q(t, dof));
  if (chance >= thresholds.outlying_chance) return {};
  return OutlyingReading{.origin = origins(model)[farthest],
                         .errors = t,
                         .chance = chance,
                         .widening = own_sd(model, best, farthest) / own_sd(model, at, farthest)};
}

}  // namespace uq
