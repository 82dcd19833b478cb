#include "uq/verdict/verdict.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "uq/findings/study_units.hpp"
#include "uq/findings/wording.hpp"
#include "uq/verdict/reason.hpp"

namespace uq {
namespace {

/// Three significant digits.
std::string number(double value) { return fmt::format("{:.3g}", value); }

std::string in_unit(const std::string& text, const std::string& unit) { return text + behind_number(unit); }

/// A value to the digits that the parameter's error leaves.
std::string rounded(double value, const ParameterReport& parameter) {
  return format_value(value, rounding_of(value, parameter.sd), parameter.unit, Typography::ascii);
}

std::string interval(const ParameterReport& parameter) {
  std::string text;
  for (const ValueRange& part : parameter.intervals) {
    const double sd = part.sd > 0.0 ? part.sd : parameter.sd;
    text += (text.empty() ? "" : " and ") +
            format_interval(part.low, part.high, rounding_of(part.high, sd), parameter.unit, Typography::ascii);
  }
  return text;
}

std::string left_variance(const WordFacts& facts) {
  return fmt::format("{:.2g} % of the prior's variance is left", 100.0 * std::max(1.0 - facts.contraction, 0.0));
}

const char* count_word(std::size_t count) {
  constexpr const char* words[] = {"no", "one", "two", "three", "four", "five", "six"};
  return count < std::size(words) ? words[count] : "several";
}

/// The other word over repeats of the data, as a clause.
std::string other_word(Verdict verdict, const std::vector<WordProbability>& repeats) {
  for (const WordProbability& word : repeats)
    if (word.verdict != verdict)
      return fmt::format(" Another measurement of the same kind would say \"{}\" with a probability of {:.0f} %.",
                         to_text(word.verdict), 100.0 * word.probability);
  return {};
}

std::string open_sentence(const ParameterEvidence& evidence, Reason reason) {
  const ParameterReport& parameter = evidence.found;
  const WordFacts& facts = evidence.facts;
  const std::string range =
      in_unit(number(parameter.prior_low) + " and " + number(parameter.prior_high), parameter.unit);
  if (reason == Reason::unsupported) {
    const auto& [low, high] = std::pair{parameter.runs_end_low, parameter.runs_end_high};
    const auto end = [&](double value) { return in_unit(number(value), parameter.unit); };
    return fmt::format(
        "{} is not identified: values that fit go on where no run was made. The runs reach {}{}{}, its range lies "
        "between {}, and what the surrogate says beyond the runs is untested.",
        parameter.name, low ? "from " + end(*low) : "", low && high ? " " : "", high ? "up to " + end(*high) : "",
        range);
  }
  if (facts.open_low && facts.open_high) {
    const bool pinned = !parameter.low_pinned_by.empty() || !parameter.high_pinned_by.empty();
    return fmt::format("{} is not identified: the data leave it open on both sides{}{}.", parameter.name,
                       pinned ? fmt::format(" (between {} only the ranges of other parameters limit it)", range) : "",
                       because(reason, evidence));
  }
  const double end = facts.open_high ? parameter.intervals.front().low : parameter.intervals.back().high;
  const std::string limit = (facts.open_high ? "at least " : "at most ") + rounded(end, parameter);
  const std::string& by = facts.open_high ? parameter.high_pinned_by : parameter.low_pinned_by;
  if (!by.empty())
    return fmt::format(
        "{} is not identified: {} (95 % profile), but on the other side only the end of the range of {} limits it{}.",
        parameter.name, limit, by, because(reason, evidence));
  return fmt::format(
      "{} is not identified: {} (95 % profile), but {} that every value up to the end of its range, {}, fits{}.",
      parameter.name, limit, facts.open_high ? "above" : "below",
      in_unit(number(facts.open_high ? parameter.prior_high : parameter.prior_low), parameter.unit),
      because(reason, evidence));
}

std::string several_sentence(const ParameterReport& parameter) {
  std::string values;
  for (std::size_t i = 0; i < parameter.intervals.size(); ++i) {
    const ValueRange& part = parameter.intervals[i];
    constexpr Typography ascii = Typography::ascii;
    values += fmt::format("{}{} ({}, {:.0f} % of the posterior)", i == 0 ? "" : "; ",
                          format_with_error(part.mean, part.sd, parameter.unit, ascii),
                          format_interval(part.low, part.high, rounding_of(part.mean, part.sd), parameter.unit, ascii),
                          100.0 * part.weight);
  }
  return fmt::format("{} has {} separate values that fit: {}; what lies between does not fit.", parameter.name,
                     count_word(parameter.intervals.size()), values);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> describe(const VerdictThresholds& thresholds) {
  return {
      {"contraction for identified", fmt::format("at least {:g}", thresholds.contraction_identified)},
      {"contraction for weakly identified", fmt::format("at least {:g}", thresholds.contraction_weak)},
      {"profile likelihood interval",
       fmt::format("deviance up to {:.4g} (95 %); more where the size of the errors is unknown",
                   thresholds.profile_drop)},
      {"no influence",
       fmt::format(
           "its whole range changes the predictions by less than {:g} of the surrogate's sds, or the deviance "
           "by less than {:g}, and would with errors {:g} times smaller; and its interval is open on both sides",
           thresholds.told_apart_sd, thresholds.silent_deviance, thresholds.errors_lowered)},
      {"interval open for another parameter's range",
       fmt::format("deviance at its end at least {:g} times as large with that parameter in the middle of its own "
                   "interval",
                   thresholds.pinned_drops)},
      {"value that depends on where another's range ends",
       fmt::format("it would move by at least {:g} of its error if that range went on", thresholds.range_shift)},
      {"several values",
       fmt::format("parts of the interval with a barrier that two of the surrogate's sds do not explain; contraction "
                   "within them at least {:g}",
                   thresholds.contraction_weak)},
      {"posterior predictive p for a fit", fmt::format("at least {:g}", thresholds.predictive_p)},
      {"chi-squared tail of the best fit for a fit", fmt::format("at least {:g}", thresholds.best_fit_p)},
      {"chi-squared tail of a poor fit", fmt::format("below {:g}", thresholds.poor_fit_p)},
      {"readings closer to the model than their errors say",
       fmt::format("chance of so small a chi-squared below {:g}", thresholds.best_fit_p)},
      {"combination of traded parameters",
       fmt::format("its sd at most {:g} of that of any of its terms", thresholds.combination_share)},
      {"curved relation",
       fmt::format("the values fill at most {:g} of the room that independent ones would", thresholds.curve_share)},
      {"structural",
       fmt::format("along at least {:g} of the interval the others can keep the predictions the same, to {:g} of what "
                   "the parameter does alone, the surrogate's error counted in",
                   thresholds.structural_span, thresholds.same_share)},
      {"reading far from all others, errors of unknown size",
       fmt::format("chance below {:g} among so many readings", thresholds.outlying_chance)},
      {"repeats that say less than their number, errors of unknown size",
       fmt::format("chance of the settings' lack of fit below {:g}", thresholds.best_fit_p)},
      {"borderline", fmt::format("another word has a probability of at least {:g} over repeats of the measurement",
                                 thresholds.borderline_probability)},
  };
}

Verdict word_of(const WordFacts& facts, const VerdictThresholds& thresholds) {
  if (!facts.influences) return Verdict::not_identified;
  const bool narrowed = facts.contraction >= thresholds.contraction_weak;
  if (facts.closed()) {
    if (facts.parts > 1 && facts.contraction_within >= thresholds.contraction_weak) return Verdict::several_values;
    if (facts.contraction >= thresholds.contraction_identified) return Verdict::identified;
    return narrowed ? Verdict::weakly_identified : Verdict::not_identified;
  }
  // Narrow parts that begin or end where the range does are as separate as others.
  if (facts.parts > 1 && !facts.open_beyond && facts.contraction_within >= thresholds.contraction_identified)
    return Verdict::several_values;
  const bool upper_limit = facts.open_low && !facts.open_high && facts.physical_low;
  return upper_limit && narrowed ? Verdict::weakly_identified : Verdict::not_identified;
}

std::vector<WordProbability> probabilities_of(const std::vector<Verdict>& drawn) {
  std::vector<WordProbability> found;
  for (const Verdict word :
       {Verdict::identified, Verdict::weakly_identified, Verdict::several_values, Verdict::not_identified})
    if (const auto count = std::count(drawn.begin(), drawn.end(), word); count > 0)
      found.push_back({word, static_cast<double>(count) / static_cast<double>(drawn.size())});
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  return found;
}

ParameterVerdict judge(const ParameterEvidence& evidence, const FitEvidence& fit,
                       const std::vector<WordProbability>& repeats, const VerdictThresholds& thresholds) {
  const ParameterReport& parameter = evidence.found;
  ParameterVerdict found;
  const std::string value = format_with_error(parameter.mean, parameter.sd, parameter.unit, Typography::ascii);
  if (!evidence.unsupported.empty() && (!evidence.unusable || fit.fits(thresholds))) {
    found.reason = Reason::unsupported;
    found.sentence = fmt::format("{} is not identified: {}.", parameter.name, evidence.unsupported);
    return found;
  }
  if (!fit.fits(thresholds)) {
    found.verdict = Verdict::does_not_fit;
    found.borderline = fit.predictive_p > 0.5 * thresholds.predictive_p && fit.best_fit_p > 0.5 * thresholds.best_fit_p;
    found.sentence = fmt::format(
        "{}: the model does not fit the data at any value (posterior predictive p {:.2g}, best-fit p {:.2g}), so its "
        "{} means nothing.",
        parameter.name, fit.predictive_p, fit.best_fit_p, value);
    return found;
  }
  const WordFacts& facts = evidence.facts;
  found.verdict = word_of(facts, thresholds);
  double other = 0.0;
  for (const WordProbability& word : repeats)
    if (word.verdict != found.verdict) other = std::max(other, word.probability);
  found.borderline = other >= thresholds.borderline_probability;

  const std::optional<Reason> reason = find_reason(evidence, found.verdict);
  found.reason = reason;
  found.shares = find_shares(evidence, reason);
  if (!facts.influences && (reason == Reason::no_influence || reason == Reason::surrogate)) {
    found.sentence = fmt::format("{} is not identified{}.", parameter.name, because(*reason, evidence));
  } else if (found.verdict == Verdict::several_values) {
    found.sentence = several_sentence(parameter);
  } else if (found.verdict == Verdict::identified) {
    found.sentence = fmt::format("{} is identified: {}; 95 % profile interval {}; {}.", parameter.name, value,
                                 interval(parameter), left_variance(facts));
  } else if (facts.closed() && found.verdict == Verdict::weakly_identified) {
    found.sentence =
        fmt::format("{} is weakly identified: {}; the interval {} is closed but wide; {}{}.", parameter.name, value,
                    interval(parameter), left_variance(facts), because(*reason, evidence));
  } else if (facts.closed()) {
    found.sentence = fmt::format("{} is not identified: the interval {} is closed but {}{}.", parameter.name,
                                 interval(parameter), left_variance(facts), because(*reason, evidence));
  } else if (facts.open_low && !facts.open_high && facts.physical_low) {
    found.sentence = fmt::format(
        "{}: only an upper limit, {} at most (95 % profile; 95 % of the posterior lies below {}); it cannot be told "
        "from {}, its physical bound{}.",
        parameter.name, rounded(parameter.intervals.back().high, parameter), rounded(parameter.q95, parameter),
        number(parameter.prior_low), *reason == Reason::bound ? "" : because(*reason, evidence));
  } else {
    found.sentence = open_sentence(evidence, *reason);
  }
  if (found.borderline) found.sentence += other_word(found.verdict, repeats);
  return found;
}

}  // namespace uq
