#include "uq/posterior/surrogate_share.hpp"

#include <algorithm>
#include <cmath>

#include "uq/posterior/posterior.hpp"
#include "uq/posterior/predictive.hpp"

namespace uq {

bool SurrogateShare::tells(std::size_t k) const {
  constexpr double far = 1.0;  // sds by which the posterior would move: then too few draws tell how narrow it would be
  return effective_draws >= least_effective && moved[k] <= far;
}

SurrogateShare surrogate_share(const CaseModel& model, const Eigen::MatrixXd& draws,
                               const Eigen::VectorXd& log_likelihood) {
  SurrogateShare found;
  for (const Unknown& unknown : model.unknowns)
    if (unknown.own) found.shares.push_back(1.0);
  found.left.assign(found.shares.size(), 0.0);
  found.moved.assign(found.shares.size(), 0.0);
  if (!found.shares.empty()) found.parameter = model.unknowns.front().label;
  if (draws.rows() < 2) return found;
  const Eigen::VectorXd log_weight = log_likelihoods(without_surrogate_error(model), draws) - log_likelihood;
  if (!std::isfinite(log_weight.maxCoeff())) return found;
  Eigen::VectorXd weight = (log_weight.array() - log_weight.maxCoeff()).exp();
  weight = weight.unaryExpr([](double w) { return std::isfinite(w) ? w : 0.0; });
  weight /= weight.sum();
  found.effective_draws = 1.0 / weight.squaredNorm();
  if (found.effective_draws < least_effective) return found;
  found.share = -1.0;
  std::size_t own = 0;
  for (Eigen::Index k = 0; k < draws.cols(); ++k) {
    if (!model.unknowns[k].own) continue;
    const Eigen::ArrayXd u = draws.col(k).array();
    const double with = u.mean(), without = (weight.array() * u).sum();
    const double variance = std::max((u - with).square().mean(), 1e-300);
    const double left = (weight.array() * (u - without).square()).sum();
    const double moved = std::abs(without - with) / std::sqrt(variance);
    const double share = std::clamp(std::max(1.0 - left / variance, moved * moved), 0.0, 1.0);
    found.left[own] = left / variance;
    found.moved[own] = moved;
    found.shares[own++] = share;
    if (share > found.share) {
      found.share = share;
      found.parameter = model.unknowns[k].label;
    }
  }
  return found;
}

SurrogateShare surrogate_share(const CaseModel& model, const Eigen::MatrixXd& draws) {
  constexpr Eigen::Index most = 1000;
  const Eigen::MatrixXd some = thinned(draws, most);
  return surrogate_share(model, some, log_likelihoods(model, some));
}

}  // namespace uq
