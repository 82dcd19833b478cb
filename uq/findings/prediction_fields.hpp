#pragma once
// Field lists of a posterior's predictions, beside what was measured or simulated there.
#include "uq/findings/field_list.hpp"
#include "uq/findings/prediction_results.hpp"

namespace uq {

template <class Visit, SameAs<PredictivePoint> T>
void visit_fields(Visit&& visit, T& p) {
  visit("controls", p.controls);
  visit("output", p.output);
  visit("unit", p.unit);
  visit("mean", p.mean);
  visit("q05", p.q05);
  visit("q95", p.q95);
  visit("observed", p.observed);
  visit("standard_error", p.standard_error);
  visit("observation_set", p.observation_set);
}

template <class Visit, SameAs<PredictiveCurve> T>
void visit_fields(Visit&& visit, T& c) {
  visit("output", c.output);
  visit("unit", c.unit);
  visit("control", c.control);
  visit("control_unit", c.control_unit);
  visit("observation_set", c.observation_set);
  visit("x", c.x);
  visit("mean", c.mean);
  visit("q05", c.q05);
  visit("q95", c.q95);
}

template <class Visit, SameAs<DiscrepancyBand> T>
void visit_fields(Visit&& visit, T& d) {
  visit("output", d.output);
  visit("unit", d.unit);
  visit("control", d.control);
  visit("control_unit", d.control_unit);
  visit("observation_set", d.observation_set);
  visit("share", d.share);
  visit("x", d.x);
  visit("mean", d.mean);
  visit("q05", d.q05);
  visit("q95", d.q95);
}

template <class Visit, SameAs<PredictedPoint> T>
void visit_fields(Visit&& visit, T& p) {
  visit_fields(visit, p.point);
  visit("z", p.z);
}

template <class Visit, SameAs<PredictionReport> T>
void visit_fields(Visit&& visit, T& p) {
  visit("name", p.name);
  visit("observe", p.observed_sets);
  visit("inside90", p.inside);
  visit("unsupported", p.unsupported);
  visit("chi2", p.chi2);
  visit("p", p.p);
  visit("predicts", p.predicts);
  visit("sentence", p.sentence);
  visit("points", p.points);
}

template <class Visit, SameAs<VerifiedValue> T>
void visit_fields(Visit&& visit, T& v) {
  visit("inputs", v.inputs);
  visit("material", v.material);
  visit("output", v.output);
  visit("unit", v.unit);
  visit("point", v.label);
  visit("surrogate", v.predicted);
  visit("surrogate_sd", v.predicted_sd);
  visit("simulated", v.simulated);
  visit("standard_error", v.standard_error);
  visit("z", v.z);
}

template <class Visit, SameAs<VerificationReport> T>
void visit_fields(Visit&& visit, T& v) {
  visit("runs", v.runs);
  visit("points", v.points);
  visit("chi2", v.chi2);
  visit("dof", v.dof);
  visit("p", v.p);
  visit("z_limit", v.z_limit);
  visit("agrees", v.agrees);
  visit("sentence", v.sentence);
  visit("values", v.values);
}

}  // namespace uq
