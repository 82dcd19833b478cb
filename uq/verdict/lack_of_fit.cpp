#include "uq/verdict/lack_of_fit.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <map>

#include "uq/infer/factor.hpp"
#include "uq/posterior/distinct.hpp"
#include "uq/posterior/fisher.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/interval_drop.hpp"

namespace uq {
namespace {

constexpr int least_degrees = 2;

/// The scatter of repeats by the noise unknown that they tell of.
std::map<int, Repeats> repeats_by_noise(const CaseModel& model) {
  std::map<int, Repeats> found;
  for (const RowGroup& group : model.groups)
    for (const Repeats& repeats : group.repeats) {
      if (repeats.noise < 0) continue;
      found[repeats.noise].extra += repeats.extra;
      found[repeats.noise].scatter += repeats.scatter;
    }
  std::erase_if(found, [](const auto& one) { return one.second.extra < least_degrees || !(one.second.scatter > 0.0); });
  return found;
}

}  // namespace

std::optional<LackOfFit> lack_of_fit(const CaseModel& model, const Eigen::VectorXd& best) {
  if (!errors_unknown(model) || !model.distinct) return {};
  const CaseModel& means = *model.distinct;
  const std::map<int, Repeats> repeats = repeats_by_noise(means);
  if (repeats.empty()) return {};
  StackedPrediction prediction = predict(means, best);
  Eigen::Index row = 0;
  for (const RowGroup& group : means.groups) {
    for (const ReadSet& set : group.measurement.sets) {
      const auto told = repeats.find(set.noise);
      if (told == repeats.end()) continue;
      prediction.noise.segment(row + set.first, set.count) =
          told->second.scatter / told->second.extra * group.variance.segment(set.first, set.count);
    }
    row += group.observed.size();
  }
  Eigen::MatrixXd covariance = prediction.total();
  add_free_unknowns(means, best, covariance);
  const int settings = means.row_count(), degrees = settings - fisher_spectrum(means, best).known_directions;
  if (degrees < least_degrees) return {};
  int scatter_degrees = repeats.begin()->second.extra;
  for (const auto& [noise, one] : repeats) scatter_degrees = std::min(scatter_degrees, one.extra);
  const Eigen::VectorXd residual = observed(means) - prediction.mean;
  const double f = factor(covariance, "the settings' means").llt.matrixL().solve(residual).squaredNorm() / degrees;
  return LackOfFit{
      .f = f, .p = gsl_cdf_fdist_Q(f, degrees, scatter_degrees), .settings = settings, .readings = number_count(means)};
}

}  // namespace uq
