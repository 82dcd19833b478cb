#include "uq/verdict/contradiction.hpp"

#include <fmt/core.h>
#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <set>

#include "uq/findings/listed.hpp"
#include "uq/posterior/fisher.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/profile.hpp"

namespace uq {
namespace {

constexpr double variance_of_others = 1e8;  // times the stated one
constexpr int starts_over_prior = 30;

bool replaces_errors(const CaseModel& model) {
  return std::any_of(model.groups.begin(), model.groups.end(), [](const RowGroup& group) {
    const auto& sets = group.measurement.sets;
    return std::any_of(sets.begin(), sets.end(), [](const ReadSet& set) { return set.noise_is_sd; });
  });
}

/// The best fit to all, and draws from the prior: what fits one set may lie far from what fits all.
Eigen::MatrixXd starting_points(const data::Study& study, const CaseModel& model, const Eigen::VectorXd& first) {
  data::RandomStream random(study.seed, data::Purpose::contradiction);
  Eigen::MatrixXd starts(1 + starts_over_prior, model.dimension());
  starts.row(0) = first.transpose();
  for (Eigen::Index i = 1; i < starts.rows(); ++i)
    for (Eigen::Index k = 0; k < starts.cols(); ++k) starts(i, k) = model.unknowns[k].prior.draw(random);
  return starts;
}

}  // namespace

std::vector<SetFit> fits_alone(const data::Study& study, const CaseModel& model, const Eigen::VectorXd& start) {
  const std::vector<RowOrigin> from = origins(model);
  std::set<std::size_t> sets;
  for (const RowOrigin& origin : from) sets.insert(origin.set);
  if (sets.size() < 2 || replaces_errors(model)) return {};
  const Eigen::VectorXd y = observed(model), stated = observed_variance(model);
  const Eigen::MatrixXd starts = starting_points(study, model, start);
  std::vector<SetFit> found;
  for (const std::size_t set : sets) {
    Eigen::VectorXd variance = stated;
    int rows = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (from[i].set == set)
        ++rows;
      else
        variance[i] *= variance_of_others;
    }
    const CaseModel alone = with_data(model, y, variance);
    const Maximum best = maximum_likelihood(alone, starts);
    const int dof = std::max(1, rows - fisher_spectrum(alone, best.x).known_directions);
    found.push_back(
        {.name = study.observations[set].name, .best_fit_p = gsl_cdf_chisq_Q(chi_squared(alone, best.x), dof)});
  }
  return found;
}

std::optional<LoneReading> lone_reading(const data::Study& study, const CaseModel& model, const Eigen::VectorXd& start,
                                        const VerdictThresholds& thresholds) {
  constexpr std::size_t rows_most = 60;
  const std::vector<RowOrigin> from = origins(model);
  if (from.size() > rows_most || replaces_errors(model)) return {};
  const Eigen::VectorXd y = observed(model), stated = observed_variance(model);
  const Eigen::MatrixXd starts = starting_points(study, model, start);
  std::optional<LoneReading> found;
  for (std::size_t i = 0; i < from.size(); ++i) {
    Eigen::VectorXd variance = stated;
    variance[i] *= variance_of_others;
    const CaseModel others = with_data(model, y, variance);
    const Maximum best = maximum_likelihood(others, starts);
    const int dof = static_cast<int>(from.size()) - 1 - fisher_spectrum(others, best.x).known_directions;
    if (dof < 2) return {};
    const double p = gsl_cdf_chisq_Q(chi_squared(others, best.x), dof);
    if (p < thresholds.best_fit_p) continue;
    if (found) return {};
    found = LoneReading{from[i], p};
  }
  if (found && found->p_without < thresholds.poor_fit_p) found.reset();
  return found;
}

Contradiction describe_contradiction(const std::vector<SetFit>& sets, double least_p) {
  std::vector<std::string> fit, unfit;
  for (const SetFit& set : sets) (set.best_fit_p >= least_p ? fit : unfit).push_back(set.name);
  if (sets.empty() || fit.empty()) return {};
  if (unfit.empty())
    return {.finding = fmt::format("On its own each of {} fits: they contradict each other.", listed(fit)),
            .remedy =
                "Check that these are the same powder, rig and units; if they are, free what differs between "
                "them (a gain or an offset of each meter), or calibrate them as cases that share nothing."};
  return {.finding = fmt::format("On its own {} {}; {} {} not.", listed(fit), fit.size() == 1 ? "fits" : "fit",
                                 listed(unfit), unfit.size() == 1 ? "does" : "do"),
          .remedy = fmt::format("Look at {} first.", listed(unfit))};
}

}  // namespace uq
