#include "uq/posterior/prior_reach.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/random.hpp"
#include "uq/findings/study_units.hpp"
#include "uq/infer/optimise.hpp"
#include "uq/posterior/posterior.hpp"

namespace uq {
namespace {

constexpr double out_of_reach = 5.0;  // sd from the nearest prediction
constexpr int prior_draws = 400, range_draws = 1000;

/// Points all over the priors: rows in u.
Eigen::MatrixXd points_of_priors(const CaseModel& model, data::RandomStream& random) {
  Eigen::MatrixXd points(prior_draws, model.dimension());
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    for (Eigen::Index s = 0; s < points.cols(); ++s) points(i, s) = model.unknowns[s].prior.draw(random);
  return points;
}

/// Points with the parameters anywhere in their ranges; a nuisance has no range but its prior's.
Eigen::MatrixXd points_of_ranges(const CaseModel& model, data::RandomStream& random) {
  Eigen::MatrixXd points(range_draws, model.dimension());
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    for (Eigen::Index s = 0; s < points.cols(); ++s) {
      const Unknown& unknown = model.unknowns[s];
      points(i, s) = unknown.nuisance ? unknown.prior.draw(random) : random.uniform();
    }
  return points;
}

/// The reach of the predictions at some points, per measured number.
struct Reach {
  Eigen::VectorXd nearest;          ///< distance of the nearest prediction, in its sds
  Eigen::VectorXd lowest, highest;  ///< SI
  /// A value between the lowest and the highest prediction is within reach, however few points came near it.
  bool misses(const Eigen::VectorXd& y, Eigen::Index i) const {
    return nearest[i] > out_of_reach && (y[i] < lowest[i] || y[i] > highest[i]);
  }
};
Reach reach_of(const CaseModel& model, const Eigen::MatrixXd& points, const Eigen::VectorXd& y) {
  Reach found{.nearest = Eigen::VectorXd::Constant(y.size(), 1e300),
              .lowest = Eigen::VectorXd::Constant(y.size(), 1e300),
              .highest = Eigen::VectorXd::Constant(y.size(), -1e300)};
  for_each_law(model, points, [&](Eigen::Index i, const std::vector<GroupLaw>& laws) {
    const RowMoments prediction = moments(model, laws, points.row(i).transpose());
    const Eigen::VectorXd away = (y - prediction.mean).cwiseQuotient(prediction.variance.cwiseSqrt());
    found.nearest = found.nearest.cwiseMin(away.cwiseAbs());
    found.lowest = found.lowest.cwiseMin(prediction.mean);
    found.highest = found.highest.cwiseMax(prediction.mean);
  });
  return found;
}

/// How far each measured number lies from the prediction of the most likely point that the priors allow, in sd: where
/// draws of the priors all miss a number, the priors may still allow it. Allowed is the central 99.99 % of each prior.
Eigen::VectorXd least_deviations(const CaseModel& model, const Eigen::MatrixXd& draws, const Eigen::VectorXd& y) {
  constexpr Eigen::Index starts = 3;
  constexpr double tail = 5e-5;
  Eigen::VectorXd low(model.dimension()), high(model.dimension());
  for (Eigen::Index s = 0; s < low.size(); ++s) {
    low[s] = model.unknowns[s].prior.inverse_cdf(tail);
    high[s] = model.unknowns[s].prior.inverse_cdf(1.0 - tail);
  }
  const Eigen::VectorXd level = log_likelihoods(model, draws);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(draws.rows()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return level[a] > level[b]; });
  order.resize(std::min<std::size_t>(order.size(), starts));
  Eigen::MatrixXd from = draws(order, Eigen::all);
  for (Eigen::Index i = 0; i < from.rows(); ++i)
    from.row(i) = from.row(i).cwiseMax(low.transpose()).cwiseMin(high.transpose());
  const Maximum best =
      maximise([&](const Eigen::VectorXd& u) { return log_likelihood_gradient(model, u); }, {low, high}, from);
  const StackedPrediction prediction = predict(model, best.x);
  return (y - prediction.mean).cwiseQuotient(prediction.total().diagonal().cwiseSqrt()).cwiseAbs();
}

data::Problem excluded(const data::Study& study, const CaseModel& model, const RowOrigin& origin, double value,
                       std::pair<double, double> allowed) {
  const data::ObservationSet& set = study.observations[origin.set];
  const data::Unit& unit = study.outputs[origin.output].unit;
  std::string names;
  for (const Unknown& unknown : model.unknowns) names += (names.empty() ? "" : ", ") + unknown.label;
  return {fmt::format("{}:{}", data::shown_path(set.file), set.points[origin.point].line),
          fmt::format("case '{}': the priors of {} only allow {:.4g} to {:.4g}{}, but {:.4g}{} was measured; the "
                      "parameters' ranges would allow it",
                      model.name, names, unit.from_si(allowed.first), unit.from_si(allowed.second),
                      data::behind_number(unit.symbol), unit.from_si(value), data::behind_number(unit.symbol)),
          "widen or move the priors"};
}

}  // namespace

void refuse_excluding_priors(const data::Study& study, const CaseModel& model) {
  const Eigen::VectorXd y = observed(model);
  data::RandomStream random(study.seed, data::Purpose::prior_predictive);
  const Eigen::MatrixXd likely = points_of_priors(model, random);
  const Reach priors = reach_of(model, likely, y);
  std::vector<Eigen::Index> missed;
  for (Eigen::Index i = 0; i < y.size(); ++i)
    if (priors.misses(y, i)) missed.push_back(i);
  if (missed.empty()) return;
  const Eigen::VectorXd least = least_deviations(model, likely, y);
  std::erase_if(missed, [&](Eigen::Index i) { return least[i] <= out_of_reach; });
  if (missed.empty()) return;

  const Reach ranges = reach_of(model, points_of_ranges(model, random), y);
  const std::vector<RowOrigin> from = origins(model);
  std::vector<data::Problem> problems;
  for (const Eigen::Index i : missed)
    if (!ranges.misses(y, i))
      problems.push_back(excluded(study, model, from[i], y[i], {priors.lowest[i], priors.highest[i]}));
  if (!problems.empty()) throw data::InputError(data::ExitStatus::bad_study, problems);
}

}  // namespace uq
