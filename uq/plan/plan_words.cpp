#include "uq/plan/plan_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "uq/findings/study_units.hpp"

namespace uq::plan {
namespace {

/// A width in words, with as many digits as tell the width now from the width afterwards, three at most.
std::string width(const PlannedParameter& parameter, double sd) {
  const bool two = fmt::format("{:.2g}", parameter.sd_now) != fmt::format("{:.2g}", parameter.sd_after);
  return fmt::format("{:.{}g}{}", sd, two ? 2 : 3, behind_number(parameter.unit));
}

std::string chance_of_identified(const std::string& name, const PlannedParameter& gain) {
  if (gain.words.empty()) return {};
  double chance = 0.0;
  for (const WordProbability& word : gain.words)
    if (word.verdict == Verdict::identified) chance = word.probability;
  if (chance < 0.01)
    return fmt::format(" {} is not identified by that: {}.", name, gain.floor.empty() ? "it needs more" : gain.floor);
  return fmt::format(" {} is then identified with a probability of {:.0f} %.", name, 100.0 * chance);
}

/// The other parameter that a candidate teaches most of, and how to ask for it; empty where there is none.
std::string what_else(const PlanReport& report, std::size_t asked) {
  const PlanCandidate* best = nullptr;
  std::size_t most = asked;
  for (const PlanCandidate& one : report.candidates)
    for (std::size_t k = 0; k < one.parameters.size(); ++k) {
      if (k == asked || one.doubtful() || !teaches(one, k)) continue;
      if (best && one.parameters[k].information <= best->parameters[most].information) continue;
      best = &one;
      most = k;
    }
  if (!best) return {};
  const PlannedParameter& gain = best->parameters[most];
  return fmt::format(" {} can be learnt, {:.2f} nats by {}: --about {} plans for it.", gain.name, gain.information,
                     best->name, gain.name);
}

}  // namespace

std::string sentence_of(const PlanBasis& basis, const PlanReport& report) {
  const auto k = static_cast<std::size_t>(basis.about);
  const PlanCandidate& best = report.candidates.front();
  const PlannedParameter& gain = best.parameters[k];
  const bool identified = basis.found && basis.found->parameters[k].verdict == Verdict::identified;
  std::string text;
  if (identified) text = fmt::format("{} is identified already (+- {}). ", report.about, width(gain, gain.sd_now));
  if (best.teaches && basis.by_width)
    text += fmt::format(
        "Measure {}{} next: it is expected to part the values of {}, from +- {} over all to +- {} ({:.2f} "
        "nats).",
        best.name, best.kind == CandidateKind::repeat ? " again" : "", report.about, width(gain, gain.sd_now),
        width(gain, gain.sd_after), gain.information);
  else if (best.teaches && width(gain, gain.sd_now) == width(gain, gain.sd_after))
    text += fmt::format("The best reading, {}, hardly narrows {} (+- {}, {:.2f} nats).", best.name, report.about,
                        width(gain, gain.sd_now), gain.information);
  else if (best.teaches)
    text += fmt::format("Measure {}{} next: it is expected to narrow {} from +- {} to +- {} ({:.2f} nats).", best.name,
                        best.kind == CandidateKind::repeat ? " again" : "", report.about, width(gain, gain.sd_now),
                        width(gain, gain.sd_after), gain.information);
  else
    text += fmt::format("No candidate teaches anything of {}: the best, {}, gives {:.2f} nats.{}", report.about,
                        best.name, gain.information, what_else(report, k));
  if (best.teaches && !identified) text += chance_of_identified(report.about, gain);
  if (best.no_runs) text += " Make training runs there first: none speaks there, nor at any other candidate.";
  const auto set = std::find_if(report.candidates.begin(), report.candidates.end(), [&](const PlanCandidate& one) {
    return one.settings.size() > 1 && one.parameters[k].repeats_needed;
  });
  if (best.teaches && !identified && !gain.repeats_needed && set != report.candidates.end())
    text += fmt::format(" {}, made {} times, would identify it (probability of 90 %).", set->name,
                        *set->parameters[k].repeats_needed);
  const auto repeat = std::find_if(report.candidates.begin(), report.candidates.end(),
                                   [](const PlanCandidate& one) { return one.kind == CandidateKind::repeat; });
  if (best.teaches && repeat != report.candidates.end() && repeat != report.candidates.begin())
    text += fmt::format(
        " The best of what is measured already, once more ({}), gives {:.2f} nats{}.", repeat->name,
        repeat->parameters[k].information,
        basis.by_width ? fmt::format(" and leaves +- {}", width(gain, repeat->parameters[k].sd_after)) : "");
  const auto other = std::max_element(
      report.candidates.begin(), report.candidates.end(),
      [&](const auto& a, const auto& b) { return a.parameters[k].information < b.parameters[k].information; });
  if (other->model_only && !best.model_only && other->parameters[k].information > 2.0 * gain.information)
    text += fmt::format(
        " {} would give {:.2f} nats, but only if it means the same in the real powder as with enlarged grains.",
        other->name, other->parameters[k].information);
  if (k < report.runs.parameters.size() &&
      report.runs.parameters[k].information > std::max(gain.information, least_information))
    text += fmt::format(
        " Training runs come first: with an exact surrogate the data that are there give {} to +- {} ({:.2f} nats).",
        report.about, width(gain, report.runs.parameters[k].sd_after), report.runs.parameters[k].information);
  return text;
}

namespace {

/// "0.52", or "0.52 to 1.6".
std::string range_text(double low, double high) {
  return high - low < 0.005 * high ? fmt::format("{:.2g}", low) : fmt::format("{:.2g} to {:.2g}", low, high);
}

/// The range of differences of all candidates of an output from one other level of coarse graining.
struct LevelRange {
  double low = HUGE_VAL, high = 0.0, doubt = 0.0;
  int agree = 0, unsure = 0, candidates = 0;
  bool measured = false;  ///< the case reads it
};

/// One note for each output on what the powder's levels of coarse graining say.
std::vector<std::string> level_notes(const PlanReport& report) {
  std::map<std::pair<std::string, std::pair<std::string, std::string>>, LevelRange> ranges;
  for (const PlanCandidate& one : report.candidates)
    for (const PlanLevel& level : one.levels) {
      LevelRange& range = ranges[{fmt::format("{}", fmt::join(one.outputs, " and ")), {one.material, level.material}}];
      ++range.candidates;
      range.measured = range.measured || (!one.model_only && !level.agrees());
      if (!level.difference) continue;
      range.low = std::min(range.low, *level.difference);
      range.high = std::max(range.high, *level.difference);
      range.doubt = std::max(range.doubt, *level.doubt);
      range.agree += level.agrees() ? 1 : 0;
      range.unsure += !level.agrees() && *level.difference <= 1.0 ? 1 : 0;
    }
  std::vector<std::string> notes;
  for (const auto& [of, range] : ranges) {
    const auto& [reads, levels] = of;
    if (range.high < range.low) {
      notes.push_back(
          fmt::format("{}: '{}' is the same powder as '{}' at another coarse graining, but its runs do not "
                      "have this output at these settings over the same parameters, so nothing is compared: "
                      "make such runs to see whether the two agree.",
                      reads, levels.second, levels.first));
      continue;
    }
    std::string said = "it stays the model's where they do not agree";
    if (range.agree == range.candidates)
      said = "the two agree";
    else if (range.agree == 0 && range.unsure == range.candidates)
      said = fmt::format("the surrogates know the difference to {:.2g} only: more runs of the two would tell",
                         range.doubt);
    else if (range.measured)
      said = "the parameters are found through it, and hang on the coarse graining by as much";
    else if (range.agree == 0 && range.unsure == 0)
      said = "so that it stays the model's";
    notes.push_back(
        fmt::format("{}: the levels of coarse graining '{}' and '{}' differ by {} of a reading's error; {}.", reads,
                    levels.first, levels.second, range_text(range.low, range.high), said));
  }
  return notes;
}

/// "torque 3 %, tilt 1 degree": the errors with which candidates were judged, but for those that are assumed.
std::string errors_of_readings(const PlanReport& report) {
  std::vector<std::string> parts;
  for (const PlanCandidate& one : report.candidates) {
    if (one.assumed_error) continue;
    const std::string text = fmt::format("{} {}", fmt::join(one.outputs, " and "), one.error);
    if (std::find(parts.begin(), parts.end(), text) == parts.end()) parts.push_back(text);
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

std::vector<std::string> notes_of(const PlanBasis& basis, const PlanReport& report) {
  std::vector<std::string> notes;
  const auto some = [&](auto member) {
    return std::any_of(report.candidates.begin(), report.candidates.end(),
                       [&](const PlanCandidate& one) { return one.*member; });
  };
  if (const std::string errors = errors_of_readings(report); !errors.empty())
    notes.push_back(fmt::format("Readings are taken with these errors: {}.", errors));
  if (some(&PlanCandidate::assumed_error))
    notes.push_back(
        fmt::format("Nobody stated the error of an output that the case has not measured; {:g} % is assumed. "
                    "[plan] states yours.",
                    100.0 * basis.options.candidates.assumed_error));
  if (some(&PlanCandidate::model_only))
    notes.push_back(
        "Outputs marked 'model only' come from enlarged grains: they need not mean the same in the real powder, "
        "and are ranked last.");
  if (some(&PlanCandidate::no_runs))
    notes.push_back(
        "No run speaks where candidates are marked 'no runs there': what is forecast of them is the surrogate's "
        "extrapolation, and they are ranked last. Make training runs at those settings first.");
  for (std::string& note : level_notes(report)) notes.push_back(std::move(note));
  for (const RowGroup& group : basis.sampled.model->groups)
    if (!group.emulator.doubt.empty())
      notes.push_back(
          fmt::format("The surrogate cannot carry a verdict ({}): make training runs first.", group.emulator.doubt));
  if (!basis.sampled.draws.converged && !basis.options.prior)
    notes.push_back("The posterior has not converged: the ranking may change.");
  return notes;
}

std::string error_text(const data::Study& study, const Candidate& candidate) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < candidate.outputs.size(); ++i) {
    const data::Spread& error = candidate.error[i];
    const data::Unit& unit = study.outputs[candidate.outputs[i]].unit;
    std::string text;
    if (error.relative > 0.0) text = fmt::format("{:.3g} %", 100.0 * error.relative);
    if (error.absolute > 0.0)
      text += fmt::format("{}{:.3g}{}", text.empty() ? "" : " and ", error.absolute / unit.factor,
                          behind_number(unit.symbol));
    if (std::find(parts.begin(), parts.end(), text) == parts.end()) parts.push_back(text);
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace uq::plan
