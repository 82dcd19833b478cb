#pragma once
// The fields of the findings, each with its key in report.json: the one list by which they are written and read.
// A field added to results.hpp is added here; a test compares the sizes.
//
// visit_fields(visit, finding) calls the visitor once for each field, in the order of the file:
//   visit("key", field)                               a number, text, list, map or struct
//   visit.text("key", field)                          a text, null where it is empty
//   visit.table("key", [&](auto& inner) {...})        fields under a key of their own
//   visit.pair("key", low, high)                      two fields as a list
//   visit.range("key", low, high)                     two numbers as a list, null where they are equal
//   visit.each("key", list, [&](auto& inner, auto& item) {...})   a list whose items are visited so
//   visit.columns(list, column...)                    a list of structs as lists of equal length, each with its key
//   visit.keyed("key", list, &T::name, &T::value)     a list of structs of two fields as a table
//   visit.gathered("key", list, "name", &T::name, &T::field)   an optional field of listed structs, each with its name
//   visit.shown("key", [&] { return ...; })           what follows from other fields: written for readers, never read
#include <type_traits>

#include "uq/findings/headline.hpp"
#include "uq/findings/results.hpp"
#include "uq/findings/wording.hpp"

namespace uq {

template <class T, class S>
concept SameAs = std::is_same_v<std::remove_const_t<T>, S>;

/// One field of each struct of a list, and its key.
template <class Struct, class Field>
struct FieldColumn {
  const char* key;
  Field Struct::*field;
};
template <class Struct, class Field>
FieldColumn(const char*, Field Struct::*) -> FieldColumn<Struct, Field>;

template <class Visit, SameAs<data::Finding> T>
void visit_fields(Visit&& visit, T& f) {
  visit("kind", f.kind);
  visit("place", f.place);
  visit("severity", f.severity);
  visit("what", f.what);
  visit("remedy", f.remedy);
  visit("places", f.places);
}

template <class Visit, SameAs<OutlyingRun> T>
void visit_fields(Visit&& visit, T& o) {
  visit("place", o.place);
  visit("observed", o.observed);
  visit("expected", o.expected);
  visit("deviations", o.deviations);
}

template <class Visit, SameAs<InputSupport> T>
void visit_fields(Visit&& visit, T& i) {
  visit("name", i.name);
  visit("unit", i.unit);
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

template <class Visit, SameAs<WithoutRuns> T>
void visit_fields(Visit&& visit, T& w) {
  visit("places", w.places);
  visit.columns(w.parameters, FieldColumn{"parameters", &ParameterAgain::name},
                FieldColumn{"verdicts", &ParameterAgain::verdict}, FieldColumn{"reasons", &ParameterAgain::reason},
                FieldColumn{"borderline", &ParameterAgain::borderline}, FieldColumn{"mean", &ParameterAgain::mean},
                FieldColumn{"sd", &ParameterAgain::sd});
  visit("fits", w.fits);
  visit("sentence", w.sentence);
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

template <class Visit, SameAs<ValueRange> T>
void visit_fields(Visit&& visit, T& v) {
  visit("low", v.low);
  visit("high", v.high);
  visit("low_open", v.low_open);
  visit("high_open", v.high_open);
  visit("weight", v.weight);
  visit("mean", v.mean);
  visit("sd", v.sd);
}

template <class Visit, SameAs<ProfileHole> T>
void visit_fields(Visit&& visit, T& h) {
  visit("low", h.low);
  visit("high", h.high);
  visit("deviance", h.deviance);
  visit("within_surrogate_error", h.in_doubt);
}

template <class Visit, SameAs<WordProbability> T>
void visit_fields(Visit&& visit, T& w) {
  visit("verdict", w.verdict);
  visit("probability", w.probability);
}

template <class Visit, SameAs<ParameterReport> T>
void visit_fields(Visit&& visit, T& p) {
  visit("name", p.name);
  visit("unit", p.unit);
  visit("mean", p.mean);
  visit("sd", p.sd);
  visit("q05", p.q05);
  visit("q50", p.q50);
  visit("q95", p.q95);
  visit("rhat", p.rhat);
  visit("ess_bulk", p.ess_bulk);
  visit("ess_tail", p.ess_tail);
  visit("contraction", p.contraction);
  visit.pair("profile95", p.profile_low, p.profile_high);
  visit("verdict", p.verdict);
  visit("reason", p.reason);
  visit("borderline", p.borderline);
  visit("mcse", p.mcse);
  visit("map", p.map);
  visit.table("prior", [&](auto& prior) {
    prior("low", p.prior_low);
    prior("high", p.prior_high);
    prior("mean", p.prior_mean);
    prior("sd", p.prior_sd);
  });
  visit("sentence", p.sentence);
  visit("intervals", p.intervals);
  visit("holes", p.holes);
  visit.table("open_for_range_of", [&](auto& pinned) {
    pinned.text("low", p.low_pinned_by);
    pinned.text("high", p.high_pinned_by);
  });
  visit.keyed("word_probabilities", p.word_probabilities, &WordProbability::verdict, &WordProbability::probability);
  visit.table("width_shares", [&](auto& share) {
    share("measurement", p.share_measurement);
    share("surrogate", p.share_surrogate);
    share("structure", p.share_structure);
    share("range", p.share_range);
  });
  visit.table("profile", [&](auto& profile) {
    profile("x", p.profile_x);
    profile("deviance", p.profile_deviance);
    profile.pair("ends_at_the_range", p.low_is_bound, p.high_is_bound);
  });
}

template <class Visit, SameAs<NuisanceReport> T>
void visit_fields(Visit&& visit, T& n) {
  visit("name", n.name);
  visit("unit", n.unit);
  visit("mean", n.mean);
  visit("sd", n.sd);
  visit("q05", n.q05);
  visit("q50", n.q50);
  visit("q95", n.q95);
  visit("rhat", n.rhat);
  visit("ess_bulk", n.ess_bulk);
  visit("ess_tail", n.ess_tail);
  visit.table("prior", [&](auto& prior) {
    prior("mean", n.prior_mean);
    prior("sd", n.prior_sd);
  });
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

template <class Visit, SameAs<TradedPair> T>
void visit_fields(Visit&& visit, T& t) {
  visit.pair("pair", t.first, t.second);
  visit("parameters", t.parameters);
  visit("combination", t.combination);
  visit("form", t.form);
  visit("value", t.value);
  visit("error", t.error);
  visit("unit", t.unit);
  visit("statement", t.statement);
  visit("correlation", t.correlation);
  visit("equivalent", t.equivalent);
  visit("equivalent_u", t.equivalent_u);
  visit("equivalent_curves", t.curves);
}

template <class Visit, SameAs<ModeReport> T>
void visit_fields(Visit&& visit, T& m) {
  visit("weight", m.weight);
  visit("mean", m.mean);
  visit("sd", m.sd);
}

template <class Visit, SameAs<ModelComparison> T>
void visit_fields(Visit&& visit, T& m) {
  visit("held", m.held);
  visit("log_bayes_factor", m.log_bayes_factor);
  visit("error", m.error);
  visit("sampling_error", m.sampling_error);
  visit("surrogate_error", m.surrogate_error);
  visit("sentence", m.sentence);
}

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
  visit("chi2", p.chi2);
  visit("p", p.p);
  visit("predicts", p.predicts);
  visit("sentence", p.sentence);
  visit("points", p.points);
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

template <class Visit, SameAs<PlanCandidate> T>
void visit_fields(Visit&& visit, T& c) {
  visit("name", c.name);
  visit("kind", c.kind);
  visit("material", c.material);
  visit("outputs", c.outputs);
  visit("settings", c.settings);
  visit("cost", c.cost);
  visit("model_only", c.model_only);
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
  visit("budget", p.budget);
  visit("candidates", p.candidates);
  visit("batches", p.batches);
  visit("runs", p.runs);
  visit("arrows", p.arrows);
  visit("notes", p.notes);
}

/// A parameter as its case shows it: one that does not fit overrules the parameter's own word.
template <class Visit, SameAs<ParameterReport> T>
void visit_shown(Visit&& visit, const CaseReport& of, T& p) {
  visit_fields(visit, p);
  visit.shown("verdict", [&] { return shown_verdict(of, p); });
  visit.shown("reason", [&] { return shown_verdict(of, p) == p.verdict ? p.reason : std::optional<Reason>(); });
  visit.shown("sentence", [&] { return shown_sentence(of, p); });
  visit.shown("usable", [&] { return of.doubt.empty() && of.fits; });
}

template <class Visit, SameAs<CaseReport> T>
void visit_fields(Visit&& visit, T& c) {
  visit("name", c.name);
  visit.shown("headline", [&] { return headline(c, Typography::ascii); });
  visit.table("fit", [&](auto& fit) {
    fit("chi2", c.chi2);
    fit("dof", c.dof);
    fit("ppp", c.ppp);
    fit("fits", c.fits);
  });
  visit.each("parameters", c.parameters, [&](auto& one, auto& parameter) { visit_shown(one, c, parameter); });
  visit("correlation", c.correlation);
  visit("log_evidence", c.log_evidence);
  visit("log_evidence_error", c.log_evidence_error);
  visit("comparisons", c.comparisons);
  visit("divergences", c.divergences);
  visit("traded", c.traded);
  visit("predictive", c.predictive);
  visit("finding", c.finding);
  visit("consequence", c.consequence);
  visit("remedy", c.remedy);
  visit("converged", c.converged);
  visit("chains", c.chains);
  visit("draws", c.draws);
  visit("grid_difference", c.grid_difference);
  visit("fisher_condition", c.fisher_condition);
  visit("collinearity", c.collinearity);
  visit("observed_sets", c.observed_sets);
  visit("observed_notes", c.observed_notes);
  visit("linked", c.linked);
  visit("warnings", c.warnings);
  visit("nuisances", c.nuisances);
  visit("discrepancies", c.discrepancies);
  visit("cuts", c.cuts);
  visit("sampler", c.sampler);
  visit("search", c.search);
  visit("energy_fraction", c.energy_fraction);
  visit("support", c.support);
  visit("without", c.without);
  visit.text("doubt", c.doubt);
  visit.text("lone_reading", c.lone_reading);
  visit("unusable", c.unusable);
  visit("surrogate_to_measurement", c.surrogate_to_measurement);
  visit("modes", c.modes);
  visit("modes_parted_by", c.modes_parted_by);
  visit("predictions", c.predictions);
  visit("verification", c.verification);
  visit("curves", c.curves);
  visit("plotted_draws", c.draws_for_plot);
}

template <class Visit, SameAs<ErrorScan> T>
void visit_fields(Visit&& visit, T& e) {
  visit("case", e.case_name);
  visit("relative_error", e.relative_error);
  visit.columns(e.parameters, FieldColumn{"parameters", &ParameterAgain::name},
                FieldColumn{"words", &ParameterAgain::verdict}, FieldColumn{"reasons", &ParameterAgain::reason},
                FieldColumn{"borderline", &ParameterAgain::borderline}, FieldColumn{"mean", &ParameterAgain::mean},
                FieldColumn{"sd", &ParameterAgain::sd});
  visit.shown("verdicts", [&] {
    std::vector<std::string> said;
    for (const ParameterAgain& one : e.parameters)
      said.push_back(format_verdict(one.verdict, one.reason, one.borderline));
    return said;
  });
  visit("ppp", e.ppp);
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

template <class Visit, SameAs<CalibrationReport> T>
void visit_fields(Visit&& visit, T& r) {
  visit.shown("demcal", [&] { return program_version(r); });
  visit.shown("status", [&] { return std::string(has_warning(r) ? "warning" : "ok"); });
  visit("study", r.study_name);
  visit("study_description", r.study_description);
  visit("study_file", r.study_file);
  visit.shown("warnings", [&] { return first_lines(r); });
  visit("cautions", r.cautions);
  visit("surrogates", r.surrogates);
  visit("cases", r.cases);
  visit.gathered("plan", r.cases, "case", &CaseReport::name, &CaseReport::plan);
  visit("error_scan", r.error_scan);
  visit("thresholds", r.thresholds);
  visit("provenance", r.provenance);
  visit("notes", r.notes);
  visit("findings", r.findings);
  visit("designs", r.designs);
  visit.table("of_no_case", [&](auto& whole) {  // of the warnings above
    whole("warning", r.warning);
    whole("warnings", r.warnings);
  });
}

}  // namespace uq
