#include "uq/emulate/surrogates.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "uq/emulate/outlying_runs.hpp"
#include "uq/emulate/surrogate_report.hpp"
#include "uq/findings/study_units.hpp"

namespace uq {
namespace {

/// Whether some case uses measurements of this material and output, or is to predict some.
bool is_observed(const data::Study& study, const TrainingRows& rows) {
  const auto measures = [&](const std::string& name) {
    const data::ObservationSet& set = study.observations[study.observation_index(name).value()];
    return set.material == rows.material && set.column_of(rows.output).has_value();
  };
  const auto some = [&](const auto& users) {
    return std::any_of(users.begin(), users.end(),
                       [&](const auto& one) { return std::any_of(one.observe.begin(), one.observe.end(), measures); });
  };
  return some(study.cases) || some(study.unused_data);
}

/// Runs without those that all others contradict. One wrong run can look like a bend.
surrogate::TrainingSet without_outlying(const surrogate::TrainingSet& runs, const surrogate::FitOptions& fit) {
  const OutlyingRuns found = find_outlying(runs, surrogate::fit(runs, quick(fit)), fit);
  std::vector<int> kept;
  for (int run = 0; run < runs.y.size(); ++run)
    if (std::find(found.runs.begin(), found.runs.end(), run) == found.runs.end()) kept.push_back(run);
  return surrogate::chosen(runs, kept);
}

/// The scales on which the runs are learnt best; those of the cheaper level where there are two, since they are many.
std::vector<double> chosen_ratios(const data::Study& study, const TrainingRows& rows,
                                  const surrogate::FitOptions& fit) {
  const surrogate::TrainingSet& runs = rows.low ? *rows.low : rows.set;
  std::vector<double> own, ratios;
  for (const EmulatorInput& input : rows.inputs) {
    const data::Axis axis = input_of(study, input).axis;
    own.push_back(axis.scale == data::Scale::linear && axis.low > 0.0 ? axis.high / axis.low : 1.0);
  }
  const auto is_none = [](const surrogate::Stretch& stretch) { return stretch.is_none(); };
  std::vector<surrogate::Stretch> stretches = surrogate::choose_stretches(runs, fit, own);
  if (!std::all_of(stretches.begin(), stretches.end(), is_none))
    stretches = surrogate::choose_stretches(without_outlying(runs, fit), fit, own);
  for (const surrogate::Stretch& stretch : stretches) ratios.push_back(stretch.ratio);
  return ratios;
}

FittedSurrogate fit_rows(const data::Study& study, TrainingRows rows, const SurrogateOptions& options) {
  const surrogate::FitOptions fit_options = options_for(study, rows, options);
  FittedSurrogate fitted{.rows = std::move(rows), .process = {}, .two_level = {}, .report = {}};
  surrogate::TrainingSet& many = fitted.rows.low ? *fitted.rows.low : fitted.rows.set;
  const Eigen::Index all = many.y.size();
  if (all > options.runs_most) {
    const std::vector<int> kept = surrogate::thin(many, options.runs_most, options.fit.seed);
    many = surrogate::chosen(many, kept);
    std::vector<std::string>& places = fitted.rows.places;
    if (!fitted.rows.low && std::ssize(places) == all) {
      std::vector<std::string> left;
      for (const int run : kept) left.push_back(std::move(places[run]));
      places = std::move(left);
    }
  }
  if (options.stretch) stretch_rows(fitted.rows, chosen_ratios(study, fitted.rows, fit_options));
  const surrogate::TrainingSet& base = fitted.rows.low ? *fitted.rows.low : fitted.rows.set;
  fitted.process = std::make_shared<const surrogate::GaussianProcess>(surrogate::fit(base, fit_options));
  if (fitted.rows.low)
    fitted.two_level = std::make_shared<const surrogate::TwoLevelProcess>(
        surrogate::fit_two_level(*fitted.process, fitted.rows.set, {.seed = options.fit.seed}));
  fitted.report = report_of(study, fitted, options);
  if (many.y.size() < all)
    fitted.report.notes.push_back(fmt::format(
        "{} of {} runs train, chosen at random: a fit takes the cube of their number and a prediction its square; "
        "[surrogate] runs_most raises it",
        many.y.size(), all));
  // Samplers ask the surrogate some hundred thousand times, at a cost of the square of its runs.
  constexpr std::size_t many_inputs = 8;
  constexpr Eigen::Index slow_runs = 300;
  if (fitted.rows.inputs.size() >= many_inputs && many.y.size() > slow_runs)
    fitted.report.notes.push_back(fmt::format(
        "{} runs of {} inputs: with some ten readings a calibration of all of them takes a minute or so. Half the runs "
        "([surrogate] runs_most = {}) take less than half of it, and calibrate --no-scan half again",
        many.y.size(), fitted.rows.inputs.size(), many.y.size() / 2));
  return fitted;
}

/// The surrogate of the rows. A cheaper level that says nothing of the other spoils what the dear runs know. It is left
/// out where it does not vary, and where rho cannot be told from 0 and the dear runs predict each other clearly better
/// alone, by their squared leave-one-out errors.
FittedSurrogate fit_one(const data::Study& study, const TrainingRows& rows, const SurrogateOptions& options) {
  constexpr double clearly = 1.5;
  if (!rows.low || rows.set.y.size() < std::ssize(rows.inputs) + 2) return fit_rows(study, rows, options);
  std::optional<FittedSurrogate> both;  // none of a level that is the same everywhere
  if (rows.low->y.maxCoeff() > rows.low->y.minCoeff()) both = fit_rows(study, rows, options);
  if (both && std::abs(both->report.rho) >= 2.5 * both->report.rho_sd) return std::move(*both);
  TrainingRows dear = rows;
  dear.low.reset();
  FittedSurrogate alone = fit_rows(study, std::move(dear), options);
  if (both && !(1.0 - both->report.q2 > clearly * (1.0 - alone.report.q2))) return std::move(*both);
  const std::string why =
      both ? fmt::format("the other {} predict each other better without it (Q2 {:.4f}, and {:.4f} with it)",
                         rows.set.y.size(), alone.report.q2, both->report.q2)
           : "it is the same everywhere";
  alone.report.notes.insert(alone.report.notes.begin(),
                            fmt::format("the cheaper level, {} runs, is left out: {}", rows.low->y.size(), why));
  return alone;
}

/// "torque of carrier".
std::string described(const SurrogateReport& report) {
  return report.output + (report.material.empty() ? "" : " of " + report.material);
}

/// The runs as uq/posterior/support.hpp looks at them.
std::shared_ptr<const RunCloud> cloud_of(const FittedSurrogate& fitted) {
  const surrogate::HyperParameters hyper = fitted.process->hyper_parameters();
  auto cloud = std::make_shared<RunCloud>();
  cloud->points = fitted.rows.set.x;
  cloud->length_scales = hyper.length_scales;
  cloud->prior_variance = hyper.signal_sd * hyper.signal_sd;
  cloud->logarithmic = fitted.process->data().scale == surrogate::OutputScale::log;
  if (fitted.two_level) {
    const Eigen::MatrixXd& low = fitted.rows.low->x;
    cloud->points.conservativeResize(fitted.rows.set.x.rows() + low.rows(), Eigen::NoChange);
    cloud->points.bottomRows(low.rows()) = low;
    const surrogate::TwoLevelParameters& two = fitted.two_level->parameters();
    cloud->prior_variance = two.rho * two.rho * cloud->prior_variance + two.discrepancy_sd * two.discrepancy_sd;
  }
  for (std::size_t k = 0; k < fitted.rows.inputs.size(); ++k)
    for (double& place : cloud->points.col(static_cast<Eigen::Index>(k)))
      place = study_place(fitted.rows.inputs[k], place);
  return cloud;
}

/// "runs.csv:31 (83.5 where the others say 8.35 mN m, 640 sd)".
std::string outlying_text(const OutlyingRun& run, const std::string& unit) {
  return fmt::format("{} ({:.4g} where the others say {:.4g}{}, {:.0f} sd off)", run.place, run.observed, run.expected,
                     behind_number(unit), std::abs(run.deviations));
}

std::string outlying_warning(const SurrogateReport& report) {
  std::string list;
  constexpr std::size_t most = 6;
  for (std::size_t i = 0; i < std::min(report.outlying.size(), most); ++i)
    list += (i > 0 ? ", " : "") + outlying_text(report.outlying[i], report.unit);
  if (report.outlying.size() > most) list += fmt::format(" and {} more", report.outlying.size() - most);
  const bool one = report.outlying.size() == 1;
  const char* const them = one ? "it" : "them";
  const std::string contradicted =
      one ? fmt::format("a run of {} is contradicted", described(report))
          : fmt::format("{} runs of {} are contradicted", report.outlying.size(), described(report));
  if (!report.outlying_together.empty())
    return fmt::format("{} by all others: {}. {} If {} wrong, leave {} out: {}", contradicted, list,
                       report.outlying_together, one ? "it is" : "they are", them, leave_out_key(report.outlying));
  return fmt::format("{} by all others: {}. Correct {}, or leave {} out: {}", contradicted, list, them, them,
                     leave_out_key(report.outlying));
}

}  // namespace

void stretch_rows(TrainingRows& rows, const std::vector<double>& ratios) {
  for (std::size_t k = 0; k < std::min(ratios.size(), rows.inputs.size()); ++k) {
    rows.inputs[k].stretch.ratio = ratios[k];
    const auto column = static_cast<Eigen::Index>(k);
    for (double& u : rows.set.x.col(column)) u = rows.inputs[k].stretch.place(u);
    if (!rows.low) continue;
    for (double& u : rows.low->x.col(column)) u = rows.inputs[k].stretch.place(u);
  }
}

std::string leave_out_key(const std::vector<OutlyingRun>& runs) {
  std::string key;
  for (const OutlyingRun& run : runs) key += fmt::format("{}\"{}\"", key.empty() ? "" : ", ", run.place);
  return "[training] leave_out = [" + key + "]";
}

std::vector<std::string> surrogate_warnings(const std::vector<FittedSurrogate>& fitted) {
  std::vector<std::string> warnings;
  for (const FittedSurrogate& one : fitted)
    if (!one.report.outlying.empty()) warnings.push_back(outlying_warning(one.report));
  for (const FittedSurrogate& one : fitted) {
    const SurrogateReport& report = one.report;
    if (report.verdict == SurrogateWord::unusable)
      warnings.push_back(
          fmt::format("the surrogate of {} is unusable and cannot stand for the model ({} runs): ignore "
                      "what rests on it. {}",
                      described(report), report.runs, report.remedy));
    if (!report.errors_in_doubt.empty()) warnings.push_back(described(report) + ": " + report.errors_in_doubt);
    if (!report.converged && report.verdict != SurrogateWord::good)
      warnings.push_back(fmt::format("the fit of the surrogate of {} did not converge", described(report)));
  }
  return warnings;
}

std::vector<std::string> surrogate_cautions(const std::vector<FittedSurrogate>& fitted) {
  std::vector<std::string> cautions;
  for (const FittedSurrogate& one : fitted)
    if (one.report.verdict == SurrogateWord::caution)
      cautions.push_back(fmt::format("the surrogate of {} is to be used with caution: {}", described(one.report),
                                     one.report.consequence));
  return cautions;
}

std::vector<FittedSurrogate> fit_surrogates(const data::Study& study, const data::RunTable& table,
                                            const SurrogateOptions& options) {
  std::vector<FittedSurrogate> fitted;
  for (const TrainingRows& rows : training_rows(study, table, options.low)) {
    if (options.observed_only && !is_observed(study, rows)) continue;
    const auto known = std::find_if(options.known.begin(), options.known.end(), [&](const FittedSurrogate& item) {
      return item.rows.material == rows.material && item.rows.output == rows.output;
    });
    fitted.push_back(known != options.known.end() ? *known : fit_one(study, rows, options));
  }
  return fitted;
}

std::string surrogate_name(const data::Study& study, const TrainingRows& rows) {
  const std::string& output = study.outputs[rows.output].name;
  return rows.material.empty() ? output : rows.material + " " + output;
}

Emulator emulator_of(const FittedSurrogate& fitted) {
  const TrainingRows& rows = fitted.rows;
  Emulator emulator = fitted.two_level ? make_emulator(fitted.two_level, rows.material, rows.output, rows.inputs)
                                       : make_emulator(fitted.process, rows.material, rows.output, rows.inputs);
  emulator.constants = rows.constants;
  emulator.control_range = rows.control_range;
  emulator.runs = cloud_of(fitted);
  if (fitted.report.verdict == SurrogateWord::unusable)
    emulator.doubt = fmt::format("the surrogate of {} is unusable", described(fitted.report));
  return emulator;
}

std::vector<Emulator> emulators_of(const std::vector<FittedSurrogate>& fitted) {
  std::vector<Emulator> emulators;
  for (const FittedSurrogate& item : fitted) emulators.push_back(emulator_of(item));
  return emulators;
}

}  // namespace uq
