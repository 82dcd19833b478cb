// What to measure next: the answer, information against the first control, the outputs' directions, the candidates.
#include "uq/report/figures.hpp"
#include "uq/report/page.hpp"
#include "uq/report/plan.hpp"

namespace uq::page {
namespace {

Table candidate_table(const PlanReport& plan) {
  const PlannedParameter& now = asked(plan, plan.candidates.front().parameters);
  Table table{.caption = fmt::format(
                  "Candidates by what they are expected to teach of {} per cost. Its posterior sd is {} now.",
                  plan.about, rounded(now.sd_now, rounding_of(now.sd_now, 0.1 * now.sd_now), now.unit)),
              .columns = {{"Measurement", lengthy},
                          {"Error"},
                          {"Information (nats)", number},
                          {"sd after", number},
                          {"Verdict then", lengthy},
                          {"Readings needed", lengthy},
                          {"Cost", number}}};
  for (const PlanCandidate& one : plan.candidates) {
    const PlannedParameter& about = asked(plan, one.parameters);
    const auto mark = [](bool holds, const char* words) {
      return holds ? " " + tag::span.is("soft")(words) : Markup();
    };
    table.rows.push_back({one.name + mark(one.kind == CandidateKind::repeat, "(measured already)") +
                              mark(one.model_only, "(model only)") + mark(one.no_runs, "(no runs there)") +
                              mark(!one.teaches, "(teaches nothing)"),
                          one.error + (one.assumed_error ? " assumed" : ""),
                          nats(about.information, about.information_error), digits(about.sd_after, 2),
                          words_text(about), readings_text(about), fmt::format("{:g}", one.cost)});
  }
  return table;
}

Markup batch(const PlanBatch& picked) {
  return tag::li(fmt::format("Together, {}: {} nats ({:.2f} when picked one after the other).",
                             fmt::join(picked.candidates, " + "), nats(picked.information, picked.information_error),
                             picked.greedy));
}

Markup training_runs(const PlanReport& plan) {
  if (plan.runs.parameters.empty()) return {};
  const PlannedParameter& exact = asked(plan, plan.runs.parameters);
  return tag::li(
      fmt::format("Training runs instead can at most give {:.2f} nats: with an exact surrogate the sd is {}.",
                  exact.information, digits(exact.sd_after, 2)));
}

}  // namespace

Markup plan_part(const CaseReport& result, const std::string& id, const Context& context) {
  if (!result.plan) return {};
  const PlanReport& plan = *result.plan;
  Markup all = tag::h3("What to measure next") + tag::p(plan.sentence);
  if (plan.candidates.empty()) return all;
  if (const auto information = information_figure(plan, id + "-plan"))
    all += figure(*information,
                  "Information that one reading is expected to give of a parameter, all others integrated out. One nat "
                  "narrows a normal posterior to 37\u00a0% of its width.",
                  context);
  if (const auto arrows = arrow_figure(plan, id + "-arrows"))
    all += figure(*arrows,
                  "How each reading changes when a parameter changes by its prior's standard deviation, in errors of "
                  "one reading. Parallel arrows leave the two parameters traded; crossing ones part them.",
                  context);
  return all + candidate_table(plan) +
         tag::ul.unless_empty(each(plan.batches, batch) + training_runs(plan) + each(plan.notes, tag::li));
}

}  // namespace uq::page
