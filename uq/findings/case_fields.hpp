#pragma once
// Field lists of a case: what holds for its parameters together, then all of it; and the case calibrated again.
#include "uq/findings/headline.hpp"
#include "uq/findings/parameter_fields.hpp"
#include "uq/findings/plan_fields.hpp"
#include "uq/findings/prediction_fields.hpp"
#include "uq/findings/support_fields.hpp"
#include "uq/findings/wording.hpp"

namespace uq {

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
  visit("sharper_factor", m.sharper_factor);
  visit("sentence", m.sentence);
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

/// Visits a parameter as its case shows it: a case that does not fit overrules the parameter's own verdict.
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

}  // namespace uq
