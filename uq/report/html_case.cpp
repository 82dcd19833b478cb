// One case of the page: verdict in words, its numbers, the output against its control, profiles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uq/findings/thresholds.hpp"
#include "uq/report/figures.hpp"
#include "uq/report/page.hpp"
#include "uq/report/plot.hpp"

namespace uq::page {
namespace {

constexpr Typography pretty = Typography::unicode;

std::string joined(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + text(name);
  return list;
}

std::string verdict_words(const CaseReport& result) {
  std::string out = "<div class=\"verdict\"><dl>\n";
  const auto entry = [&out](const char* heading, const std::string& words) {
    if (!words.empty()) out += fmt::format("<dt>{}</dt><dd>{}</dd>\n", heading, text(words));
  };
  if (!result.fits) {
    out +=
        "<dt>Fit</dt><dd>" + badge(Verdict::does_not_fit) + " No parameter value reproduces the observations.</dd>\n";
  }
  entry("Finding", result.finding);
  entry("Consequence", result.consequence);
  entry("Remedy", result.remedy);
  entry("Without", without_sentence(result));
  for (const std::string& warning : result.warnings) entry("Warning", warning);
  return out + "</dl></div>\n";
}

std::string parameter_table(const CaseReport& result) {
  Table table{.caption = {},
              .head = {{"Parameter"},
                       {"Mean \u00b1 sd"},
                       {"90\u00a0% interval"},
                       {"95\u00a0% profile interval"},
                       number("Contraction"),
                       {"Verdict"}},
              .rows = {}};
  std::string sentences;
  const bool believed = result.doubt.empty();
  const std::string nothing = "\u2013";
  for (const ParameterReport& parameter : result.parameters) {
    const Verdict verdict = shown_verdict(result, parameter);
    std::string said = badge(verdict);
    if (verdict == parameter.verdict && parameter.reason) said += fmt::format(" {}", to_text(*parameter.reason));
    if (parameter.borderline && result.fits) {
      const std::string words = format_words(parameter);
      said += fmt::format(" <span class=\"soft\">(borderline{})</span>", words.empty() ? "" : ": " + text(words));
    }
    const Rounding rounding = rounding_of(parameter.mean, parameter.sd);
    table.rows.push_back(
        {{text(parameter.name)},
         {text(shown_value(result, parameter, pretty)), verdict == Verdict::several_values ? "" : "nowrap"},
         {!believed ? nothing
          : verdict == Verdict::several_values
              ? "in parts"
              : text(format_interval(parameter.q05, parameter.q95, rounding, parameter.unit, pretty)),
          "nowrap"},
         {believed ? text(format_profile_interval(parameter, pretty)) : nothing,
          parameter.profile_low && parameter.profile_high && parameter.intervals.size() < 2 ? "nowrap" : ""},
         number(believed ? significant(parameter.contraction, std::abs(parameter.contraction) < 0.1 ? 1 : 2, pretty)
                         : nothing),
         {said}});
    const std::string sentence = shown_sentence(result, parameter);
    // The table says all of a parameter that is identified.
    if (!sentence.empty() && (verdict != Verdict::identified || parameter.borderline))
      sentences += "<li>" + text(sentence) + "</li>\n";
  }
  if (table.rows.empty()) return "<p>This case has no free parameter.</p>\n";
  return html(table) + (sentences.empty() ? "" : "<ul>\n" + sentences + "</ul>\n");
}

/// The values that belong together, where the posterior is in separate regions.
std::string mode_table(const CaseReport& result) {
  if (result.modes.size() < 2) return {};
  Table table{.caption = "Values that fit together: each row is a separate region of the posterior.",
              .head = {{"Share of the posterior"}},
              .rows = {}};
  for (const ParameterReport& parameter : result.parameters)
    table.head.push_back({text(name_in_unit(parameter.name, parameter.unit))});
  for (const ModeReport& mode : result.modes) {
    std::vector<Cell> row{{fmt::format("{:.0f}\u00a0%", 100.0 * mode.weight)}};
    for (const ParameterReport& parameter : result.parameters) {
      const bool known = mode.mean.contains(parameter.name) && mode.sd.contains(parameter.name);
      row.push_back({known
                         ? text(format_with_error(mode.mean.at(parameter.name), mode.sd.at(parameter.name), "", pretty))
                         : std::string(),
                     "nowrap"});
    }
    table.rows.push_back(std::move(row));
  }
  return html(table) +
         (result.modes_parted_by.empty() ? "" : "<p>To tell them apart, " + text(result.modes_parted_by) + ".</p>\n");
}

std::string nuisance_table(const CaseReport& result) {
  if (result.nuisances.empty()) return {};
  Table table{.caption =
                  "Unknowns of the measurement, sampled with the parameters and integrated out; no verdict is "
                  "asked of them. Their priors count as calibrations of the meter.",
              .head = {{"Unknown"}, {"Prior mean \u00b1 sd"}, {"Mean \u00b1 sd"}, {"90\u00a0% interval"}},
              .rows = {}};
  for (const NuisanceReport& nuisance : result.nuisances)
    table.rows.push_back(
        {{text(nuisance.name)},
         {text(format_with_error(nuisance.prior_mean, nuisance.prior_sd, nuisance.unit, pretty)), "nowrap"},
         {text(format_with_error(nuisance.mean, nuisance.sd, nuisance.unit, pretty)), "nowrap"},
         {text(format_interval(nuisance.q05, nuisance.q95, rounding_of(nuisance.mean, nuisance.sd), nuisance.unit,
                               pretty)),
          "nowrap"}});
  return html(table);
}

std::string fit_and_data(const CaseReport& result) {
  std::string out =
      fmt::format("<p>Fit: \u03c7\u00b2 = {} for {} degree{} of freedom; posterior predictive p = {}{}.</p>\n",
                  significant(result.chi2, 3, pretty), result.dof, result.dof == 1 ? "" : "s",
                  significant(result.ppp, 2, pretty), result.fits ? "" : ": the model does not fit");
  if (!result.observed_sets.empty()) out += "<p>Observations: " + joined(result.observed_sets) + ".</p>\n";
  std::string notes;
  for (const std::string& note : result.observed_notes)
    if (!note.empty()) notes += "<li>" + text(note) + "</li>\n";
  if (!notes.empty()) out += "<ul class=\"note\">\n" + notes + "</ul>\n";
  if (!result.linked.empty()) {
    out += fmt::format(
        "<p>Sampled jointly with <strong>{}</strong>: {} observations also inform the parameters shared with this "
        "case.</p>\n",
        joined(result.linked), result.linked.size() == 1 ? "its" : "their");
  }
  if (!result.cuts.empty())
    out += fmt::format(
        "<p>Cut: <strong>{}</strong>. That posterior is taken as it is: the observations of this case do not change "
        "it.</p>\n",
        joined(result.cuts));
  return out;
}

std::string predictive_table(const CaseReport& result, std::size_t rows_shown_openly) {
  if (result.predictive.empty()) return {};
  std::vector<std::string> controls, outputs;
  bool several_sets = false;
  for (const PredictivePoint& point : result.predictive) {
    for (const auto& [name, setting] : point.controls) {
      if (std::find(controls.begin(), controls.end(), name) == controls.end()) controls.push_back(name);
    }
    several_sets = several_sets || point.observation_set != result.predictive.front().observation_set;
  }
  const auto unit_of = [&result](const std::string& control) {
    for (const PredictiveCurve& curve : result.curves) {
      if (curve.control == control) return curve.control_unit;
    }
    return std::string();
  };
  Table table{.caption =
                  "Observed and modelled at the observed points. The interval is that of a new measurement with the "
                  "same error.",
              .head = {},
              .rows = {}};
  if (several_sets) table.head.push_back({"Observations"});
  for (const std::string& control : controls)
    table.head.push_back(number(text(name_in_unit(control, unit_of(control)))));
  for (const char* const heading :
       {"Output", "Observed \u00b1 standard error", "Model, mean", "Predicted measurement, 90\u00a0%"}) {
    table.head.push_back(heading == std::string_view("Output") ? Cell{heading} : number(heading));
  }
  for (const PredictivePoint& point : result.predictive) {
    const Rounding rounding = rounding_of(point.observed, point.standard_error);
    std::vector<Cell> row;
    if (several_sets) row.push_back({text(point.observation_set)});
    for (const std::string& control : controls) {
      const auto found = point.controls.find(control);
      row.push_back(number(found == point.controls.end() ? "" : fmt::format("{:.6g}", found->second)));
    }
    row.push_back({text(name_in_unit(point.output, point.unit))});
    row.push_back(number(format_with_error(point.observed, point.standard_error, "", pretty)));
    row.push_back(number(format_value(point.mean, rounding, "", pretty)));
    row.push_back(number(format_interval(point.q05, point.q95, rounding, "", pretty)));
    table.rows.push_back(std::move(row));
  }
  if (table.rows.size() <= rows_shown_openly) return html(table);
  return "<details><summary>The numbers behind the figure</summary>\n" + html(table) + "</details>\n";
}

/// What the case predicts of data that it has not used.
std::string prediction_part(const CaseReport& result) {
  std::string out;
  for (const PredictionReport& prediction : result.predictions) {
    Table table{.caption = "Predicted from the other data; the interval is that of a measurement with the same error.",
                .head = {{"Setting"},
                         {"Output"},
                         number("Observed \u00b1 standard error"),
                         number("Predicted, 90\u00a0%"),
                         number("z")},
                .rows = {}};
    for (const auto& [point, z] : prediction.points) {
      const Rounding rounding = rounding_of(point.observed, point.standard_error);
      std::string at;
      for (const auto& [name, value] : point.controls)
        at += fmt::format("{}{} {:.6g}", at.empty() ? "" : ", ", name, value);
      table.rows.push_back({{text(at)},
                            {text(name_in_unit(point.output, point.unit))},
                            number(format_with_error(point.observed, point.standard_error, "", pretty)),
                            number(format_interval(point.q05, point.q95, rounding, "", pretty)),
                            number(format_value(z, {.exponent = 0, .decimals = 1}, "", pretty))});
    }
    out += fmt::format("<h3>Prediction: {}</h3>\n<p>{}</p>\n", text(prediction.name), text(prediction.sentence)) +
           html(table);
  }
  return out;
}

std::string percent(double share) { return fmt::format("{:.0f}\u00a0%", 100.0 * share); }

std::string support_part(const CaseReport& result) {
  const SupportReport& support = result.support;
  if (!support.known) return {};
  std::string out = fmt::format(
      "<h3>Support by runs</h3>\n<p>{} of the posterior lies where no run speaks. The nearest run is {} length scales "
      "away "
      "(median), and the surrogate's variance there is {} of what it would be without runs.</p>\n",
      percent(support.unsupported), significant(support.distance, 2, pretty),
      significant(support.variance_ratio, 2, pretty));
  Table table{.caption = {},
              .head = {{"Input"}, {"Covered by runs"}, number("Posterior beyond"), number("Posterior in a gap")},
              .rows = {}};
  for (const InputSupport& input : support.inputs)
    table.rows.push_back({{text(input.name)},
                          {text(fmt::format("{:.4g} to {:.4g}{}{}", input.runs_low, input.runs_high,
                                            input.unit.empty() ? "" : " ", input.unit)),
                           "nowrap"},
                          number(percent(input.outside)),
                          number(percent(input.gap) +
                                 (input.gap > 0.0 ? fmt::format(" ({:.4g} to {:.4g})", input.gap_low, input.gap_high)
                                                  : std::string()))});
  return out + html(table);
}

std::string predictive_part(const CaseReport& result, const std::string& id, const Context& context) {
  const auto curves = curves_to_draw(result);
  if (curves.empty() && result.predictive.empty()) return {};
  // Curves made of the predictive points carry those points' measurement error.
  const bool made_of_points = std::all_of(result.curves.begin(), result.curves.end(),
                                          [](const PredictiveCurve& curve) { return curve.x.empty(); });
  std::string out = "<h3>Model against observation</h3>\n";
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::string set = curves[i].observation_set.empty() ? "" : " (" + text(curves[i].observation_set) + ")";
    out +=
        figure(predictive_figure(result, curves[i], fmt::format("{}-predictive-{}", id, i + 1)),
               fmt::format("{} against {}{}. Points: observed, bars of one standard error. Line and band: the model's "
                           "mean and 90\u00a0% of its posterior, surrogate uncertainty included, measurement error {}.",
                           text(curves[i].output), text(curves[i].control), set, made_of_points ? "too" : "not"),
               context);
  }
  return out + predictive_table(result, context.options.rows_shown_openly);
}

std::string discrepancy_part(const CaseReport& result, const std::string& id, const Context& context) {
  if (result.discrepancies.empty()) return {};
  std::string out =
      "<h3>Discrepancy</h3>\n<p>A process over the controls that stands for what no parameter value explains. It "
      "competes with the parameters: what it takes, they need not explain, and they become less certain.</p>\n";
  for (std::size_t i = 0; i < result.discrepancies.size(); ++i) {
    const DiscrepancyBand& band = result.discrepancies[i];
    out += figure(discrepancy_figure(result, band, fmt::format("{}-discrepancy-{}", id, i + 1)),
                  fmt::format("{} ({}): {:.0f}\u00a0% of the spread of the observations about the model is put down to "
                              "the discrepancy.",
                              text(band.output), text(band.observation_set), 100.0 * band.share),
                  context);
  }
  return out;
}

std::string comparison_part(const CaseReport& result) {
  std::string out;
  for (const ModelComparison& comparison : result.comparisons)
    out += fmt::format("<p><strong>With and without.</strong> {}</p>\n", text(comparison.sentence));
  return out;
}

/// What is said of the holes that the surrogate's own error may have made.
std::string doubts(const ParameterReport& parameter) {
  std::string words;
  for (const ProfileHole& hole : parameter.holes)
    if (hole.in_doubt)
      words += fmt::format(" The rise to {:.2g} between {} is within the surrogate's own error, and is no finding.",
                           hole.deviance,
                           format_interval(hole.low, hole.high, rounding_of(parameter.mean, parameter.sd),
                                           parameter.unit, Typography::unicode));
  return words;
}

std::string profile_part(const CaseReport& result, const std::string& id, const Context& context) {
  std::string figures;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    const ParameterReport& parameter = result.parameters[i];
    if (parameter.profile_x.size() < 2 || parameter.profile_deviance.size() != parameter.profile_x.size()) continue;
    ++drawn;
    figures += figure(profile_figure(parameter, fmt::format("{}-profile-{}", id, i + 1)),
                      fmt::format("{}: 95\u00a0% interval {}.{}", text(parameter.name),
                                  text(format_profile_interval(parameter, pretty)), text(doubts(parameter))),
                      context);
  }
  if (figures.empty()) return {};
  return fmt::format(
      "<h3>Profile likelihood</h3>\n<p>How much worse the best fit becomes when one parameter is held at a "
      "value. Where the curve stays below {:.3g}, the observations do not exclude the value.</p>\n"
      "<div class=\"pair{}\">\n{}</div>\n",
      deviance_95, drawn == 1 ? " single" : "", figures);
}

}  // namespace

std::string case_section(const CaseReport& result, std::size_t index, const Context& context) {
  const std::string id = case_id(index, result);
  return fmt::format("<section id=\"{}\">\n<h2>Case {}</h2>\n", id, text(result.name)) + verdict_words(result) +
         parameter_table(result) + (result.doubt.empty() ? mode_table(result) : "") + support_part(result) +
         verification_part(result, id, context) + plan_part(result, id, context) + comparison_part(result) +
         nuisance_table(result) + fit_and_data(result) + predictive_part(result, id, context) +
         prediction_part(result) + discrepancy_part(result, id, context) +
         (result.unusable ? "" : joint_part(result, id, context) + profile_part(result, id, context)) + "</section>\n";
}

}  // namespace uq::page
