#pragma once
// report.json: everything that a calibration found. Programs read it, and `demcal report` makes the page of it again
// without sampling.
//
// The keys are those of fields.hpp; between versions of format 1 they are only ever added. Doubles have as many digits
// as give them back to the last bit. An open end and a NaN are null, and a null number comes back as NaN; an infinity
// is the text "infinity" or "-infinity".
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "uq/findings/results.hpp"

namespace uq {

/// The format of the keys, for programs.
constexpr int report_format = 1;
/// The edition of the list of fields. A page is made again only from a report of this edition: another one lacks part
/// of it.
constexpr int report_edition = 7;

/// "format", "edition" and the fields of a report.
nlohmann::ordered_json report_json(const CalibrationReport& report);

/// The plans of the cases that have one: {"case", "about", "sentence", "candidates": [...], ...}.
nlohmann::ordered_json plans_json(const std::vector<CaseReport>& cases);

/// JSON as a file for people too: indented, a list of plain values on one line. Bytes that are no UTF-8 (of a comment
/// in a Latin-1 file) are replaced.
std::string text_of(const nlohmann::ordered_json& json);

/// Writes report.json. Throws data::InputError (73).
void save_report(const CalibrationReport& report, const std::string& path);

/// Reads report.json. A field that the file lacks keeps its default. Throws data::InputError: 66 no such file; 65 not a
/// report, one of a demcal that did not keep all of it, or a damaged one, with the place.
CalibrationReport load_report(const std::string& path);

/// Writes one surrogate's part alone as text, and reads it back; `place` is where the text was found.
std::string to_text(const SurrogateReport& report);
SurrogateReport surrogate_report_from(const std::string& text, const std::string& place);

}  // namespace uq
