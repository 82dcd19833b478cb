#pragma once
// Field lists of one parameter, or of one unknown of the measurement: its draws, its interval and its verdict.
#include "uq/findings/field_list.hpp"
#include "uq/findings/parameter_results.hpp"

namespace uq {

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

template <class Visit, SameAs<CommonError> T>
void visit_fields(Visit&& visit, T& e) {
  visit("kind", e.kind);
  visit.text("name", e.name);
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
  visit.table("runs_end", [&](auto& end) {
    end("low", p.runs_end_low);
    end("high", p.runs_end_high);
  });
  visit.keyed("word_probabilities", p.word_probabilities, &WordProbability::verdict, &WordProbability::probability);
  visit.table("width_shares", [&](auto& share) {
    share("measurement", p.shares.measurement);
    share("surrogate", p.shares.surrogate);
    share("structure", p.shares.structure);
    share("range", p.shares.range);
  });
  visit.table("common_errors", [&](auto& common) {
    common("share", p.common.share);
    common("errors", p.common.errors);
  });
  visit.table("profile", [&](auto& profile) {
    profile("x", p.profile_x);
    profile("deviance", p.profile_deviance);
    profile("drop", p.profile_drop);
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

}  // namespace uq
