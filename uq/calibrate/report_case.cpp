// The report of a case, made from its draws: verdicts, convergence, bands, warnings.
#include <fmt/format.h>
#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>

#include "uq/calibrate/calibrate.hpp"
#include "uq/calibrate/case_warnings.hpp"
#include "uq/calibrate/case_words.hpp"
#include "uq/calibrate/doubt.hpp"
#include "uq/calibrate/misfit.hpp"
#include "uq/findings/study_units.hpp"
#include "uq/infer/diagnostics.hpp"
#include "uq/infer/quadrature.hpp"
#include "uq/posterior/discrepancy.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/support.hpp"
#include "uq/verdict/interval_drop.hpp"
#include "uq/verdict/lack_of_fit.hpp"
#include "uq/verdict/outlying_reading.hpp"

namespace uq {
namespace {

/// Convergence of each parameter, and the Monte Carlo error of its mean in the study's unit.
void add_diagnostics(CaseReport& report, const SampledCase& sampled) {
  for (std::size_t k = 0; k < report.parameters.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    ParameterReport& parameter = report.parameters[k];
    parameter.rhat = sampled.draws.rhat[column];
    parameter.ess_bulk = sampled.draws.ess_bulk[column];
    parameter.ess_tail = sampled.draws.ess_tail[column];
    const data::Parameter& source = sampled.model->unknowns[k].prior.parameter();
    Eigen::MatrixXd values = sampled.draws.coordinate(static_cast<int>(k));
    for (double& value : values.reshaped()) value = in_study_unit(source, value);
    parameter.mcse = mean_mcse(values);
  }
}

void add_nuisances(CaseReport& report, const SampledCase& sampled) {
  for (int k = 0; k < sampled.model->dimension(); ++k)
    if (sampled.model->unknowns[k].nuisance) report.nuisances.push_back(summary_of(sampled, k));
}

/// Separate regions of the posterior, in the study's units. Where the sampler has missed one, it has not converged.
void add_modes(CaseReport& report, const CaseModel& model, const Identification& found) {
  if (found.modes.size() > 1)
    for (const Mode& mode : found.modes) {
      ModeReport made{.weight = mode.weight, .mean = {}, .sd = {}};
      for (int k = 0; k < model.own_count(); ++k) {
        const Unknown& unknown = model.unknowns[k];
        const data::Unit& unit = unknown.prior.parameter().unit;
        made.mean[unknown.label] = in_study_unit(unknown.prior.parameter(), mode.mean[k]);
        made.sd[unknown.label] = mode.sd[k] * std::abs(unknown.slope(mode.mean[k])) / unit.factor;
      }
      report.modes.push_back(std::move(made));
    }
  for (const std::string& place : found.unvisited) {
    report.converged = false;
    report.warnings.push_back(
        fmt::format("case {}: the chains have not converged: {} fits the data as well, and no draw lies there",
                    report.name, place));
  }
}

/// Draws of the case's own parameters in the study's units, and their correlation.
void add_draws(CaseReport& report, const CaseModel& model, const Eigen::MatrixXd& draws) {
  const Eigen::Index own = model.own_count();
  Eigen::MatrixXd values = draws.leftCols(own);
  for (Eigen::Index k = 0; k < own; ++k) {
    const data::Parameter& parameter = model.unknowns[k].prior.parameter();
    for (Eigen::Index i = 0; i < values.rows(); ++i) values(i, k) = in_study_unit(parameter, values(i, k));
  }
  const Eigen::MatrixXd centred = values.rowwise() - values.colwise().mean();
  const Eigen::VectorXd length = centred.colwise().norm();
  report.correlation.assign(static_cast<std::size_t>(own), std::vector<double>(static_cast<std::size_t>(own), 1.0));
  for (Eigen::Index a = 0; a < own; ++a)
    for (Eigen::Index b = 0; b < own; ++b)
      if (a != b) report.correlation[a][b] = centred.col(a).dot(centred.col(b)) / (length[a] * length[b]);
  const Eigen::MatrixXd plotted = thinned(values, 1500);
  for (Eigen::Index i = 0; i < plotted.rows(); ++i) {
    std::vector<double> row;
    for (Eigen::Index k = 0; k < own; ++k) row.push_back(plotted(i, k));
    report.draws_for_plot.push_back(std::move(row));
  }
}

/// Largest difference of mean and sd between draws and quadrature, in posterior sd.
double difference(const Eigen::MatrixXd& draws, const Quadrature& exact) {
  double largest = 0.0;
  for (Eigen::Index k = 0; k < draws.cols(); ++k) {
    const double mean = draws.col(k).mean();
    const double sd = std::sqrt((draws.col(k).array() - mean).square().mean());
    largest =
        std::max({largest, std::abs(mean - exact.mean[k]) / exact.sd[k], std::abs(sd - exact.sd[k]) / exact.sd[k]});
  }
  return largest;
}

void add_quadrature(CaseReport& report, const SampledCase& sampled, const Eigen::MatrixXd& draws,
                    const CalibrateOptions& options) {
  const Quadrature exact = integrate(
      posterior_target(sampled.model),
      {.tolerance = 1e-4, .evaluations_max = 60000, .threads = options.threads, .guides = thinned(draws, 1000)});
  if (!exact.resolved) return;
  report.grid_difference = difference(draws, exact);
  if (!agree(sampled.draws, exact))
    report.warnings.push_back(fmt::format("case {}: sampler and grid quadrature differ by {:.2g} posterior sd",
                                          report.name, *report.grid_difference));
}

/// The second look in words: what it saw, and how small a place it would have missed. n draws miss a share v with (1 -
/// v)^n.
std::string search_in_words(const Draws& draws) {
  if (draws.scouts == 0) return "";
  const std::string found = draws.found_modes == 0 ? "no maximum that the draws do not know"
                            : draws.found_modes == 1
                                ? "one maximum, which the draws then took in"
                                : fmt::format("{} maxima, which the draws then took in", draws.found_modes);
  return fmt::format(
      "{} draws of the prior, and lines through the best fit along every axis and diagonal, gave {} starts uphill: "
      "{}. A basin that holds less than {:.2g} % of the prior and lies on none of these lines could have escaped.",
      draws.scouts, draws.searched_starts, found, 100.0 * (1.0 - std::pow(0.05, 1.0 / draws.scouts)));
}

/// The report as far as it is known before the case's draws are looked at.
CaseReport begun(const data::Study& study, const SampledCase& sampled) {
  const CaseModel& model = *sampled.model;
  CaseReport report;
  report.name = model.name;
  report.linked = model.linked;
  report.observed_sets = model.observed_sets;
  for (const auto& name : model.observed_sets)
    report.observed_notes.push_back(
        fmt::format("{}", fmt::join(study.observations[study.observation_index(name).value()].header, "\n")));
  report.converged = sampled.draws.converged;
  report.chains = static_cast<int>(sampled.draws.chains.size());
  report.divergences = sampled.draws.divergences;
  report.sampler = sampled.draws.sampler;
  report.search = search_in_words(sampled.draws);
  for (const auto& chain : sampled.draws.chains)
    if (chain.energy.size() > 0) {
      const double fraction = energy_fraction(chain.energy);
      if (!(report.energy_fraction <= fraction)) report.energy_fraction = fraction;
    }
  for (const auto& unknown : model.unknowns)
    if (!unknown.cut_from.empty()) report.cuts.push_back(unknown.label + " from " + unknown.cut_from);
  report.log_evidence = sampled.draws.log_evidence;
  report.log_evidence_error = sampled.draws.log_evidence_error;
  if (!sampled.draws.chains.empty()) report.draws = static_cast<int>(sampled.draws.chains.front().x.rows());
  report.support = sampled.support;
  report.unusable = !doubt_of(model).empty();
  return report;
}

/// Nothing was drawn: no verdict, and the reason in the first lines.
CaseReport without_draws(CaseReport report, const std::string& reason) {
  report.fits = false;
  report.warnings.push_back(fmt::format("case {}: sampling failed: {}", report.name, reason));
  report.finding = "The posterior could not be sampled: " + reason + ".";
  report.consequence = "There is no result for this case.";
  report.remedy = "Check the priors and the measurement errors.";
  return report;
}

/// Verdicts, fit and traded parameters.
void add_identification(CaseReport& report, const data::Study& study, const CaseModel& model,
                        const Identification& found) {
  report.surrogate_to_measurement = found.surrogate_to_measurement;
  report.chi2 = found.check.chi2;
  report.dof = found.check.dof;
  report.ppp = found.check.predictive_p;
  report.fits = found.fits;
  report.parameters = found.parameters;
  report.fisher_condition = found.fisher.condition;
  report.collinearity = found.fisher.collinearity;
  report.traded = found.traded;
  for (TradedPair& pair : report.traded)
    for (const std::vector<double>& u : pair.equivalent_u)
      for (PredictiveCurve& curve :
           mean_curves(study, model, Eigen::Map<const Eigen::VectorXd>(u.data(), static_cast<Eigen::Index>(u.size()))))
        pair.curves.push_back(std::move(curve));
}

/// Whether readings of stated errors lie closer to the best fit than the errors let expect.
bool too_close(const CaseModel& model, const FitCheck& check, const VerdictThresholds& thresholds) {
  constexpr int least = 3;  // degrees of freedom
  return !errors_unknown(model) && check.dof >= least && gsl_cdf_chisq_P(check.chi2, check.dof) < thresholds.best_fit_p;
}

/// What is to be said of errors and scatter where the model fits: one reading that widens unknown errors, repeats that
/// say less than their number, readings farther from the best fit than usual, or closer to it. Returns warnings.
std::vector<std::string> say_fit(Words& words, const CaseReport& report, const data::Study& study,
                                 const CaseModel& model, const Identification& found,
                                 const VerdictThresholds& thresholds) {
  if (const auto outlying = outlying_reading(model, found.best_fit.x, thresholds)) {
    say_outlying_reading(words, study, *outlying);
    return {outlying_warning(report.name, study, *outlying)};
  }
  if (!report.doubt.empty()) return {};
  if (found.check.best_fit_p < thresholds.poor_fit_p) say_poor_fit(words, found.check);
  if (too_close(model, found.check, thresholds)) say_close_fit(words, found.check);
  const std::optional<LackOfFit> lack = lack_of_fit(model, found.best_fit.x);
  if (!lack || !(lack->p < thresholds.best_fit_p)) return {};
  say_lack_of_fit(words, *lack);
  return {lack_of_fit_warning(report.name, *lack)};
}

/// What the posterior predicts: at the readings, over the controls, and of a discrepancy.
void add_bands(CaseReport& report, const data::Study& study, const CaseModel& model, const Eigen::MatrixXd& draws,
               std::uint64_t study_seed) {
  // A model made by hand may be of no case of the study.
  const std::size_t index = study.case_index(model.name).value_or(study.cases.size());
  const std::uint64_t seed =
      data::child_seed(study_seed, data::Purpose::report_seed, static_cast<std::uint32_t>(index));
  report.predictive = predictive_points(study, model, draws, seed);
  report.curves = predictive_curves(study, model, draws, seed);
  report.discrepancies = discrepancy_bands(study, model, draws, seed);
}

}  // namespace

NuisanceReport summary_of(const SampledCase& sampled, int k) {
  const Unknown& unknown = sampled.model->unknowns[k];
  const data::Unit& unit = unknown.prior.parameter().unit;
  Eigen::VectorXd values = sampled.draws.coordinate(k).reshaped();
  for (double& value : values) value = in_study_unit(unknown.prior.parameter(), value);
  const double mean = values.mean();
  return {.name = unknown.label,
          .unit = unit.symbol,
          .prior_mean = unit.from_si(unknown.prior.value_mean()),
          .prior_sd = unknown.prior.value_sd() / unit.factor,
          .mean = mean,
          .sd = std::sqrt((values.array() - mean).square().sum() / static_cast<double>(values.size() - 1)),
          .q05 = quantile(values, 0.05),
          .q50 = quantile(values, 0.50),
          .q95 = quantile(values, 0.95),
          .rhat = sampled.draws.rhat[k],
          .ess_bulk = sampled.draws.ess_bulk[k],
          .ess_tail = sampled.draws.ess_tail[k]};
}

CaseReport report_case(const data::Study& study, const SampledCase& sampled, const CalibrateOptions& options) {
  const CaseModel& model = *sampled.model;
  CaseReport report = begun(study, sampled);
  if (sampled.draws.chains.empty()) return without_draws(std::move(report), sampled.draws.reason);

  const Eigen::MatrixXd draws = sampled.draws.pooled();
  const std::vector<JudgedSource> sources = judge_sources(sampled, options.identify);
  const Doubt doubt = doubt_about(sampled, sources, options.identify);
  IdentifyOptions judged = options.identify;
  judged.unsupported = doubt.unsupported;
  if (!judged.unsupported.empty()) report.doubt = judged.unsupported.front();
  Identification found = identify(model, draws, judged);
  take_cut_verdicts(found, sampled, sources);
  add_identification(report, study, model, found);
  // Where a prior holds the posterior away from values that fit, the model does fit.
  if (doubt.of == DoubtOf::prior) report.fits = found.check.best_fit_p >= judged.thresholds.best_fit_p;
  add_modes(report, model, found);
  add_diagnostics(report, sampled);
  add_nuisances(report, sampled);
  add_draws(report, model, draws);
  add_bands(report, study, model, draws, seed_of(study, options));
  if (options.quadrature && model.dimension() <= 2 && report.cuts.empty())
    add_quadrature(report, sampled, draws, options);
  report.modes_parted_by = parted_by(study, model, found.modes);

  Words words = summarise(found, report.modes_parted_by, study.training.engine == data::Engine::demcal);
  const std::optional<LoneReading> lone =
      report.fits ? std::nullopt : lone_reading(study, model, found.best_fit.x, options.identify.thresholds);
  if (!report.fits && !lone) say_misfit(words, report, study, model, found, options.identify.thresholds);
  if (doubt.of != DoubtOf::nothing) say_doubt(report, doubt.of, words, study);
  if (lone) say_lone_reading(report, words, study, *lone);
  const std::vector<std::string> of_the_fit =
      found.fits ? say_fit(words, report, study, model, found, judged.thresholds) : std::vector<std::string>{};
  report.finding = words.finding;
  report.consequence = words.consequence;
  report.remedy = shown_remedy(words);
  add_warnings(report, doubt.of, sampled);
  report.warnings.insert(report.warnings.end(), of_the_fit.begin(), of_the_fit.end());
  add_prior_conflicts(report, sampled, doubt.conflicts);
  return report;
}

}  // namespace uq
