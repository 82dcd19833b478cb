#include "uq/emulate/surrogate_report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "data/number_text.hpp"
#include "data/observations.hpp"
#include "data/time_series.hpp"
#include "surrogate/gaps.hpp"
#include "uq/emulate/outlying_runs.hpp"
#include "uq/emulate/scale_hint.hpp"
#include "uq/emulate/scaled_runs.hpp"
#include "uq/emulate/sensitivity.hpp"
#include "uq/findings/study_units.hpp"

namespace uq {
namespace {

/// In stated errors: where runs at one point differ by more, the errors are doubted.
constexpr double far_apart = 4.0;

std::vector<double> in_unit(const Eigen::VectorXd& values, const data::Unit& unit) {
  std::vector<double> shown;
  for (const double value : values) shown.push_back(unit.from_si(value));
  return shown;
}

/// Adds the findings of the two-level process, and how its cheaper level did.
void add_levels(SurrogateReport& report, const FittedSurrogate& fitted, const data::Output& output) {
  const surrogate::TwoLevelProcess& two = *fitted.two_level;
  report.low_runs = two.low().runs();
  report.rho = two.mean_rho();
  double spread = 0.0;
  for (const surrogate::TwoLevelParameters& p : two.high().settings)
    spread += p.weight * std::pow(p.rho - report.rho, 2);
  report.rho_sd = std::sqrt(spread);
  const double q2_low = surrogate::q2(fitted.rows.low->y, two.low().leave_one_out().mean);
  report.notes.insert(
      report.notes.begin(),
      fmt::format(
          "two levels: {} runs over {} of the cheaper level (Q2 {:.4f} left out); output = rho times the cheaper "
          "level's plus a discrepancy, rho {:.3g} +- {:.2g}, discrepancy sd {:.3g}{}",
          report.runs, report.low_runs, q2_low, report.rho, report.rho_sd,
          two.parameters().discrepancy_sd / output.unit.factor, behind_number(output.unit.symbol)));
  for (const std::string& note : surrogate::fit_notes(two.low().diagnostics()))
    report.notes.push_back("cheaper level: " + note);
}

/// The factor by which these runs differ from what the others say, if they have one in common.
std::optional<CommonFactor> factor_of(const std::vector<OutlyingRun>& runs) {
  std::vector<double> observed, expected;
  for (const OutlyingRun& run : runs) {
    observed.push_back(run.observed);
    expected.push_back(run.expected);
  }
  return common_factor(observed, expected);
}

/// Runs that the others contradict, and whether the runs' errors say what they scatter.
void add_outlying(SurrogateReport& report, const FittedSurrogate& fitted, const surrogate::FitOptions& options,
                  const data::Study& study) {
  const data::Output& output = study.outputs[fitted.rows.output];
  const TrainingRows& rows = fitted.rows;
  const OutlyingRuns found = find_outlying(rows.set, *fitted.process, options);
  for (std::size_t i = 0; i < found.runs.size(); ++i) {
    const auto run = static_cast<std::size_t>(found.runs[i]);
    report.outlying.push_back({.place = run < rows.places.size() && !rows.places[run].empty()
                                            ? rows.places[run]
                                            : fmt::format("run {}", run + 1),
                               .observed = output.unit.from_si(rows.set.y[found.runs[i]]),
                               .expected = output.unit.from_si(found.expected[i]),
                               .deviations = found.deviations[i]});
  }
  if (const auto scale = found.runs.empty() ? std::nullopt : best_log_scale(study, rows, found.runs, options)) {
    report.outlying_together = fmt::format(
        "On another scale {} with all others, as good runs do where the surrogate does not bend. Set {} first.",
        found.runs.size() == 1 ? "it agrees" : "they agree", scale->key);
  } else if (const auto end = at_one_end(rows.set.x, found.runs)) {
    const EmulatorInput& input = rows.inputs[end->input];
    const data::Input named = input_of(study, input);
    std::pair covered{named.axis.low, named.axis.high};
    if (input.kind == InputKind::control) covered = rows.control_range.at(input.index);
    report.outlying_together = fmt::format(
        "They lie together at {} {} (rank-sum test, p {:.1g}), as good runs do where the surrogate does not bend. {}",
        end->low ? "low" : "high", named.name, end->p, bend_hint(study, input, covered, end->low));
  }
  if (const auto common = factor_of(report.outlying)) {
    const bool all = common->runs == static_cast<int>(report.outlying.size());
    report.outlying_together += fmt::format(
        "{}{} of them are about {:.3g} times what the others say, as rows in another unit are.",
        report.outlying_together.empty() ? "" : " ", all ? "All" : std::to_string(common->runs), common->factor);
  }
  if (!report.outlying_together.empty()) {
    const bool one = report.outlying.size() == 1;
    report.remedy =
        fmt::format("All others contradict {}. {} If {} wrong, leave {} out: {}. ",
                    one ? "a run" : fmt::format("{} runs", report.outlying.size()), report.outlying_together,
                    one ? "it is" : "they are", one ? "it" : "them", leave_out_key(report.outlying)) +
        report.remedy;
  } else if (!report.outlying.empty()) {
    // How many runs are lacking is told by the others alone.
    report.remedy = fmt::format(
        "Correct {} or leave {} out, and fit again: {}.",
        report.outlying.size() == 1 ? "the run that all others contradict" : "the runs that all others contradict",
        report.outlying.size() == 1 ? "it" : "them", leave_out_key(report.outlying));
  }
  std::vector<double> relative;
  for (Eigen::Index i = 0; i < rows.set.y.size(); ++i)
    if (rows.set.y[i] != 0.0) relative.push_back(std::sqrt(rows.set.noise_variance[i]) / std::abs(rows.set.y[i]));
  if (relative.size() < 20) return;
  const double typical = data::median_of(std::move(relative));
  if (found.scatter < 0.25 && typical > 0.03)
    report.errors_in_doubt = fmt::format(
        "the runs scatter only {:.2g} times what their standard errors say ({:.0f} % of the value): are the errors in "
        "percent?",
        found.scatter, 100.0 * typical);
}

/// "friction 0.45, rpm 120 rpm": a point of the unit cube in the study's units.
std::string point_text(const data::Study& study, const TrainingRows& rows, const Eigen::VectorXd& point) {
  std::string text;
  for (std::size_t k = 0; k < rows.inputs.size(); ++k) {
    const data::Input input = input_of(study, rows.inputs[k]);
    const double place = study_place(rows.inputs[k], point[static_cast<Eigen::Index>(k)]);
    text += fmt::format("{}{} {:.3g}{}", text.empty() ? "" : ", ", input.name,
                        input.unit.from_si(input.axis.from_unit(place)), behind_number(input.unit.symbol));
  }
  return text;
}

/// Inputs of which few values were run, where the doubt of what lies between them is more than a detail.
void note_gaps(SurrogateReport& report, const data::Study& study, const FittedSurrogate& fitted) {
  constexpr double notable = 0.1;  // of the standard deviation of the runs' output
  const auto& data = fitted.process->data();
  for (std::size_t k = 0; k < data.active.size(); ++k) {
    double widest = 0.0;
    bool at_end = false;
    for (const surrogate::InputGap& gap : data.gaps) {
      if (gap.input != static_cast<int>(k)) continue;
      const double middle = 0.5 * (std::max(gap.low, 0.0) + std::min(gap.high, 1.0));
      const double doubt = gap.sd * std::sqrt(surrogate::gap_covariance(gap, middle, middle));
      if (doubt > widest) at_end = gap.low < 0.0 || gap.high > 1.0;
      widest = std::max(widest, doubt);
    }
    if (widest < notable) continue;
    const auto input = static_cast<std::size_t>(data.active[k]);
    std::set<long> values;
    for (const double value : data.points.col(k)) values.insert(std::lround(1e6 * value));
    report.notes.push_back(fmt::format(
        "{} values of {} were run, and what lies {} them is doubted by up to {:.0f} % of the runs' scatter. "
        "Runs there would show it. Where the response is known to be smooth, [surrogate] "
        "between_runs = \"trusted\" takes the doubt away",
        values.size(), input_of(study, fitted.rows.inputs[input]).name, at_end ? "beyond" : "between", 100.0 * widest));
  }
}

/// Says on which scales inputs are learnt, where these are not the study's own.
void note_scales(SurrogateReport& report, const data::Study& study, const TrainingRows& rows) {
  for (const EmulatorInput& one : rows.inputs) {
    if (one.stretch.is_none()) continue;
    const data::Input input = input_of(study, one);
    const double r = one.stretch.ratio;
    std::string scale = "a log scale whose " + std::string(r > 1.0 ? "low" : "high") + " end is stretched";
    if (input.axis.scale == data::Scale::linear) {
      const double shift = input.unit.differences().from_si((input.axis.high - r * input.axis.low) / (r - 1.0));
      const double size = input.unit.differences().from_si(input.axis.high - input.axis.low);
      scale = std::abs(shift) < 1e-9 * std::abs(size) ? fmt::format("log({})", input.name)
              : r > 1.0 ? fmt::format("log({} {} {:.3g}{})", input.name, shift > 0.0 ? "+" : "-", std::abs(shift),
                                      behind_number(input.unit.symbol))
                        : fmt::format("log({:.3g}{} - {})", -shift, behind_number(input.unit.symbol), input.name);
    }
    report.notes.push_back(fmt::format(
        "{} is learnt as {}: the response bends more at the {} end of its range, and on this scale alike all over",
        input.name, scale, r > 1.0 ? "low" : "high"));
  }
}

SurrogateWord word_of(surrogate::SurrogateVerdict verdict) {
  switch (verdict) {
    case surrogate::SurrogateVerdict::good:
      return SurrogateWord::good;
    case surrogate::SurrogateVerdict::caution:
      return SurrogateWord::caution;
    case surrogate::SurrogateVerdict::unusable:
      break;
  }
  return SurrogateWord::unusable;
}

void add_validation(SurrogateReport& report, const surrogate::Validation& found, const FittedSurrogate& fitted,
                    const data::Unit& unit) {
  const surrogate::TrainingSet& set = fitted.rows.set;
  report.runs = found.runs;
  report.q2 = found.q2_leave_one_out;
  report.q2_held_out = found.q2_held_out;
  report.coverage95 = found.coverage_leave_one_out.at95();
  report.coverage_left_out.assign(found.coverage_leave_one_out.observed.begin(),
                                  found.coverage_leave_one_out.observed.end());
  report.coverage_held_out.assign(found.coverage_held_out.observed.begin(), found.coverage_held_out.observed.end());
  for (const surrogate::HeldOutFold& fold : found.folds) {
    report.fold_distance.push_back(fold.mahalanobis);
    report.fold_runs.push_back(static_cast<double>(fold.runs.size()));
    report.fold_probability.push_back(fold.probability);
    report.pivoted_errors.insert(report.pivoted_errors.end(), fold.pivoted_errors.begin(), fold.pivoted_errors.end());
  }
  report.observed = in_unit(set.y, unit);
  report.predicted = in_unit(found.leave_one_out.mean, unit);
  report.standardised.assign(found.leave_one_out.standardised.begin(), found.leave_one_out.standardised.end());
  for (const double variance : set.noise_variance) report.observed_se.push_back(std::sqrt(variance) / unit.factor);
  report.verdict = word_of(found.verdict);
  report.finding = found.finding;
  report.consequence = found.consequence;
  report.remedy = found.remedy;
  report.notes = found.notes;
  if (found.noise.replicated && found.noise.understated() && found.noise.scatter_ratio > far_apart)
    report.errors_in_doubt = fmt::format(
        "runs at the same points differ by {:.1f} times what their standard errors say. That is taken for scatter of "
        "the runs. Are these the rows of two campaigns, of other settings or units?",
        found.noise.scatter_ratio);
}

void add_hyper_parameters(SurrogateReport& report, const data::Study& study, const FittedSurrogate& fitted,
                          surrogate::OutputScale scale) {
  const TrainingRows& rows = fitted.rows;
  const surrogate::HyperParameters hyper = fitted.process->hyper_parameters();
  // On the log scale the nugget is relative; shown at the mean output.
  const double unit_of_nugget = scale == surrogate::OutputScale::log ? std::abs(rows.set.y.mean()) : 1.0;
  const double nugget_sd =
      fitted.two_level ? fitted.two_level->parameters().nugget_sd : hyper.nugget_sd * unit_of_nugget;
  report.nugget_sd = nugget_sd / study.outputs[rows.output].unit.factor;
  for (std::size_t k = 0; k < rows.inputs.size(); ++k) {
    report.inputs.push_back(input_of(study, rows.inputs[k]).name);
    report.stretches.push_back(rows.inputs[k].stretch.ratio);
    report.length_scales.push_back(hyper.length_scales[k]);
  }
  report.converged =
      fitted.process->diagnostics().converged && (!fitted.two_level || fitted.two_level->high().diagnostics.converged);
  const auto& active = fitted.process->data();
  if (active.points.rows() < active.z.size())
    report.notes.push_back(fmt::format("{} runs at {}: replicates are pooled with their own errors", active.z.size(),
                                       data::counted(static_cast<std::size_t>(active.points.rows()), "point")));
}

void add_sensitivity(SurrogateReport& report, const FittedSurrogate& fitted, std::uint64_t seed) {
  const std::size_t inputs = fitted.rows.inputs.size();
  for (const SobolIndex& index : sobol_indices(emulator_of(fitted).predict, static_cast<int>(inputs), {.seed = seed})) {
    report.first_order.push_back(index.first);
    report.first_order_sd.push_back(index.first_sd);
    report.total_order.push_back(index.total);
    report.total_order_sd.push_back(index.total_sd);
  }
  if (inputs > static_cast<std::size_t>(sensitivity_inputs_max))
    report.notes.push_back(fmt::format("no Sobol indices: they are for {} inputs at most, and this surrogate has {}",
                                       sensitivity_inputs_max, inputs));
}

/// Where runs would help most. The surrogate's box is that of the runs; some of them may lie outside the study's.
std::string points_in_words(const data::Study& study, const TrainingRows& rows, const surrogate::Validation& found) {
  if (found.more_runs == 0 || found.next_points.rows() == 0) return "";
  const Eigen::MatrixXd points = found.next_points.cwiseMax(0.0).cwiseMin(1.0);
  std::string text = " Least is known at";
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    text += fmt::format("{} {}", i > 0 ? ";" : "", point_text(study, rows, points.row(i)));
  return text + ".";
}

/// Names a scale on which the left-out errors would be smaller, if there is one. A response that bends at one end of an
/// input's range has no one length scale there: however good the intervals are on average, at that end they are too
/// narrow.
void add_better_scale(SurrogateReport& report, const data::Study& study, const FittedSurrogate& fitted,
                      const surrogate::FitOptions& options) {
  constexpr double better = 0.7;       // of the error on the study's scales
  constexpr Eigen::Index quick = 300;  // runs; a surrogate that is good otherwise is worth no longer search
  const bool good = report.verdict == SurrogateWord::good;
  if (good && fitted.rows.set.y.size() > quick) return;
  const auto scale = best_log_scale(study, fitted.rows, {}, options);
  const double now = left_out_error(*fitted.process, fitted.rows.set);
  if (!scale || !(scale->error < better * now)) return;
  const std::string advice =
      fmt::format("Set {}: there the left-out errors are {:.2g} times smaller.", scale->key, now / scale->error);
  if (!good) {
    report.remedy += " " + advice;
    return;
  }
  report.verdict = SurrogateWord::caution;
  report.finding += " Its errors are not the same all over the range.";
  report.consequence =
      "Where the response bends, its intervals may be too narrow, and so may posteriors that lie there.";
  report.remedy = advice;
}

}  // namespace

surrogate::FitOptions options_for(const data::Study& study, const TrainingRows& rows, const SurrogateOptions& options) {
  surrogate::FitOptions fit = options.fit;
  const std::string& name = study.outputs[rows.output].name;
  if (std::find(options.log_outputs.begin(), options.log_outputs.end(), name) != options.log_outputs.end())
    fit.scale = surrogate::OutputScale::log;
  return fit;
}

SurrogateReport report_of(const data::Study& study, const FittedSurrogate& fitted, const SurrogateOptions& options) {
  const TrainingRows& rows = fitted.rows;
  const data::Output& output = study.outputs[rows.output];
  const surrogate::FitOptions fit_options = options_for(study, rows, options);
  surrogate::ValidationOptions validation_options = options.validation;
  validation_options.seed = options.fit.seed;
  const surrogate::Validation found =
      fitted.two_level ? surrogate::validate(*fitted.two_level, {.seed = options.fit.seed}, validation_options)
                       : surrogate::validate(rows.set, fit_options, *fitted.process, validation_options);
  SurrogateReport report;
  report.output = output.name;
  report.material = rows.material;
  report.unit = output.unit.symbol;
  add_validation(report, found, fitted, output.unit);
  report.remedy += points_in_words(study, rows, found);
  add_hyper_parameters(report, study, fitted, fit_options.scale);
  add_sensitivity(report, fitted, options.fit.seed);
  note_scales(report, study, rows);
  note_gaps(report, study, fitted);
  if (fitted.two_level) {
    add_levels(report, fitted, output);
    return report;
  }
  add_outlying(report, fitted, fit_options, study);
  const bool exact = found.held_out_reach < validation_options.thresholds.negligible;
  if (report.outlying.empty() && !exact) add_better_scale(report, study, fitted, fit_options);
  return report;
}

std::vector<std::string> extrapolation_notes(const data::Study& study, const TrainingRows& rows) {
  std::vector<std::string> notes;
  for (std::size_t k = 0; k < rows.inputs.size(); ++k) {
    const EmulatorInput& input = rows.inputs[k];
    Eigen::VectorXd column = rows.set.x.col(k);
    double low = column.minCoeff(), high = column.maxCoeff();
    if (rows.low) {
      column = rows.low->x.col(k);
      low = std::min(low, column.minCoeff());
      high = std::max(high, column.maxCoeff());
    }
    low = study_place(input, low);
    high = study_place(input, high);
    if (input.kind == InputKind::parameter) {
      // A scrambled design of a few dozen runs stops several percent short of its range's ends.
      constexpr double slack = 0.1;
      const data::Parameter& parameter = study.parameters[input.index];
      if (low > slack || high < 1.0 - slack)
        notes.push_back(fmt::format(
            "the runs cover {} from {:.3g} to {:.3g}{} only; in the rest of its range the surrogate extrapolates",
            parameter.name, in_study_unit(parameter, low), in_study_unit(parameter, high),
            behind_number(parameter.unit.symbol)));
      continue;
    }
    const data::Control& control = study.controls[input.index];
    int outside = 0, points = 0;
    for (const data::ObservationSet& set : study.observations) {
      const std::optional<std::size_t> where = set.column_of(rows.output);
      if (set.material != rows.material || !where) continue;
      for (const std::size_t i : data::points_with(set, *where)) {
        const double u = control.axis().to_unit(set.points[i].controls[input.index]);
        ++points;
        outside += u < low - 1e-9 || u > high + 1e-9;
      }
    }
    if (outside > 0) {
      const auto& [from, to] = rows.control_range.at(input.index);
      notes.push_back(
          fmt::format("{} of {} observed points lie outside the runs' {}, {:.4g} to {:.4g}{}: the "
                      "surrogate extrapolates there",
                      outside, points, control.name, control.unit.from_si(from), control.unit.from_si(to),
                      behind_number(control.unit.symbol)));
    }
  }
  return notes;
}

}  // namespace uq
