#include "uq/plan/plan_batches.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "uq/infer/parallel.hpp"

namespace uq::plan {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int search_draws = 600;  // for the search of batches

std::vector<Index> rows_of(const PlanBasis& basis, const std::vector<std::size_t>& members) {
  std::vector<Index> rows;
  for (const std::size_t i : members)
    rows.insert(rows.end(), basis.extended.planned[i].begin(), basis.extended.planned[i].end());
  return rows;
}
double cost_of(const PlanBasis& basis, const std::vector<std::size_t>& members) {
  double sum = 0.0;
  for (const std::size_t i : members) sum += basis.candidates[i].cost;
  return sum;
}
/// Whether the budget pays for these members, with `left` kept for members that are still to be chosen.
bool affordable(const PlanBasis& basis, const std::vector<std::size_t>& members, double left) {
  return !basis.options.budget || cost_of(basis, members) + left <= *basis.options.budget * (1.0 + 1e-9);
}

/// What a batch is worth to the question, by some of the draws.
double quick_worth(const PlanBasis& basis, const std::vector<std::size_t>& members) {
  Ensemble all = basis.outlooks.front().ensemble(rows_of(basis, members));
  const Index n = std::min<Index>(search_draws, all.draws());
  const MatrixXd column = all.values.col(basis.about).head(n);
  const MatrixXd mean = all.mean.topRows(n);
  all.values = column;
  all.mean = mean;
  all.covariance.resize(static_cast<std::size_t>(n));
  const double sd_now = std::sqrt((column.array() - column.mean()).square().mean());
  const InformationAbout about = information(all, {.seed = basis.options.seed, .noise = {}}).about.front();
  return basis.worth(about.information.value, sd_now, about.sd_after.value);
}

/// What one set is preferred to another by: the worth of its readings where a budget bounds them, else the worth per
/// cost.
double merit(const PlanBasis& basis, const std::vector<std::size_t>& members, double worth) {
  return basis.options.budget ? worth : worth / cost_of(basis, members);
}

/// The member at `position` that is best beside the others; none where no other is affordable.
std::optional<std::size_t> best_at(const PlanBasis& basis, std::vector<std::size_t> members, std::size_t position,
                                   double left = 0.0) {
  std::vector<double> value(basis.candidates.size(), -1.0);
  for_each_index(static_cast<int>(basis.candidates.size()), basis.options.threads, [&](int i) {
    std::vector<std::size_t> tried = members;
    tried[position] = static_cast<std::size_t>(i);
    if (!basis.candidates[tried[position]].doubtful() && affordable(basis, tried, left))
      value[i] = merit(basis, tried, quick_worth(basis, tried));
  });
  const auto best = std::max_element(value.begin(), value.end());
  if (*best < 0.0) return {};
  return static_cast<std::size_t>(best - value.begin());
}

/// Adds the best member beside those that are there, until there are `size`; each leaves what the cheapest of the rest
/// cost. Nothing: the budget does not reach so far.
std::optional<std::vector<std::size_t>> greedily(const PlanBasis& basis, std::vector<std::size_t> members, int size) {
  double cheapest = HUGE_VAL;
  for (const Candidate& one : basis.candidates)
    if (!one.doubtful()) cheapest = std::min(cheapest, one.cost);
  while (std::ssize(members) < size) {
    const auto more = static_cast<double>(size - 1 - std::ssize(members));
    members.push_back(0);
    const std::optional<std::size_t> next =
        best_at(basis, members, members.size() - 1, more > 0.0 ? more * cheapest : 0.0);
    if (!next) return {};
    members.back() = *next;
  }
  return members;
}

}  // namespace

std::vector<PlanBatch> batches_of(const PlanBasis& basis) {
  std::vector<PlanBatch> batches;
  std::vector<std::size_t> greedy;
  for (int size = 2; size <= basis.options.batch; ++size) {
    // A budget may not reach beyond the members of a smaller batch, so that each size is begun anew.
    const auto chosen = greedily(basis, basis.options.budget ? std::vector<std::size_t>() : greedy, size);
    if (!chosen) return batches;
    greedy = *chosen;
    std::vector<std::size_t> members = greedy;
    for (int sweep = 0; sweep < 2; ++sweep) {
      bool changed = false;
      for (std::size_t position = 0; position < members.size(); ++position) {
        const std::optional<std::size_t> better = best_at(basis, members, position);
        if (!better || *better == members[position]) continue;
        members[position] = *better;
        changed = true;
      }
      if (!changed) break;
    }
    const auto about = static_cast<std::size_t>(basis.about);
    const Information picked = basis.information_of(rows_of(basis, greedy)),
                      exchanged = basis.information_of(rows_of(basis, members));
    if (merit(basis, members, exchanged.about[about].information.value) <
        merit(basis, greedy, picked.about[about].information.value))
      members = greedy;
    const Information& kept = members == greedy ? picked : exchanged;
    PlanBatch batch{.candidates = {},
                    .information = kept.about[about].information.value,
                    .information_error = kept.about[about].information.error,
                    .greedy = picked.about[about].information.value,
                    .sd_after = kept.about[about].sd_after.value,
                    .cost = cost_of(basis, members)};
    std::sort(members.begin(), members.end());
    for (const std::size_t i : members) batch.candidates.push_back(basis.candidates[i].name);
    batches.push_back(std::move(batch));
  }
  return batches;
}

}  // namespace uq::plan
