// One case of the page: verdict in words, its parameters, where runs support it, profiles; the order of its parts.
#include <algorithm>
#include <cmath>

#include "uq/findings/study_units.hpp"
#include "uq/findings/thresholds.hpp"
#include "uq/report/figures.hpp"
#include "uq/report/page.hpp"

namespace uq::page {
namespace {

Markup verdict_words(const CaseReport& result) {
  const Markup misfit =
      tag::dt("Fit") + tag::dd(badge(Verdict::does_not_fit), " No parameter value reproduces the observations.");
  return tag::div.is("verdict")(tag::dl(
      result.fits ? Markup() : misfit, entry("Finding", result.finding), entry("Consequence", result.consequence),
      entry("Remedy", result.remedy), entry("Without", without_sentence(result)),
      each(result.warnings, [](const std::string& warning) { return entry("Warning", warning); })));
}

/// A parameter's verdict with its reason, and what else it could have been.
Markup said(const CaseReport& result, const ParameterReport& parameter) {
  const Verdict verdict = shown_verdict(result, parameter);
  Markup words = badge(verdict);
  if (verdict == parameter.verdict && parameter.reason) words += fmt::format(" {}", to_text(*parameter.reason));
  if (parameter.borderline && result.fits) {
    const std::string others = format_words(parameter);
    words += " " + tag::span.is("soft")("(borderline", others.empty() ? "" : ": ", others, ")");
  }
  return words;
}

Markup parameter_table(const CaseReport& result) {
  if (result.parameters.empty()) return tag::p("This case has no free parameter.");
  Table table{.columns = {{"Parameter"},
                          {"Mean \u00b1 sd", nowrap},
                          {"90\u00a0% interval", nowrap},
                          {"95\u00a0% profile interval"},
                          {"Contraction", number},
                          {"Verdict"}}};
  Markup sentences;
  const bool believed = result.doubt.empty();
  for (const ParameterReport& parameter : result.parameters) {
    const Verdict verdict = shown_verdict(result, parameter);
    const bool in_parts = verdict == Verdict::several_values;
    const bool closed = parameter.profile_low && parameter.profile_high && parameter.intervals.size() < 2;
    const Rounding rounding = rounding_of(parameter.mean, parameter.sd);
    const std::string central =
        in_parts ? "in parts" : interval(parameter.q05, parameter.q95, rounding, parameter.unit);
    table.rows.push_back(
        {parameter.name,
         {shown_value(result, parameter, pretty), in_parts ? plain : nowrap},
         believed ? central : nothing,
         {believed ? format_profile_interval(parameter, pretty) : nothing, closed ? nowrap : plain},
         believed ? digits(parameter.contraction, std::abs(parameter.contraction) < 0.1 ? 1 : 2) : nothing,
         said(result, parameter)});
    const std::string sentence = shown_sentence(result, parameter);
    // The table says all of a parameter that is identified.
    if (!sentence.empty() && (verdict != Verdict::identified || parameter.borderline)) sentences += tag::li(sentence);
  }
  return table + tag::ul.unless_empty(sentences);
}

/// The values that belong together, where the posterior is in separate regions.
Markup mode_table(const CaseReport& result) {
  if (result.modes.size() < 2) return {};
  Table table{.caption = "Values that fit together: each row is a separate region of the posterior.",
              .columns = {{"Share of the posterior"}}};
  for (const ParameterReport& parameter : result.parameters)
    table.columns.push_back({name_in_unit(parameter.name, parameter.unit), nowrap});
  for (const ModeReport& mode : result.modes) {
    table.rows.push_back({percent(mode.weight)});
    for (const ParameterReport& parameter : result.parameters) {
      const auto mean = mode.mean.find(parameter.name), sd = mode.sd.find(parameter.name);
      const bool known = mean != mode.mean.end() && sd != mode.sd.end();
      table.rows.back().push_back(known ? with_error(mean->second, sd->second) : "");
    }
  }
  const std::string& measurement = result.modes_parted_by;
  return table + (measurement.empty() ? Markup() : tag::p("To tell them apart, ", measurement, "."));
}

Markup support_part(const SupportReport& support) {
  if (!support.known) return {};
  Table table{
      .columns = {
          {"Input"}, {"Covered by runs", nowrap}, {"Posterior beyond", number}, {"Posterior in a gap", number}}};
  const bool several = std::any_of(support.inputs.begin(), support.inputs.end(), [&](const InputSupport& input) {
    return input.material != support.inputs.front().material;
  });
  for (const InputSupport& input : support.inputs) {
    // The surrogates of several outputs mostly have the same runs.
    if (&*std::find(support.inputs.begin(), support.inputs.end(), input) != &input) continue;
    const std::string gap = input.gap > 0.0 ? " (" + between(input.gap_low, input.gap_high) + ")" : "";
    const std::string of = several ? ", runs of " + input.material : "";
    table.rows.push_back({input.name + of, between(input.runs_low, input.runs_high) + behind_number(input.unit),
                          percent(input.outside), percent(input.gap) + gap});
  }
  return tag::h3("Support by runs") +
         tag::p(fmt::format("{} of the posterior lies where no run speaks. The nearest run is {} length scales away "
                            "(median), and the surrogate's variance there is {} of what it would be without runs.",
                            percent(support.unsupported), digits(support.distance, 2),
                            digits(support.variance_ratio, 2))) +
         table;
}

/// What is said of the holes that the surrogate's own error may have made.
std::string doubts(const ParameterReport& parameter) {
  std::string words;
  for (const ProfileHole& hole : parameter.holes)
    if (hole.in_doubt)
      words += fmt::format(" The rise to {:.2g} between {} is within the surrogate's own error, and is no finding.",
                           hole.deviance,
                           interval(hole.low, hole.high, rounding_of(parameter.mean, parameter.sd), parameter.unit));
  return words;
}

Markup profile_part(const CaseReport& result, const std::string& id, const Context& context) {
  Markup figures;
  std::size_t drawn = 0;
  bool unknown_errors = false;
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    const ParameterReport& parameter = result.parameters[i];
    unknown_errors = unknown_errors || parameter.profile_drop > deviance_95;
    if (parameter.profile_x.size() < 2 || parameter.profile_deviance.size() != parameter.profile_x.size()) continue;
    ++drawn;
    figures += figure(profile_figure(parameter, fmt::format("{}-profile-{}", id, i + 1)),
                      fmt::format("{}: 95\u00a0% interval {}.{}", parameter.name,
                                  format_profile_interval(parameter, pretty), doubts(parameter)),
                      context);
  }
  if (drawn == 0) return {};
  const std::string longer = unknown_errors
                                 ? fmt::format(
                                       " With errors of known size that line would lie at {:.3g}. Their size "
                                       "is unknown here, and found from the same observations.",
                                       deviance_95)
                                 : "";
  return tag::h3("Profile likelihood") +
         tag::p(
             "How much worse the best fit becomes when one parameter is held at a value. Where the curve stays below "
             "the broken line, the observations do not exclude the value." +
             longer) +
         tag::div.is(drawn == 1 ? "pair single" : "pair")(figures);
}

Markup comparison(const ModelComparison& one) { return tag::p(tag::strong("With and without."), " ", one.sentence); }

}  // namespace

Markup case_section(const CaseReport& result, const std::string& id, const Context& context) {
  Markup all = verdict_words(result) + parameter_table(result);
  if (result.doubt.empty()) all += mode_table(result);
  all += support_part(result.support);
  all += verification_part(result, id, context);
  all += plan_part(result, id, context);
  all += each(result.comparisons, comparison);
  all += data_part(result, id, context);
  if (result.unusable) return all;
  return all + joint_part(result, id, context) + profile_part(result, id, context);
}

}  // namespace uq::page
