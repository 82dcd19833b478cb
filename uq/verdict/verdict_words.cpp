#include "uq/verdict/verdict_words.hpp"

#include "uq/findings/study_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "uq/findings/listed.hpp"

namespace uq {
namespace {

/// Of the variance: from here on the surrogate, not the measurement, is what to improve first.
constexpr double mostly = 0.5;
/// Of the variance: below, a share is not worth a remedy.
constexpr double notable = 0.1;
/// Of the variance: from here on a common error is named beside the measurement's own.
constexpr double a_part = 0.25;
/// Of the data's errors: the surrogate may hide an effect that the data could see.
constexpr double hides = 2.0;

/// Share of the posterior variance from which on its number says nothing more.
constexpr double all_of_it = 0.995;

using Names = std::vector<std::string>;

const char* one_or(const Names& names, const char* one, const char* more) { return names.size() == 1 ? one : more; }

void add(Names& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

std::string sentence(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z')
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  return text + ".";
}

/// A remedy and what share of all widths asks for it.
struct Remedy {
  double weight = 0.0;
  std::string text;
};

/// Parameters sorted by what is said of them.
struct Sorted {
  Names known, several, weak, unknown;                                               ///< by word
  Names silent, structural, practical, surrogate, traded, one_sided, bound, common;  ///< by reason
  Names beyond_runs, wanted_runs;  ///< values that go on where no run is, and the runs that would tell
  Names conditional, ends_of;      ///< values that depend on where another's range ends, and whose ranges these are
  double of_structure = 0.0, of_measurement = 0.0, of_surrogate = 0.0, of_range = 0.0, of_common = 0.0;
  double largest_surrogate = 0.0;  ///< share of one parameter
  CommonShare largest_common;      ///< of one that is held by such errors, or partly
};

Sorted sort_parameters(const std::vector<ParameterReport>& parameters) {
  Sorted sorted;
  for (const ParameterReport& parameter : parameters) {
    const std::optional<Reason>& reason = parameter.reason;
    const std::string& name = parameter.name;
    if (parameter.verdict == Verdict::identified) sorted.known.push_back(name);
    if (parameter.verdict == Verdict::several_values) sorted.several.push_back(name);
    if (parameter.verdict == Verdict::weakly_identified) sorted.weak.push_back(name);
    if (reason.has_value() && *reason == Reason::no_influence) {
      sorted.silent.push_back(name);
      continue;
    }
    if (parameter.verdict == Verdict::not_identified) sorted.unknown.push_back(name);
    if (!reason) continue;
    (*reason == Reason::structural         ? sorted.structural
     : *reason == Reason::common_error     ? sorted.common
     : *reason == Reason::practical        ? sorted.practical
     : *reason == Reason::surrogate        ? sorted.surrogate
     : *reason == Reason::traded           ? sorted.traded
     : *reason == Reason::one_sided        ? sorted.one_sided
     : *reason == Reason::range_of_another ? sorted.conditional
     : *reason == Reason::unsupported      ? sorted.beyond_runs
                                           : sorted.bound)
        .push_back(name);
    for (const auto& [end, side] : {std::pair{parameter.runs_end_low, "below"}, {parameter.runs_end_high, "above"}})
      if (end)
        sorted.wanted_runs.push_back(
            fmt::format("with {} {} {:.3g}{}", name, side, *end, behind_number(parameter.unit)));
    if (*reason == Reason::range_of_another)
      add(sorted.ends_of, parameter.high_pinned_by.empty() ? parameter.low_pinned_by : parameter.high_pinned_by);
    sorted.of_structure += parameter.share_structure;
    (*reason == Reason::common_error ? sorted.of_common : sorted.of_measurement) += parameter.share_measurement;
    const bool held = *reason == Reason::common_error || *reason == Reason::practical || *reason == Reason::bound;
    if (held && parameter.common.share > sorted.largest_common.share) sorted.largest_common = parameter.common;
    sorted.of_surrogate += parameter.share_surrogate;
    sorted.largest_surrogate = std::max(sorted.largest_surrogate, parameter.share_surrogate);
    sorted.of_range += parameter.share_range;
  }
  return sorted;
}

std::string find_finding(const CaseFacts& facts, const Sorted& sorted) {
  std::string text;
  const auto say = [&text](const std::string& more) { text += (text.empty() ? "" : " ") + more; };
  if (!sorted.known.empty()) say(fmt::format("The data determine {}.", listed(sorted.known)));
  if (!sorted.several.empty())
    say(fmt::format("{} leave separate values of {} open.", text.empty() ? "The data" : "They",
                    listed(sorted.several)));
  if (!sorted.weak.empty())
    say(fmt::format("{} determine {} only weakly.", text.empty() ? "The data" : "They", listed(sorted.weak)));
  if (!sorted.unknown.empty()) say(fmt::format("The data do not determine {}.", listed(sorted.unknown)));
  if (!sorted.silent.empty())
    say(fmt::format("{} say nothing of {}.", sorted.silent.size() == facts.parameters.size() ? "The data" : "They",
                    listed(sorted.silent)));
  for (const TradedPair& traded : facts.traded)
    say(traded.form == CombinationForm::curved
            ? fmt::format("{} are traded against each other along a curve.", listed(traded.parameters))
            : fmt::format("{} are traded against each other: known together is {}.", listed(traded.parameters),
                          traded.statement));
  const std::size_t open = sorted.unknown.size() + sorted.weak.size();
  if (facts.traded.empty() && facts.collinearity > 10.0 && open > 1)
    say(fmt::format("The parameters' effects on the data are nearly the same (collinearity {:.0f}).",
                    facts.collinearity));
  return text;
}

std::string find_consequence(const CaseFacts& facts, const Sorted& sorted) {
  std::string text;
  const auto say = [&text](const std::string& more) { text += (text.empty() ? "" : " ") + more; };
  if (sorted.known.size() == facts.parameters.size()) {
    say(sorted.known.size() == 1 ? "The value with its error can be used."
                                 : "The values with their errors can be used.");
    double surrogate = 0.0;
    for (const ParameterReport& parameter : facts.parameters)
      surrogate = std::max(surrogate, parameter.share_surrogate);
    if (surrogate > 0.25)
      say(fmt::format("Up to {:.0f} % of {} variance is the surrogate's.", 100.0 * surrogate,
                      one_or(sorted.known, "its", "their")));
    return text;
  }
  if (!sorted.known.empty())
    say(fmt::format("{} of {} can be used with {}.", one_or(sorted.known, "The value", "The values"),
                    listed(sorted.known), one_or(sorted.known, "its error", "their errors")));
  if (!sorted.several.empty()) say("Carry each of the separate values on: their mean fits nothing.");
  const bool open = !sorted.unknown.empty() || !sorted.weak.empty();
  if (!facts.traded.empty() && open)
    say("Any of the equivalent points predicts the measured data as well; what else they predict differs. Do not carry "
        "one point of them to another machine or fill.");
  if (!sorted.one_sided.empty())
    say(fmt::format("Only a limit of {} is known; the value given depends on where the range ends.",
                    listed(sorted.one_sided)));
  if (!sorted.beyond_runs.empty())
    say(fmt::format("The data allow values of {} that no run has tried; {} given {} no result there.",
                    listed(sorted.beyond_runs), one_or(sorted.beyond_runs, "the value", "the values"),
                    one_or(sorted.beyond_runs, "is", "are")));
  if (!sorted.conditional.empty())
    say(fmt::format("{} of {} {} on where the range of {} ends, and can only be used if that end is real.",
                    one_or(sorted.conditional, "The value", "The values"), listed(sorted.conditional),
                    one_or(sorted.conditional, "depends", "depend"), listed(sorted.ends_of)));
  if (!sorted.bound.empty())
    say(fmt::format("The limit of {} can be used as such; {} is not excluded.", listed(sorted.bound),
                    one_or(sorted.bound, "its bound", "their bound")));
  Names poor, wide;
  for (const ParameterReport& parameter : facts.parameters) {
    const bool hidden = parameter.reason == Reason::practical || parameter.reason == Reason::surrogate ||
                        parameter.reason == Reason::structural || parameter.reason == Reason::common_error ||
                        parameter.reason == Reason::traded;
    if (hidden && facts.traded.empty())
      (parameter.verdict == Verdict::not_identified && parameter.contraction < 0.5 ? poor : wide)
          .push_back(parameter.name);
  }
  if (!wide.empty()) say(fmt::format("Of {} use the interval, not the mean.", listed(wide)));
  if (!poor.empty())
    say(fmt::format("{} of {} {} little better than the prior.", one_or(poor, "The value", "The values"), listed(poor),
                    one_or(poor, "is", "are")));
  if (!sorted.silent.empty())
    say(fmt::format("{} may be anything in {} range.", listed(sorted.silent), one_or(sorted.silent, "its", "their")));
  return text;
}

/// "the offset zero".
std::string in_words(const CommonError& error) {
  switch (error.kind) {
    case CommonErrorKind::offset:
      return "the offset " + error.name;
    case CommonErrorKind::gain:
      return "the gain " + error.name;
    case CommonErrorKind::scale:
      return "the rig's scale";
    case CommonErrorKind::setting:
      return "the true " + (error.name.empty() ? "settings" : error.name);
    case CommonErrorKind::meter:
      return "the meter's common error";
    case CommonErrorKind::discrepancy:
      break;
  }
  return "the discrepancy";
}

/// How it is found by itself.
std::string found_by(const CommonError& error) {
  switch (error.kind) {
    case CommonErrorKind::offset:
      return fmt::format("read the meter without load (the offset {})", error.name);
    case CommonErrorKind::gain:
      return fmt::format("calibrate the meter (the gain {})", error.name);
    case CommonErrorKind::scale:
      return "find the rig's scale with a powder whose parameters are known";
    case CommonErrorKind::setting:
      return error.name.empty() ? "measure the true settings, or measure at more settings"
                                : "measure the true " + error.name;
    case CommonErrorKind::meter:
      return "calibrate the meter";
    case CommonErrorKind::discrepancy:
      break;
  }
  return "measure a quantity that the model gives without a discrepancy";
}

/// `names`: parameters whose width such errors decide; none: they hold a part of some.
std::string common_remedy(const CommonShare& common, const Names& names) {
  const std::string part = common.share >= all_of_it
                               ? "nearly all"
                               : fmt::format("{}{:.0f} %", names.size() == 1 ? "" : "up to ", 100.0 * common.share);
  return sentence(
      fmt::format("{}: {} of the variance{} is held by errors that repeated readings share, and neither "
                  "repeats nor smaller errors of each take that away",
                  remedy_of(common.errors), part, names.empty() ? "" : " of " + listed(names)));
}

/// `share`: of the posterior variance, the surrogate's; of the parameter that has most of it.
std::string surrogate_remedy(double share, bool own_engine) {
  const std::string how =
      own_engine ? "demcal train STUDY --until posterior" : "next-runs.csv beside the report has points";
  const std::string runs = fmt::format("Make more training runs where the posterior lies ({}): ", how);
  return runs + (share < all_of_it
                     ? fmt::format("up to {:.0f} % of the posterior variance is the surrogate's.", 100.0 * share)
                     : "the surrogate's error decides the widths.");
}

/// Sets of traded parameters with one in `names`, as "friction and hamaker"; of those names alone where there are none.
std::string partners(const CaseFacts& facts, const Names& names) {
  Names together;
  for (const TradedPair& traded : facts.traded)
    if (std::any_of(traded.parameters.begin(), traded.parameters.end(), [&](const std::string& member) {
          return std::find(names.begin(), names.end(), member) != names.end();
        }))
      for (const std::string& member : traded.parameters) add(together, member);
  return together.empty() ? std::string() : listed(together);
}

std::vector<std::string> find_remedies(const CaseFacts& facts, const Sorted& sorted) {
  if (sorted.known.size() == facts.parameters.size()) return {};
  std::vector<Remedy> remedies;
  if (!sorted.several.empty())
    remedies.push_back({static_cast<double>(sorted.several.size()),
                        facts.parted_by.empty()
                            ? "Measure a quantity, or at a setting, that differs between the values."
                            : sentence(facts.parted_by)});
  if (!sorted.structural.empty()) {
    const std::string together = partners(facts, sorted.structural);
    remedies.push_back(
        {sorted.of_structure,
         fmt::format("Measure another kind of quantity, {}, or fix {} by an independent experiment: a smaller error of "
                     "the same measurement will not part them.",
                     together.empty() ? "one that " + listed(sorted.structural) + " alone " +
                                            one_or(sorted.structural, "changes", "change")
                                      : "one that responds differently to " + together,
                     together.empty() ? one_or(sorted.structural, "it", "one of them") : "one of them")});
  }
  const double variance = sorted.of_measurement + sorted.of_surrogate;
  const double surrogate = variance > 0.0 ? sorted.of_surrogate / variance : 0.0;
  const bool hidden =
      !sorted.practical.empty() || !sorted.surrogate.empty() || !sorted.traded.empty() || !sorted.bound.empty();
  if (hidden && (surrogate >= notable || !sorted.surrogate.empty())) {
    const bool first = surrogate >= mostly || !sorted.surrogate.empty();
    remedies.push_back({first ? std::max(sorted.of_surrogate, sorted.of_measurement + 1e-9) : 1e-9,
                        first ? surrogate_remedy(sorted.largest_surrogate, facts.own_engine)
                              : fmt::format("More training runs would help, too: up to {:.0f} % of the posterior "
                                            "variance is the surrogate's.",
                                            100.0 * sorted.largest_surrogate)});
  }
  if (!sorted.practical.empty()) {
    const std::string together = partners(facts, sorted.practical);
    remedies.push_back({sorted.of_measurement,
                        together.empty()
                            ? "Reduce the measurement error, or measure at more settings."
                            : fmt::format("Measure a quantity that responds differently to {}, fix one of them by an "
                                          "independent experiment, or reduce the measurement error.",
                                          together)});
  }
  const bool part = sorted.common.empty() && sorted.largest_common.share >= a_part;
  if (!sorted.common.empty() || part)
    remedies.push_back({part ? sorted.of_measurement * sorted.largest_common.share : sorted.of_common,
                        common_remedy(sorted.largest_common, sorted.common)});
  if (!sorted.traded.empty()) {
    const std::string together = partners(facts, sorted.traded);
    remedies.push_back({sorted.of_measurement,
                        fmt::format("Measure {}, or fix {} by an independent experiment: that parts them, whatever a "
                                    "smaller error of the same "
                                    "measurement would do.",
                                    together.empty() ? "another kind of quantity, one that " + listed(sorted.traded) +
                                                           " alone " + one_or(sorted.traded, "changes", "change")
                                                     : "a quantity that responds differently to " + together,
                                    together.empty() ? one_or(sorted.traded, "it", "one of them") : "one of them")});
  }
  if (!sorted.one_sided.empty())
    remedies.push_back(
        {sorted.of_range, fmt::format("Widen the range of {}, with training runs there, or measure where the response "
                                      "still changes with {}.",
                                      listed(sorted.one_sided), one_or(sorted.one_sided, "it", "them"))});
  if (!sorted.wanted_runs.empty())
    remedies.push_back(
        {sorted.of_range, fmt::format("Make training runs {}{}: the range goes on there, and the runs do not.",
                                      listed(sorted.wanted_runs), facts.own_engine ? "" : " with your code")});
  const bool widened = std::all_of(sorted.ends_of.begin(), sorted.ends_of.end(), [&](const std::string& name) {
    return std::find(sorted.one_sided.begin(), sorted.one_sided.end(), name) != sorted.one_sided.end();
  });
  if (!sorted.conditional.empty() && !widened)
    remedies.push_back(
        {sorted.of_range, fmt::format("Widen the range of {}, with training runs there.", listed(sorted.ends_of))});
  if (!sorted.bound.empty())
    remedies.push_back(
        {sorted.of_measurement, fmt::format("A smaller measurement error would lower the limit of {} or show a value.",
                                            listed(sorted.bound))});
  std::stable_sort(remedies.begin(), remedies.end(),
                   [](const Remedy& a, const Remedy& b) { return a.weight > b.weight; });
  if (!sorted.silent.empty()) {
    Names hidden_ones, silent;
    for (const ParameterReport& parameter : facts.parameters)
      if (parameter.reason == Reason::no_influence)
        (parameter.share_surrogate > mostly ? hidden_ones : silent).push_back(parameter.name);
    if (!silent.empty())
      remedies.push_back({0.0, fmt::format("Measure another quantity, or at other settings, that {} {}; or fix {}: "
                                           "what was measured does not depend on {}.",
                                           listed(silent), one_or(silent, "moves", "move"),
                                           one_or(silent, "it", "them"), one_or(silent, "it", "them"))});
    if (!hidden_ones.empty())
      remedies.push_back({0.0, fmt::format("More training runs would show whether {} {} at all: the surrogate's error "
                                           "is larger than the measurement's.",
                                           listed(hidden_ones), one_or(hidden_ones, "acts", "act"))});
  }
  std::vector<std::string> sentences;
  for (Remedy& remedy : remedies) sentences.push_back(std::move(remedy.text));
  return sentences;
}

/// Whether the posterior ends well inside the range on the side that the data leave open: a stated prior ends it there, and
/// not the range.
bool ended_by_prior(const ParameterEvidence& parameter) {
  constexpr double sds_away = 2.5;
  const double room =
      parameter.facts.open_high ? parameter.range_high - parameter.mean : parameter.mean - parameter.range_low;
  return room > sds_away * parameter.sd;
}

}  // namespace

std::string remedy_of(const std::vector<CommonError>& errors) {
  Names ways;
  for (const CommonError& error : errors) add(ways, found_by(error));
  return ways.empty() ? std::string() : listed(ways);
}

std::optional<Reason> find_reason(const ParameterEvidence& parameter, Verdict verdict) {
  if (verdict != Verdict::not_identified && verdict != Verdict::weakly_identified) return {};
  const WordFacts& facts = parameter.facts;
  if (!facts.influences) return parameter.hidden ? Reason::practical : Reason::no_influence;
  if (parameter.runs_end_low || parameter.runs_end_high) return Reason::unsupported;
  if (parameter.common.share > mostly && parameter.surrogate_share <= mostly) return Reason::common_error;
  if (parameter.structural) return Reason::structural;
  if (!parameter.conditional_on.empty()) return Reason::range_of_another;
  const bool pinned = !parameter.low_pinned_by.empty() || !parameter.high_pinned_by.empty();
  // The end of one's range where a combination alone is known is no limit that better data of the same kind would move.
  const bool half_open = facts.open_low != facts.open_high && !pinned;
  if (parameter.traded && verdict == Verdict::not_identified && (half_open || parameter.unknown_beyond) &&
      parameter.surrogate_share <= mostly)
    return Reason::traded;
  if (parameter.unknown_beyond || parameter.faint) return Reason::surrogate;
  if (facts.open_low && !facts.open_high && facts.physical_low) return Reason::bound;
  if (half_open && !ended_by_prior(parameter)) return Reason::one_sided;
  if (parameter.surrogate_share > mostly) return Reason::surrogate;
  if (parameter.undecided) return Reason::traded;
  return Reason::practical;
}

std::string because(Reason reason, const ParameterEvidence& parameter) {
  switch (reason) {
    case Reason::structural:
      return "; other parameters do the same to all that was measured, so that a better measurement of the same kind "
             "would not help";
    case Reason::practical:
      return "; the measurement's noise hides it";
    case Reason::common_error: {
      Names names;
      for (const CommonError& error : parameter.common.errors) add(names, in_words(error));
      return fmt::format("; {}, which repeated readings share, {} it", listed(names), one_or(names, "hides", "hide"));
    }
    case Reason::surrogate:
      return "; the surrogate's error hides it";
    case Reason::traded:
      return "; other parameters do much the same to all that was measured";
    case Reason::range_of_another:
      return fmt::format("; its value depends on where the range of {} ends, which the data would go beyond",
                         parameter.conditional_on);
    case Reason::one_sided:
    case Reason::bound:
    case Reason::unsupported:  // its sentence says why by itself
      return "";
    case Reason::no_influence:
      break;
  }
  return parameter.silent_sds > hides
             ? fmt::format(
                   ": the data say nothing of it. The runs show no effect of its range; the surrogate could "
                   "miss one of {:.1f} measurement errors",
                   parameter.silent_sds)
             : ": the data say nothing of it. Its whole range changes nothing that was measured, as far as the "
               "surrogate and the measurement can tell";
}

WidthShares find_shares(const ParameterEvidence& parameter, std::optional<Reason> reason) {
  const double surrogate = std::clamp(parameter.surrogate_share, 0.0, 1.0);
  if (reason == Reason::structural) return {.measurement = 0.0, .surrogate = 0.0, .structure = 1.0, .range = 0.0};
  if (reason == Reason::one_sided || reason == Reason::range_of_another || reason == Reason::unsupported)
    return {.measurement = 0.0, .surrogate = 0.0, .structure = 0.0, .range = 1.0};
  if (reason == Reason::surrogate && (parameter.unknown_beyond || parameter.faint))
    return {.measurement = 0.0, .surrogate = 1.0, .structure = 0.0, .range = 0.0};
  if (reason == Reason::no_influence)
    return parameter.silent_sds > hides
               ? WidthShares{.measurement = 0.0, .surrogate = 1.0, .structure = 0.0, .range = 0.0}
               : WidthShares{.measurement = 0.0, .surrogate = 0.0, .structure = 0.0, .range = 1.0};
  return {.measurement = 1.0 - surrogate, .surrogate = surrogate, .structure = 0.0, .range = 0.0};
}

std::string shown_remedy(const Words& words) {
  return words.remedies.empty() ? "None needed." : fmt::format("{}", fmt::join(words.remedies, " "));
}

Words words_of(const CaseFacts& facts) {
  const Sorted sorted = sort_parameters(facts.parameters);
  return {.finding = find_finding(facts, sorted),
          .consequence = find_consequence(facts, sorted),
          .remedies = find_remedies(facts, sorted)};
}

}  // namespace uq
