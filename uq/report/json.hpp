#pragma once
// report.json, format 1: the result for programs. Keys are only ever added; an open end, a NaN or an infinity is null.
#include <nlohmann/json.hpp>
#include <string>

#include "uq/findings/results.hpp"

namespace uq {

nlohmann::ordered_json report_json(const CalibrationReport& report);

/// The plans of the cases that have one: {"case", "about", "sentence", "candidates": [...], ...}.
nlohmann::ordered_json plans_json(const std::vector<CaseReport>& cases);

/// Throws data::InputError (73).
void write_report_json(const CalibrationReport& report, const std::string& path);

}  // namespace uq
