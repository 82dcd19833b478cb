#include "uq/posterior/prior_conflict.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>

namespace uq {
namespace {

constexpr double told_least = 0.05;  // contraction: below, 1 - v is mostly the draws' own scatter

double normal_score(const ScaledPrior& prior, double u) {
  constexpr double tail = 1e-300;
  const double below = prior.cdf(u);
  return gsl_cdf_ugaussian_Pinv(std::clamp(below, tail, 1.0 - 1e-16));
}

}  // namespace

std::vector<PriorConflict> prior_conflicts(const CaseModel& model, const Eigen::MatrixXd& draws, double most) {
  std::vector<PriorConflict> found;
  for (int k = 0; k < model.dimension(); ++k) {
    const Unknown& unknown = model.unknowns[k];
    if (!unknown.cut_from.empty() || !unknown.prior.is_informative()) continue;
    const Eigen::ArrayXd score =
        draws.col(k).unaryExpr([&](double u) { return normal_score(unknown.prior, u); }).array();
    const double told = 1.0 - (score - score.mean()).square().mean();
    const double z = score.mean() / (told > told_least ? std::sqrt(told) : 1.0);
    if (std::abs(z) > most) found.push_back({k, z});
  }
  return found;
}

}  // namespace uq
