#include "uq/report/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "uq/findings/study_units.hpp"
#include "uq/findings/wording.hpp"

namespace uq {
namespace {

constexpr std::size_t rows_shown = 12;

std::string with_unit(double sd, const std::string& unit) {
  return significant(sd, 2, Typography::ascii) + behind_number(unit);
}

std::string percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

double chance(const PlannedParameter& parameter, Verdict word) {
  for (const WordProbability& one : parameter.words)
    if (one.verdict == word) return one.probability;
  return 0.0;
}

/// Columns padded to their widest cell; numbers to the right.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> width;
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c == width.size()) width.push_back(0);
      width[c] = std::max(width[c], row[c].size());
    }
  std::string out;
  for (const auto& row : rows) {
    std::string line = "  ";
    for (std::size_t c = 0; c < row.size(); ++c)
      line += c == 0 || c + 1 == row.size() ? fmt::format("{:<{}}  ", row[c], width[c])
                                            : fmt::format("{:>{}}  ", row[c], width[c]);
    while (line.ends_with(' ')) line.pop_back();
    out += line + "\n";
  }
  return out;
}

std::string marks(const PlanCandidate& one) {
  std::vector<std::string> found;
  if (!one.teaches) found.emplace_back("teaches nothing");
  if (one.kind == CandidateKind::repeat) found.emplace_back("measured already");
  if (one.model_only) found.emplace_back("model only");
  if (one.no_runs) found.emplace_back("no runs there");
  if (one.assumed_error) found.push_back("error of " + one.error + " assumed");
  return fmt::format("{}", fmt::join(found, ", "));
}

}  // namespace

const PlannedParameter& asked(const PlanReport& plan, const std::vector<PlannedParameter>& parameters) {
  for (const PlannedParameter& one : parameters)
    if (one.name == plan.about) return one;
  throw std::out_of_range("the plan has no parameter '" + plan.about + "'");
}

std::string words_text(const PlannedParameter& parameter) {
  std::vector<std::string> words;
  for (const WordProbability& one : parameter.words)
    words.push_back(fmt::format("{} {:.0f} %", to_text(one.verdict), 100.0 * one.probability));
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string readings_text(const PlannedParameter& parameter) {
  const auto& [count, low, high] = std::tie(parameter.repeats_needed, parameter.repeats_low, parameter.repeats_high);
  if (count && low && !high)
    return fmt::format("about {} (at least {}: more readings raise the probability little)", *count, *low);
  if (count && low && *low < *high) return fmt::format("about {} ({} to {})", *count, *low, *high);
  if (count) return fmt::format("{}", *count);
  return parameter.floor.empty() ? "" : "never: " + parameter.floor;
}

std::string plan_text(const std::string& case_name, const PlanReport& plan) {
  std::string out = fmt::format("{}{}\n{}\n", case_name, plan.prior ? ", before any measurement" : "", plan.sentence);
  if (plan.candidates.empty()) return out;
  const PlannedParameter& now = asked(plan, plan.candidates.front().parameters);
  const bool words = !now.words.empty();
  const bool costs = std::any_of(plan.candidates.begin(), plan.candidates.end(),
                                 [](const PlanCandidate& one) { return one.cost != 1.0; });
  std::vector<std::vector<std::string>> rows(1);
  rows[0] = {"measure", "nats about " + plan.about, "in all", "sd " + with_unit(now.sd_now, now.unit) + " to"};
  if (words) rows[0].push_back("identified");
  if (costs) rows[0].push_back(plan.cost_unit.empty() ? "cost" : "cost (" + plan.cost_unit + ")");
  rows[0].emplace_back("");
  for (std::size_t i = 0; i < std::min(rows_shown, plan.candidates.size()); ++i) {
    const PlanCandidate& one = plan.candidates[i];
    const PlannedParameter& about = asked(plan, one.parameters);
    rows.push_back({one.name, fmt::format("{:.2f} +- {:.2f}", about.information, about.information_error),
                    fmt::format("{:.2f}", one.information), significant(about.sd_after, 2, Typography::ascii)});
    if (words) rows.back().push_back(percent(chance(about, Verdict::identified)));
    if (costs) rows.back().push_back(fmt::format("{:g}", one.cost));
    rows.back().push_back(marks(one));
  }
  out += aligned(rows);
  if (plan.candidates.size() > rows_shown)
    out += fmt::format("  ... and {} more in plan.json\n", plan.candidates.size() - rows_shown);
  for (const PlanCandidate& one : plan.candidates)
    if (const std::string readings = readings_text(asked(plan, one.parameters)); !readings.empty())
      out += fmt::format("  readings of {} for {} to be identified (90 %): {}\n", one.name, plan.about, readings);
  for (const PlanBatch& batch : plan.batches)
    out += fmt::format("  together: {}: {:.2f} +- {:.2f} nats, sd {} (one after the other {:.2f} nats)\n",
                       fmt::join(batch.candidates, " + "), batch.information, batch.information_error,
                       with_unit(batch.sd_after, now.unit), batch.greedy);
  if (!plan.runs.parameters.empty()) {
    const PlannedParameter& exact = asked(plan, plan.runs.parameters);
    out += fmt::format("  training runs instead: at most sd {} ({:.2f} nats), with a surrogate that is exact\n",
                       with_unit(exact.sd_after, exact.unit), exact.information);
  }
  if (!plan.runs.points.empty()) {
    out += fmt::format(
        "  the next {} runs{}: they take the variance of the posterior density from {:.1f} to {:.1f} % of its mean "
        "square\n",
        plan.runs.points.size(),
        plan.runs.seconds > 0.0 ? fmt::format(", {:.0f} s of processor time", plan.runs.seconds) : "",
        100.0 * plan.runs.variance_before, 100.0 * plan.runs.variance_after);
    for (const std::string& point : plan.runs.points) out += "    " + point + "\n";
  }
  for (const std::string& note : plan.notes) out += "  note: " + note + "\n";
  return out;
}

}  // namespace uq
