#include "uq/findings/headline.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "uq/findings/listed.hpp"

namespace uq {
namespace {

using Names = std::vector<std::string>;

std::string capital(std::string text) {
  if (!text.empty()) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

/// Names of the measured outputs, in the order of the points.
Names measured(const CaseReport& result) {
  Names outputs;
  for (const PredictivePoint& point : result.predictive)
    if (std::find(outputs.begin(), outputs.end(), point.output) == outputs.end()) outputs.push_back(point.output);
  return outputs;
}

struct Standing {
  Names fixed;   ///< with their values
  Names open;    ///< not identified
  Names silent;  ///< parameters of which the data say nothing
};

Standing standing(const CaseReport& result, Typography typography) {
  Standing found;
  for (const ParameterReport& parameter : result.parameters) {
    const Verdict verdict = shown_verdict(result, parameter);
    const std::string value = parameter.name + " at " + format_estimate(parameter, typography);
    if (verdict == Verdict::identified)
      found.fixed.push_back(value);
    else if (verdict == Verdict::weakly_identified)
      found.fixed.push_back(value + " (weakly)");
    else if (verdict == Verdict::several_values)
      found.fixed.push_back(value + " (separate values)");
    else if (parameter.reason == Reason::no_influence)
      found.silent.push_back(parameter.name);
    else
      found.open.push_back(parameter.name);
  }
  return found;
}

/// Combinations whose value is known, and whether a curve ties the open parameters.
Names known_together(const CaseReport& result, Typography typography) {
  Names known;
  for (const TradedPair& traded : result.traded)
    if (std::isfinite(traded.value))
      known.push_back(traded.combination + " at " +
                      format_with_error(traded.value, traded.error, traded.unit, typography));
  return known;
}

bool tied_by_a_curve(const CaseReport& result) {
  return std::any_of(result.traded.begin(), result.traded.end(),
                     [](const TradedPair& traded) { return !std::isfinite(traded.value); });
}

/// The next step in words: the plan's first choice, where there is a plan.
std::string next_step(const CaseReport& result, const Standing& found) {
  if (found.open.empty()) return {};
  if (!result.plan || result.plan->candidates.empty()) return " Next: demcal plan says what to measure.";
  const PlanCandidate& first = result.plan->candidates.front();
  if (!first.teaches) return " No candidate of the plan would teach more of " + result.plan->about + ".";
  const std::string next = " Next: measure " + first.name +
                           (first.no_runs      ? ", once training runs are made there"
                            : first.model_only ? ", if it means the same in the real powder"
                                               : "");
  const auto asked = std::find_if(first.parameters.begin(), first.parameters.end(),
                                  [&](const PlannedParameter& one) { return one.name == result.plan->about; });
  const bool floored = asked != first.parameters.end() && !asked->repeats_needed && !asked->floor.empty();
  if (!floored) return next + ".";
  double identified = 0.0;
  for (const WordProbability& word : asked->words)
    if (word.verdict == Verdict::identified) identified = word.probability;
  constexpr double likely = 0.5;
  return identified >= likely
             ? next + fmt::format("; {} is then identified with a probability of {:.0f} %.", asked->name,
                                  100.0 * identified)
             : next + "; it narrows " + asked->name + ", but however often it is read it does not identify it.";
}

}  // namespace

bool is_synthetic(const CaseReport& result) {
  return std::any_of(result.observed_notes.begin(), result.observed_notes.end(), [](const std::string& note) {
    std::string start = note.substr(0, 9);
    std::transform(start.begin(), start.end(), start.begin(), [](unsigned char c) { return std::tolower(c); });
    return start == "synthetic";
  });
}

std::string headline(const CaseReport& result, Typography typography) {
  if (result.unusable)
    return "Nothing can be said of the parameters: the surrogate is unusable. Ignore what follows, and do first what "
           "the warning says.";
  if (!result.converged) return "No result yet: the sampler has not converged.";
  if (!result.doubt.empty()) return "No verdict yet: " + result.doubt + ".";
  const Names outputs = measured(result);
  if (!result.fits)
    return "No values of the parameters reproduce the measured " + (outputs.empty() ? "data" : listed(outputs)) + ".";

  const std::string subject = outputs.empty() ? "The data" : capital(listed(outputs));
  const bool one = outputs.size() == 1;
  const std::string fixes = one ? " fixes " : " fix ", ties = one ? " ties " : " tie ", does = one ? " does" : " do";
  const Standing found = standing(result, typography);
  Names fixed = known_together(result, typography);
  fixed.insert(fixed.begin(), found.fixed.begin(), found.fixed.end());

  std::string text = subject;
  if (!fixed.empty())
    text += fixes + listed(fixed) +
            (found.open.empty()       ? ""
             : found.open.size() == 1 ? ", not " + found.open.front() + " itself"
                                      : ", not " + listed(found.open) + " themselves");
  else if (found.open.size() > 1 && tied_by_a_curve(result))
    text += ties + listed(found.open) + " together along a curve, and" + fixes +
            (found.open.size() == 2 ? "neither" : "none of them");
  else if (found.open.size() > 1)
    text += fixes + "none of " + listed(found.open);
  else
    text += does + " not fix " + (found.open.empty() ? listed(found.silent) : found.open.front());
  text += '.';
  if (!found.silent.empty() && (!fixed.empty() || !found.open.empty()))
    text += " Nothing is said of " + listed(found.silent) + ".";
  return text + next_step(result, found);
}

}  // namespace uq
