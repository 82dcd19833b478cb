#include "uq/verdict/verdict_words.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "uq/findings/listed.hpp"
#include "uq/findings/thresholds.hpp"
#include "uq/verdict/remedies.hpp"

namespace uq {
namespace {

std::string find_finding(const CaseFacts& facts, const SortedParameters& sorted) {
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
  if (facts.traded.empty() && facts.collinearity > collinearity_said && open > 1)
    say(fmt::format("The parameters' effects on the data are nearly the same (collinearity {:.0f}).",
                    facts.collinearity));
  return text;
}

std::string find_consequence(const CaseFacts& facts, const SortedParameters& sorted) {
  std::string text;
  const auto say = [&text](const std::string& more) { text += (text.empty() ? "" : " ") + more; };
  if (sorted.known.size() == facts.parameters.size()) {
    say(sorted.known.size() == 1 ? "The value with its error can be used."
                                 : "The values with their errors can be used.");
    double surrogate = 0.0;
    for (const ParameterReport& parameter : facts.parameters)
      surrogate = std::max(surrogate, parameter.shares.surrogate);
    if (surrogate > named_share)
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
      (parameter.verdict == Verdict::not_identified && parameter.contraction < VerdictThresholds{}.contraction_weak
           ? poor
           : wide)
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

}  // namespace

std::string shown_remedy(const Words& words) {
  return words.remedies.empty() ? "None needed." : fmt::format("{}", fmt::join(words.remedies, " "));
}

Words words_of(const CaseFacts& facts) {
  const SortedParameters sorted = sort_parameters(facts.parameters);
  return {.finding = find_finding(facts, sorted),
          .consequence = find_consequence(facts, sorted),
          .remedies = find_remedies(facts, sorted)};
}

}  // namespace uq
