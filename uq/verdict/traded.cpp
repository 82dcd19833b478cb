#include "uq/verdict/traded.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "uq/findings/listed.hpp"
#include "uq/findings/study_units.hpp"
#include "uq/findings/wording.hpp"
#include "uq/posterior/predictive.hpp"
#include "uq/verdict/combination.hpp"

namespace uq {
namespace {

using Subset = std::vector<int>;

constexpr int largest_subset = 5;
constexpr Eigen::Index largest_curved = 3;  // in more dimensions too few draws tell how full a room is
constexpr Eigen::Index draws_looked_at = 1500;
/// A cloud this much tighter than its best form hangs on a curve.
constexpr double tighter = 0.5;
/// For two strongly correlated normal variables: the share of the room that they fill, over the spread of their sum.
const double straight_fill = std::sqrt(2.0);

/// Value of own parameter k at u, in the study's unit.
double shown(const CaseModel& model, int k, double u) { return in_study_unit(model.unknowns[k].prior.parameter(), u); }

double range_of(const CaseModel& model, int k) {
  const data::Parameter& parameter = model.unknowns[k].prior.parameter();
  return std::abs(parameter.unit.from_si(parameter.high) - parameter.unit.from_si(parameter.low));
}

double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::ArrayXd x = a.array() - a.mean(), y = b.array() - b.mean();
  return (x * y).sum() / std::sqrt(x.square().sum() * y.square().sum());
}

/// The larger of the plain correlation and that of the logarithms.
double strongest_correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const double plain = correlation(a, b);
  if (!(a.minCoeff() > 0.0 && b.minCoeff() > 0.0)) return plain;
  const double of_logs = correlation(a.array().log(), b.array().log());
  return std::abs(of_logs) > std::abs(plain) ? of_logs : plain;
}

Eigen::MatrixXd columns_of(const Eigen::MatrixXd& values, const Subset& subset) {
  Eigen::MatrixXd chosen(values.rows(), static_cast<Eigen::Index>(subset.size()));
  for (std::size_t i = 0; i < subset.size(); ++i) chosen.col(i) = values.col(subset[i]);
  return chosen;
}

/// All subsets of a size, in the order of their members.
std::vector<Subset> subsets_of(const std::vector<int>& pool, std::size_t size) {
  std::vector<Subset> all;
  Subset current;
  const auto extend = [&](auto&& self, std::size_t from) -> void {
    if (current.size() == size) {
      all.push_back(current);
      return;
    }
    for (std::size_t i = from; i < pool.size(); ++i) {
      current.push_back(pool[i]);
      self(self, i + 1);
      current.pop_back();
    }
  };
  extend(extend, 0);
  return all;
}

/// A subset with the best form of it.
struct Found {
  Subset subset;
  FittedCombination combination;
};

/// The form, where one holds, or that the relation is curved, or none.
FittedCombination look_at(const Eigen::MatrixXd& values, const Eigen::VectorXd& ranges,
                          const VerdictThresholds& thresholds) {
  FittedCombination best = fit_combination(values, ranges);
  const bool holds = best.share <= thresholds.combination_share;
  const double filled = values.cols() <= largest_curved ? filled_share(values) : 1.0;
  const bool tight = filled <= thresholds.curve_share;
  if (tight && filled < tighter * straight_fill * best.spread)
    best.form = CombinationForm::curved;
  else if (!holds)
    best.form = CombinationForm::none;
  if (best.form == CombinationForm::curved) best.share = filled;
  return best;
}

/// Equivalent points: five along the member whose interval spans more, nearly as good as the best.
void add_equivalent_points(TradedPair& pair, const CaseModel& model, const Subset& subset,
                           const std::vector<Profile>& profiles) {
  constexpr double near_best = 1.0;
  const auto span = [&](const Profile& profile) {
    double low = 2.0, high = -1.0;
    for (Eigen::Index i = 0; i < profile.u.size(); ++i)
      if (profile.deviance[i] <= near_best) {
        low = std::min(low, profile.u[i]);
        high = std::max(high, profile.u[i]);
      }
    return std::pair{low, high};
  };
  const Profile* along = nullptr;
  double widest = -1.0;
  for (const int k : subset) {
    const Profile& profile = profiles[k];
    const auto [low, high] = span(profile);
    if (high - low > widest) {
      widest = high - low;
      along = &profile;
    }
  }
  const std::pair<double, double> ends = span(*along);
  const double low = ends.first, high = ends.second;
  std::vector<Eigen::Index> chosen;
  for (int step = 0; step < 5; ++step) {
    const double wanted = low + (high - low) * step / 4.0;
    Eigen::Index nearest = 0;
    double distance = 2.0;
    for (Eigen::Index i = 0; i < along->u.size(); ++i)
      if (along->deviance[i] <= near_best && std::abs(along->u[i] - wanted) < distance) {
        distance = std::abs(along->u[i] - wanted);
        nearest = i;
      }
    // Where the ridge is broken, several wanted values have the same neighbour.
    const bool taken = std::any_of(chosen.begin(), chosen.end(), [&](Eigen::Index other) {
      return std::abs(along->u[other] - along->u[nearest]) < 0.1 * (high - low);
    });
    if (!taken) chosen.push_back(nearest);
  }
  for (const Eigen::Index i : chosen) {
    std::map<std::string, double> point;
    for (int k = 0; k < model.own_count(); ++k) point[model.unknowns[k].label] = shown(model, k, along->path(i, k));
    pair.equivalent.push_back(std::move(point));
    const Eigen::VectorXd u = along->path.row(i).transpose();
    pair.equivalent_u.emplace_back(u.begin(), u.end());
  }
}

