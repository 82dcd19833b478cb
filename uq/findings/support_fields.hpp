#pragma once
// Field lists of the runs' support: the posterior beside the runs, and the points to run next.
#include "uq/findings/field_list.hpp"
#include "uq/findings/support_results.hpp"

namespace uq {

template <class Visit, SameAs<InputSupport> T>
void visit_fields(Visit&& visit, T& i) {
  visit("name", i.name);
  visit("unit", i.unit);
  visit("material", i.material);
  visit.pair("runs", i.runs_low, i.runs_high);
  visit("outside", i.outside);
  visit("gap", i.gap);
  visit.range("gap_between", i.gap_low, i.gap_high);
}

template <class Visit, SameAs<NextRun> T>
void visit_fields(Visit&& visit, T& n) {
  visit("material", n.material);
  visit("point", n.point);
}

template <class Visit, SameAs<SupportReport> T>
void visit_fields(Visit&& visit, T& s) {
  visit("known", s.known);
  visit("supported", s.supported);
  visit("unsupported", s.unsupported);
  visit("outside", s.outside);
  visit("gap", s.gap);
  visit("empty", s.empty);
  visit("uncertain", s.uncertain);
  visit("distance", s.distance);
  visit("variance_ratio", s.variance_ratio);
  visit("inputs", s.inputs);
  visit("sentence", s.sentence);
  visit("next_runs", s.next_runs);
}

}  // namespace uq
