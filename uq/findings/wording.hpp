#pragma once
// How the report writes numbers, names and verdicts, in the page and on the terminal.
//
// A value is rounded to its error: the error to two significant digits, the value and its intervals to the same
// decimal. Beyond 1e-2 .. 1e5, and where the error is a thousand and more, a common power of ten is taken out:
// (9.0 +- 0.4) x 10^-18 J.
#include <string>
#include <string_view>
#include <vector>

#include "uq/findings/results.hpp"

namespace uq {

/// Where a number ends up: a terminal in any locale, or a UTF-8 page (with a true minus, the plus-minus sign,
/// superscripts).
enum class Typography { ascii, unicode };

/// The decimal that a value and its error share, and the power of ten taken out of both.
struct Rounding {
  int exponent = 0;
  int decimals = 3;
};
Rounding rounding_of(double value, double error);

/// One number, or a number and its error, or an interval, with its unit; "not available" for NaN.
std::string format_value(double value, const Rounding& rounding, std::string_view unit, Typography typography);
std::string format_with_error(double value, double error, std::string_view unit, Typography typography);
std::string format_interval(double low, double high, const Rounding& rounding, std::string_view unit,
                            Typography typography);

/// A parameter's posterior: "0.402 +- 0.021". Where separate values fit, each with its share:
/// "0.300 +- 0.012 (45 %) or 0.600 +- 0.020 (55 %)".
std::string format_estimate(const ParameterReport& parameter, Typography typography);

/// "62 % identified, 38 % weakly identified": what the word would be over repeats of the measurement.
std::string format_words(const ParameterReport& parameter);

/// "not identified (practical), borderline".
std::string format_verdict(Verdict verdict, const std::optional<Reason>& reason, bool borderline);

/// The 95 % profile-likelihood interval in words: "0.35 to 0.45", "0.28 to 0.31 and 0.57 to 0.62", "up to 0.5; open
/// below", "open on both sides". Where another parameter's range ends it, its numbers stand, and that is said.
std::string format_profile_interval(const ParameterReport& parameter, Typography typography);

/// A number to so many significant digits, with a power of ten where the decimals would be unreadable.
std::string significant(double value, int digits, Typography typography);

/// "name (unit)" for a heading or an axis; the name alone when there is no unit or the name is the unit ("rpm").
std::string name_in_unit(std::string_view name, std::string_view unit);

/// A file name or HTML id made of a-z, 0-9 and '-' from any text.
std::string slug(std::string_view text);

/// A parameter's verdict as shown: nothing in a case that does not fit is called identified, whatever it says of
/// itself.
Verdict shown_verdict(const CaseReport& result, const ParameterReport& parameter);

/// A parameter's sentence as shown; one that contradicts shown_verdict is left out.
std::string shown_sentence(const CaseReport& result, const ParameterReport& parameter);

/// A parameter's value as shown: in brackets where no verdict can rest on it, and not at all where the surrogate is
/// unusable.
std::string shown_value(const CaseReport& result, const ParameterReport& parameter, Typography typography);

/// "Without runs.csv:31: friction ..."; empty where no run is contradicted.
std::string without_sentence(const CaseReport& result);

/// The version of demcal that made the results, from their provenance; "unknown" where it does not say.
std::string program_version(const CalibrationReport& report);

/// The name in the provenance under which stands what the command line set beside the study's file.
inline constexpr const char* set_on_command_line = "set on the command line";
/// "training.runs=80; study.seed=3", from the provenance; empty where nothing was set.
std::string changes_of(const CalibrationReport& report);

/// What must stand in the report's first lines: the warnings of the whole and of each case, each of them once.
std::vector<std::string> first_lines(const CalibrationReport& report);

/// Whether the program must leave with status 2 and the report says "warning".
bool has_warning(const CalibrationReport& report);

}  // namespace uq
