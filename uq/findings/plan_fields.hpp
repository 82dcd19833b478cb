#pragma once
// Field lists of a plan: what to measure next.
#include "uq/findings/field_list.hpp"
#include "uq/findings/plan_results.hpp"

namespace uq {

template <class Visit, SameAs<PlannedParameter> T>
void visit_fields(Visit&& visit, T& p) {
  visit("name", p.name);
  visit("unit", p.unit);
  visit("information", p.information);
  visit("information_error", p.information_error);
  visit("sd_now", p.sd_now);
  visit("sd_after", p.sd_after);
  visit("words", p.words);
  visit("repeats_needed", p.repeats_needed);
  visit("repeats_low", p.repeats_low);
  visit("repeats_high", p.repeats_high);
  visit("floor", p.floor);
}

template <class Visit, SameAs<PlanLevel> T>
void visit_fields(Visit&& visit, T& l) {
  visit("material", l.material);
  visit("difference", l.difference);
  visit("doubt", l.doubt);
}

template <class Visit, SameAs<PlanCandidate> T>
void visit_fields(Visit&& visit, T& c) {
  visit("name", c.name);
  visit("kind", c.kind);
  visit("material", c.material);
  visit("outputs", c.outputs);
  visit("settings", c.settings);
  visit("cost", c.cost);
  visit("model_only", c.model_only);
  visit("no_runs", c.no_runs);
  visit("levels", c.levels);
  visit("assumed_error", c.assumed_error);
  visit("error", c.error);
  visit("information", c.information);
  visit("information_error", c.information_error);
  visit("parameters", c.parameters);
  visit("teaches", c.teaches);
}

template <class Visit, SameAs<PlanBatch> T>
void visit_fields(Visit&& visit, T& b) {
  visit("candidates", b.candidates);
  visit("information", b.information);
  visit("information_error", b.information_error);
  visit("greedy", b.greedy);
  visit("sd_after", b.sd_after);
  visit("cost", b.cost);
}

template <class Visit, SameAs<PlannedRuns> T>
void visit_fields(Visit&& visit, T& r) {
  visit("points", r.points);
  visit("seconds", r.seconds);
  visit("variance_before", r.variance_before);
  visit("variance_after", r.variance_after);
  visit("parameters", r.parameters);
}

template <class Visit, SameAs<PlanArrow> T>
void visit_fields(Visit&& visit, T& a) {
  visit("output", a.output);
  visit("parameter", a.parameter);
  visit("setting", a.setting);
  visit("change", a.change);
}

template <class Visit, SameAs<PlanReport> T>
void visit_fields(Visit&& visit, T& p) {
  visit("about", p.about);
  visit("prior", p.prior);
  visit("sentence", p.sentence);
  visit("cost_unit", p.cost_unit);
  visit("control_units", p.control_units);
  visit("budget", p.budget);
  visit("candidates", p.candidates);
  visit("batches", p.batches);
  visit("runs", p.runs);
  visit("arrows", p.arrows);
  visit("notes", p.notes);
}

}  // namespace uq