TradedPair describe(const CaseModel& model, const Found& found, const Eigen::MatrixXd& values,
                    const std::vector<Profile>& profiles) {
  TradedPair pair;
  std::vector<CombinationColumn> columns;
  for (const int k : found.subset) {
    const data::Parameter& parameter = model.unknowns[k].prior.parameter();
    pair.parameters.push_back(model.unknowns[k].label);
    columns.push_back({pair.parameters.back(), parameter.unit.symbol, values.col(k).cwiseAbs().mean()});
  }
  // The two members that are most strongly related.
  std::pair<std::size_t, std::size_t> most{0, 1};
  for (std::size_t a = 0; a < found.subset.size(); ++a)
    for (std::size_t b = a + 1; b < found.subset.size(); ++b) {
      const double r = strongest_correlation(values.col(found.subset[a]), values.col(found.subset[b]));
      if (std::abs(r) <= std::abs(pair.correlation)) continue;
      pair.correlation = r;
      most = {a, b};
    }
  pair.first = pair.parameters[most.first];
  pair.second = pair.parameters[most.second];
  pair.form = found.combination.form;
  if (pair.form == CombinationForm::curved) {
    pair.combination = pair.statement = "a curved relation of " + listed(pair.parameters);
  } else {
    const CombinationText written = write_combination(found.combination, columns);
    Eigen::VectorXd value(values.rows());
    const Eigen::MatrixXd members = columns_of(values, found.subset);
    for (Eigen::Index i = 0; i < values.rows(); ++i)
      value[i] = written.scale * evaluate(written.written, members.row(i).transpose());
    pair.combination = written.text;
    pair.unit = written.unit;
    pair.value = value.mean();
    pair.error = std::sqrt((value.array() - pair.value).square().sum() / static_cast<double>(value.size() - 1));
    pair.statement = written.text + " = " + format_with_error(pair.value, pair.error, written.unit, Typography::ascii);
  }
  add_equivalent_points(pair, model, found.subset, profiles);
  return pair;
}

}  // namespace

std::vector<TradedPair> find_traded_pairs(const CaseModel& model, const Eigen::MatrixXd& draws, const Profiles& all,
                                          const std::vector<Verdict>& verdicts, const VerdictThresholds& thresholds) {
  const int own = model.own_count();
  const Eigen::MatrixXd looked_at = thinned(draws, draws_looked_at);
  Eigen::MatrixXd values(looked_at.rows(), own);
  std::vector<int> pool;
  for (int k = 0; k < own; ++k) {
    for (Eigen::Index i = 0; i < values.rows(); ++i) values(i, k) = shown(model, k, looked_at(i, k));
    const bool apart = verdicts[k] == Verdict::several_values;
    if (all.influence[k].some && !apart) pool.push_back(k);
  }
  const auto open = [&](int k) { return verdicts[k] != Verdict::identified; };

  std::vector<Found> kept;
  std::vector<int> tied(static_cast<std::size_t>(own));  // parameters that the pairs found so far tie together
  std::iota(tied.begin(), tied.end(), 0);
  for (std::size_t size = 2; size <= std::min<std::size_t>(pool.size(), largest_subset); ++size) {
    std::vector<Found> candidates;
    for (const Subset& subset : subsets_of(pool, size)) {
      if (std::none_of(subset.begin(), subset.end(), open)) continue;
      const bool known = std::any_of(kept.begin(), kept.end(), [&](const Found& other) {
        return std::includes(subset.begin(), subset.end(), other.subset.begin(), other.subset.end());
      });
      if (known) continue;
      Eigen::VectorXd ranges(static_cast<Eigen::Index>(size));
      for (std::size_t i = 0; i < size; ++i) ranges[i] = range_of(model, subset[i]);
      FittedCombination found = look_at(columns_of(values, subset), ranges, thresholds);
      if (found.form == CombinationForm::none) continue;
      candidates.push_back({subset, std::move(found)});
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Found& a, const Found& b) { return a.combination.share < b.combination.share; });
    for (Found& candidate : candidates) {
      if (size == 2) {
        const int a = tied[candidate.subset[0]];
        const int b = tied[candidate.subset[1]];
        if (a == b) continue;
        for (int& root : tied) root = root == b ? a : root;
      }
      kept.push_back(std::move(candidate));
    }
  }
  std::vector<TradedPair> pairs;
  for (const Found& found : kept) pairs.push_back(describe(model, found, values, all.profiles));
  return pairs;
}

}  // namespace uq
