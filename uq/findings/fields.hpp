#pragma once
// The fields of a calibration, and by its includes those of all that it holds. A field added to a struct is added to
// its list, in the file of that name (field_list.hpp says how); a test compares the sizes.
#include "uq/findings/case_fields.hpp"
#include "uq/findings/surrogate_fields.hpp"
#include "uq/findings/wording.hpp"

namespace uq {

template <class Visit, SameAs<data::Finding> T>
void visit_fields(Visit&& visit, T& f) {
  visit("kind", f.kind);
  visit("place", f.place);
  visit("severity", f.severity);
  visit("what", f.what);
  visit("remedy", f.remedy);
  visit("places", f.places);
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
