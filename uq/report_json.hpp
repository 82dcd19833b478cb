#pragma once
// report.json, format 1: the result for programs. Keys are only ever added; an open end, a NaN or an infinity is null.
#include <nlohmann/json.hpp>
#include <string>

#include "uq/results.hpp"

namespace uq {

nlohmann::ordered_json report_json(const CalibrationReport& report);

/// Throws data::InputError (73).
void write_report_json(const CalibrationReport& report, const std::string& path);

}  // namespace uq
