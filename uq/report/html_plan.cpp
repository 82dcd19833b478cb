// What to measure next: the answer, information against the first control, the outputs' directions, the candidates.
#include <fmt/format.h>

#include "uq/findings/wording.hpp"
#include "uq/report/figures.hpp"
#include "uq/report/page.hpp"
#include "uq/report/plan.hpp"

namespace uq::page {
namespace {

constexpr Typography pretty = Typography::unicode;
std::string candidate_table(const PlanReport& plan) {
  const PlannedParameter& now = asked(plan, plan.candidates.front().parameters);
  Table table{
      .caption = fmt::format(
          "Candidates by what they are expected to teach of {} per cost. Its posterior sd is {} now.", text(plan.about),
          text(format_value(now.sd_now, rounding_of(now.sd_now, 0.1 * now.sd_now), now.unit, pretty))),
      .head = {{"Measurement"},
               {"Error"},
               number("Information (nats)"),
               number("sd after"),
               {"Verdict then"},
               {"Readings needed"},
               number("Cost")},
      .rows = {}};
  for (const PlanCandidate& one : plan.candidates) {
    const PlannedParameter& about = asked(plan, one.parameters);
    std::string name = text(one.name);
    if (one.kind == CandidateKind::repeat) name += " <span class=\"soft\">(measured already)</span>";
    if (one.model_only) name += " <span class=\"soft\">(model only)</span>";
    if (!one.teaches) name += " <span class=\"soft\">(teaches nothing)</span>";
    table.rows.push_back({{name, "long"},
                          {text(one.error) + (one.assumed_error ? " assumed" : "")},
                          number(fmt::format("{:.2f} \u00b1 {:.2f}", about.information, about.information_error)),
                          number(significant(about.sd_after, 2, pretty)),
                          {text(words_text(about)), "long"},
                          {text(readings_text(about)), "long"},
                          number(fmt::format("{:g}", one.cost))});
  }
  return html(table);
}

}  // namespace

std::string plan_part(const CaseReport& result, const std::string& id, const Context& context) {
  if (!result.plan) return {};
  const PlanReport& plan = *result.plan;
  std::string out = "<h3>What to measure next</h3>\n<p>" + text(plan.sentence) + "</p>\n";
  if (plan.candidates.empty()) return out;
  if (const auto information = information_figure(plan, id + "-plan"))
    out += figure(
        *information,
        "Information that one reading is expected to give of a parameter, all others integrated out. One nat narrows a "
        "normal posterior to 37\u00a0% of its width.",
        context);
  if (const auto arrows = arrow_figure(plan, id + "-arrows"))
    out += figure(*arrows,
                  "How each reading changes when a parameter changes by its prior's standard deviation, in errors of "
                  "one reading. Parallel "
                  "arrows leave the two parameters traded; crossing ones part them.",
                  context);
  out += candidate_table(plan);
  std::string more;
  for (const PlanBatch& batch : plan.batches)
    more += fmt::format("<li>Together, {}: {:.2f} \u00b1 {:.2f} nats ({:.2f} when picked one after the other).</li>\n",
                        text(fmt::format("{}", fmt::join(batch.candidates, " + "))), batch.information,
                        batch.information_error, batch.greedy);
  if (!plan.runs.parameters.empty()) {
    const PlannedParameter& exact = asked(plan, plan.runs.parameters);
    more += fmt::format(
        "<li>Training runs instead can at most give {:.2f} nats: with an exact surrogate the sd is {}.</li>\n",
        exact.information, text(significant(exact.sd_after, 2, pretty)));
  }
  for (const std::string& note : plan.notes) more += "<li>" + text(note) + "</li>\n";
  return out + (more.empty() ? "" : "<ul>\n" + more + "</ul>\n");
}

}  // namespace uq::page
