#pragma once
// results.json: every field of a CalibrationReport, to the last bit, so that `demcal report` writes the page again
// without sampling. Private to demcal; what programs read is report.json.
//
// Each struct is described once, by visit_fields, for saving and loading alike. NaN and infinities, which JSON does not
// have, are the texts "nan", "inf" and "-inf"; other doubles are written with as many digits as give them back.
#include <string>

#include "uq/findings/results.hpp"

namespace uq {

/// Throws data::InputError (73).
void save_results(const CalibrationReport& report, const std::string& path);

/// A field that the file lacks keeps its default (an older demcal wrote it). Throws data::InputError: 66 no such file,
/// 65 not a results file, or damaged, with the place.
CalibrationReport load_results(const std::string& path);

/// A plan alone, as text of JSON.
std::string to_text(const PlanReport& plan);

/// One surrogate's part alone, as text, and back; `place` is where the text was found.
std::string to_text(const SurrogateReport& report);
SurrogateReport surrogate_report_from(const std::string& text, const std::string& place);

}  // namespace uq
