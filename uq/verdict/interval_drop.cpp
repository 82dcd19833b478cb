#include "uq/verdict/interval_drop.hpp"

#include <algorithm>
#include <cmath>

#include "uq/findings/thresholds.hpp"
#include "uq/infer/factor.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/predictive.hpp"

namespace uq {
namespace {

/// The best fit with the spreads of each draw; the best fit itself is the last row.
Eigen::MatrixXd with_spreads_of(const CaseModel& model, const Eigen::VectorXd& best, const Eigen::MatrixXd& draws) {
  const int count = std::clamp(60'000 / std::max(model.row_count(), 1), 40, 1000);  // many rows make each one dear
  const Eigen::MatrixXd used = thinned(draws, count);
  Eigen::MatrixXd points = best.transpose().replicate(used.rows() + 1, 1);
  for (std::size_t s = 0; s < model.unknowns.size(); ++s)
    if (model.unknowns[s].only_widens()) points.col(s).head(used.rows()) = used.col(s);
  return points;
}

/// The precision by which each unknown is known beside the data. An unknown of which nothing is known gets a weak
/// spring, so that a direction that the data leave open stays finite.
Eigen::VectorXd precisions(const CaseModel& model) {
  constexpr double weak = 1e-4;
  Eigen::VectorXd found(model.dimension());
  for (std::size_t s = 0; s < model.unknowns.size(); ++s) {
    const Unknown& unknown = model.unknowns[s];
    const double of_prior = std::pow(unknown.prior.sd(), -2);
    const bool known = unknown.nuisance && !unknown.only_widens();
    found[s] = unknown.cut ? std::pow(unknown.cut->sd, -2) : (known ? 1.0 : weak) * of_prior;
  }
  return found;
}

/// Variance of each unknown at each of `points`, points x unknowns.
Eigen::MatrixXd variances(const CaseModel& model, const Eigen::VectorXd& best, const Eigen::MatrixXd& points) {
  Eigen::MatrixXd slopes = sensitivity(model, best);
  for (std::size_t s = 0; s < model.unknowns.size(); ++s)
    if (model.unknowns[s].only_widens()) slopes.col(s).setZero();
  const Eigen::VectorXd known = precisions(model);
  Eigen::MatrixXd found(points.rows(), model.dimension());
  for_each_law(model, points, [&](Eigen::Index point, const std::vector<GroupLaw>& laws) {
    const StackedPrediction prediction = stack(model, laws, points.row(point).transpose());
    Eigen::MatrixXd whitened = slopes;
    factor(prediction.total(), "the data at the best fit").llt.matrixL().solveInPlace(whitened);
    Eigen::MatrixXd information = whitened.transpose() * whitened;
    information.diagonal() += known;
    const auto size = information.rows();
    found.row(point) =
        factor(information, "what the data say").llt.solve(Eigen::MatrixXd::Identity(size, size)).diagonal();
  });
  return found;
}

/// The half-width that 5 % of the mixture of normal laws of these sds lie outside of.
double half_width(const Eigen::ArrayXd& sds) {
  const double normal = std::sqrt(deviance_95);  // of one normal law, in sds
  double low = normal * sds.minCoeff(), high = normal * sds.maxCoeff();
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    double outside = 0.0;
    for (const double sd : sds) outside += std::erfc(middle / (std::sqrt(2.0) * sd));
    (outside > 0.05 * static_cast<double>(sds.size()) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

bool errors_unknown(const CaseModel& model) {
  return std::any_of(model.unknowns.begin(), model.unknowns.end(),
                     [](const Unknown& unknown) { return unknown.only_widens(); });
}

Eigen::VectorXd interval_drops(const CaseModel& full, const Eigen::VectorXd& best, const Eigen::MatrixXd& draws,
                               double drop) {
  const CaseModel& model = distinct_rows(full);
  Eigen::VectorXd drops = Eigen::VectorXd::Constant(model.dimension(), drop);
  if (!errors_unknown(model) || draws.rows() == 0) return drops;

  const Eigen::MatrixXd points = with_spreads_of(model, best, draws);
  Eigen::ArrayXd level = log_likelihoods(model, points).array();
  for (Eigen::Index i = 0; i < points.rows(); ++i) level[i] += log_certificates(model, points.row(i).transpose()).value;
  const Eigen::ArrayXXd variance = variances(model, best, points).array();
  for (Eigen::Index k = 0; k < drops.size(); ++k) {
    const double q = half_width(variance.col(k).head(points.rows() - 1).sqrt());
    const double there = (level - 0.5 * q * q / variance.col(k)).maxCoeff();
    drops[k] = std::max(drop, 2.0 * (level.maxCoeff() - there));
  }
  return drops;
}

}  // namespace uq
