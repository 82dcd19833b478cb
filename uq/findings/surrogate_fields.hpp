#pragma once
// Field lists of the runs and what was learnt from them: designs, surrogates, the runs that the others contradict.
#include "uq/findings/field_list.hpp"
#include "uq/findings/surrogate_results.hpp"

namespace uq {

template <class Visit, SameAs<OutlyingRun> T>
void visit_fields(Visit&& visit, T& o) {
  visit("place", o.place);
  visit("observed", o.observed);
  visit("expected", o.expected);
  visit("deviations", o.deviations);
}

template <class Visit, SameAs<SurrogateReport> T>
void visit_fields(Visit&& visit, T& s) {
  visit("output", s.output);
  visit("material", s.material);
  visit("q2", s.q2);
  visit("coverage95", s.coverage95);
  visit("runs", s.runs);
  visit("verdict", s.verdict);
  visit("q2_held_out", s.q2_held_out);
  visit("nugget_sd", s.nugget_sd);
  visit("unit", s.unit);
  visit("inputs", s.inputs);
  visit("stretches", s.stretches);
  visit("length_scales", s.length_scales);
  visit.table("sobol", [&](auto& sobol) {
    sobol("first", s.first_order);
    sobol("first_sd", s.first_order_sd);
    sobol("total", s.total_order);
    sobol("total_sd", s.total_order_sd);
  });
  visit.table("coverage", [&](auto& coverage) {
    coverage("left_out", s.coverage_left_out);
    coverage("held_out", s.coverage_held_out);
  });
  visit.table("folds", [&](auto& folds) {
    folds("mahalanobis", s.fold_distance);
    folds("runs", s.fold_runs);
    folds("probability", s.fold_probability);
    folds("pivoted_cholesky_errors", s.pivoted_errors);
  });
  visit("observed", s.observed);
  visit("observed_se", s.observed_se);
  visit("predicted", s.predicted);
  visit("standardised_errors", s.standardised);
  visit("finding", s.finding);
  visit("consequence", s.consequence);
  visit("remedy", s.remedy);
  visit("notes", s.notes);
  visit("errors_in_doubt", s.errors_in_doubt);
  visit("converged", s.converged);
  visit("low_runs", s.low_runs);
  visit("rho", s.rho);
  visit("rho_sd", s.rho_sd);
  visit("outlying_runs", s.outlying);
  visit("outlying_together", s.outlying_together);
}

template <class Visit, SameAs<DesignReport> T>
void visit_fields(Visit&& visit, T& d) {
  visit("material", d.material);
  visit("inputs", d.inputs);
  visit("units", d.units);
  visit("runs", d.runs);
  visit("left_out", d.left_out);
  visit("reasons", d.reasons);
}

}  // namespace uq
