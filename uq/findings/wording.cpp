#include "uq/findings/wording.hpp"
#include "uq/findings/study_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace uq {
namespace {

constexpr double smallest_plain = 1e-2;
constexpr double largest_plain = 1e5;

int decade(double value) { return static_cast<int>(std::floor(std::log10(std::abs(value)))); }

std::string superscript(int exponent) {
  static const char* const digits[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                       "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = exponent < 0 ? "\u207b" : "";
  for (const char digit : std::to_string(std::abs(exponent))) text += digits[digit - '0'];
  return text;
}

/// The mantissa at the rounding's decimal; never "-0.0".
std::string mantissa(double value, const Rounding& rounding, Typography typography) {
  if (std::isnan(value)) return "not available";
  const bool unicode = typography == Typography::unicode;
  if (std::isinf(value)) return value > 0 ? (unicode ? "\u221e" : "inf") : (unicode ? "\u2212\u221e" : "-inf");
  // Dividing by 10^-e, not multiplying by 10^e: powers of ten are exact only upwards.
  const double scaled =
      rounding.exponent >= 0 ? value / std::pow(10.0, rounding.exponent) : value * std::pow(10.0, -rounding.exponent);
  std::string text = fmt::format("{:.{}f}", scaled, rounding.decimals);
  const bool negative = text.front() == '-';
  if (!negative) return text;
  text.erase(0, 1);
  if (text.find_first_of("123456789") == std::string::npos) return text;
  return (unicode ? "\u2212" : "-") + text;
}

/// Adds the power of ten, with brackets where `body` is more than one number, and the unit.
std::string dress(std::string body, const Rounding& rounding, std::string_view unit, Typography typography,
                  bool several) {
  const bool bare = is_bare(unit);
  if (rounding.exponent != 0 || (several && !bare)) {
    if (several) body = "(" + body + ")";
  }
  if (rounding.exponent != 0) {
    body += typography == Typography::unicode ? "\u00a0\u00d7\u00a010" + superscript(rounding.exponent)
                                              : fmt::format("e{}", rounding.exponent);
  }
  if (!bare) body += (typography == Typography::unicode ? "\u00a0" : " ") + std::string(unit);
  return body;
}

}  // namespace

Rounding rounding_of(double value, double error) {
  const bool has_error = std::isfinite(error) && error != 0.0;
  const bool has_value = std::isfinite(value) && value != 0.0;
  if (!has_error && !has_value) return {.exponent = 0, .decimals = 0};
  const double largest = std::max(has_value ? std::abs(value) : 0.0, has_error ? std::abs(error) : 0.0);
  const bool plain = largest >= smallest_plain && largest < largest_plain;
  const int last = has_error ? decade(error) - 1 : decade(value) - 3;
  // Digits that the error leaves unknown are not shown: 34,313 +- 11,191 is (3.4 +- 1.1)e4.
  Rounding rounding{.exponent = plain && last < 2 ? 0 : decade(largest), .decimals = 0};
  rounding.decimals = std::clamp(rounding.exponent - last, 0, 9);
  return rounding;
}

std::string format_value(double value, const Rounding& rounding, std::string_view unit, Typography typography) {
  if (std::isnan(value)) return "not available";
  return dress(mantissa(value, rounding, typography), rounding, unit, typography, false);
}

std::string format_with_error(double value, double error, std::string_view unit, Typography typography) {
  if (std::isnan(value)) return "not available";
  const Rounding rounding = rounding_of(value, error);
  if (!std::isfinite(error)) return format_value(value, rounding, unit, typography);
  const char* const sign = typography == Typography::unicode ? "\u00a0\u00b1\u00a0" : " +- ";
  return dress(mantissa(value, rounding, typography) + sign + mantissa(error, rounding, typography), rounding, unit,
               typography, true);
}

std::string format_interval(double low, double high, const Rounding& rounding, std::string_view unit,
                            Typography typography) {
  if (std::isnan(low) && std::isnan(high)) return "not available";
  const std::string body = mantissa(low, rounding, typography) + " to " + mantissa(high, rounding, typography);
  if (rounding.exponent == 0) {
    const bool bare = is_bare(unit);
    return bare ? body : body + (typography == Typography::unicode ? "\u00a0" : " ") + std::string(unit);
  }
  return dress(body, rounding, unit, typography, true);
}

std::string format_estimate(const ParameterReport& parameter, Typography typography) {
  if (parameter.verdict != Verdict::several_values || parameter.intervals.size() < 2)
    return format_with_error(parameter.mean, parameter.sd, parameter.unit, typography);
  std::string text;
  for (const ValueRange& part : parameter.intervals)
    text += fmt::format("{}{} ({:.0f}{}%)", text.empty() ? "" : " or ",
                        format_with_error(part.mean, part.sd, parameter.unit, typography), 100.0 * part.weight,
                        typography == Typography::unicode ? "\u00a0" : " ");
  return text;
}

std::string format_verdict(Verdict verdict, const std::optional<Reason>& reason, bool borderline) {
  std::string text = to_text(verdict);
  if (reason) text += fmt::format(" ({})", to_text(*reason));
  if (borderline) text += ", borderline";
  return text;
}

std::string format_words(const ParameterReport& parameter) {
  std::string text;
  for (const WordProbability& word : parameter.word_probabilities)
    if (word.probability >= 0.005)
      text += fmt::format("{}{:.0f} % {}", text.empty() ? "" : ", ", 100.0 * word.probability, to_text(word.verdict));
  return text;
}

namespace {

/// An interval in parts, or one that another parameter's range ends.
std::string format_parts(const ParameterReport& parameter, Typography typography) {
  double sd = std::numeric_limits<double>::infinity();
  for (const ValueRange& part : parameter.intervals)
    if (part.sd > 0.0) sd = std::min(sd, part.sd);
  const Rounding rounding = rounding_of(parameter.mean, std::isfinite(sd) ? sd : parameter.sd);
  std::string text, open;
  for (const ValueRange& part : parameter.intervals)
    text += (text.empty() ? "" : " and ") + format_interval(part.low, part.high, rounding, parameter.unit, typography);
  const auto side = [&](bool is_open, const std::string& by, bool runs_end, const char* name) {
    if (!is_open) return;
    const std::string ends = by.empty() ? "its range ends" : "the range of " + by + " ends";
    open += fmt::format("; {}: {} first", name, runs_end ? "the runs end" : ends);
  };
  side(parameter.intervals.front().low_open, parameter.low_pinned_by, parameter.runs_end_low.has_value(), "open below");
  side(parameter.intervals.back().high_open, parameter.high_pinned_by, parameter.runs_end_high.has_value(),
       "open above");
  return text + open;
}

}  // namespace

std::string format_profile_interval(const ParameterReport& parameter, Typography typography) {
  const bool pinned = !parameter.low_pinned_by.empty() || !parameter.high_pinned_by.empty();
  if (parameter.intervals.size() > 1 || (pinned && !parameter.intervals.empty()))
    return format_parts(parameter, typography);
  const Rounding rounding = rounding_of(parameter.mean, parameter.sd);
  const auto& low = parameter.profile_low;
  const auto& high = parameter.profile_high;
  if (low && high) return format_interval(*low, *high, rounding, parameter.unit, typography);
  const auto open = [&](bool is_bound, const std::optional<double>& runs_end, const char* side) {
    if (runs_end)
      return fmt::format("open {} (the runs end first, at {})", side,
                         format_value(*runs_end, rounding, parameter.unit, typography));
    return std::string("open ") + side + (is_bound ? " (range ends first)" : "");
  };
  if (high) {
    return "up to " + format_value(*high, rounding, parameter.unit, typography) + "; " +
           open(parameter.low_is_bound, parameter.runs_end_low, "below");
  }
  if (low) {
    return "from " + format_value(*low, rounding, parameter.unit, typography) + "; " +
           open(parameter.high_is_bound, parameter.runs_end_high, "above");
  }
  if (parameter.runs_end_low || parameter.runs_end_high)
    return open(parameter.low_is_bound, parameter.runs_end_low, "below") + "; " +
           open(parameter.high_is_bound, parameter.runs_end_high, "above");
  const bool bounded = parameter.low_is_bound && parameter.high_is_bound;
  return std::string("open on both sides") + (bounded ? " (range ends first)" : "");
}

std::string significant(double value, int digits, Typography typography) {
  if (std::isnan(value)) return "not available";
  if (value == 0.0) return "0";
  if (std::isinf(value)) return mantissa(value, {}, typography);
  const bool plain = std::abs(value) >= 1e-3 && std::abs(value) < largest_plain;
  const int first = decade(value);
  const Rounding rounding{.exponent = plain ? 0 : first,
                          .decimals = plain ? std::max(0, digits - 1 - first) : digits - 1};
  return format_value(value, rounding, "", typography);
}

std::string name_in_unit(std::string_view name, std::string_view unit) {
  return is_bare(unit) || unit == name ? std::string(name) : fmt::format("{} ({})", name, unit);
}

std::string slug(std::string_view text) {
  std::string name;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && std::isalnum(byte)) {
      name += static_cast<char>(std::tolower(byte));
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
  }
  while (!name.empty() && name.back() == '-') name.pop_back();
  if (name.size() > 60) name.resize(60);
  return name.empty() ? "x" : name;
}

Verdict shown_verdict(const CaseReport& result, const ParameterReport& parameter) {
  return result.fits || (!result.doubt.empty() && !result.unusable) ? parameter.verdict : Verdict::does_not_fit;
}

std::string shown_sentence(const CaseReport& result, const ParameterReport& parameter) {
  return shown_verdict(result, parameter) == parameter.verdict ? parameter.sentence : std::string();
}

std::string shown_value(const CaseReport& result, const ParameterReport& parameter, Typography typography) {
  if (result.unusable) return "not shown";
  const std::string value = format_estimate(parameter, typography);
  return result.doubt.empty() ? value : "[" + value + "]";
}

std::string without_sentence(const CaseReport& result) { return result.without ? result.without->sentence : ""; }

std::string changes_of(const CalibrationReport& report) {
  for (const auto& [name, value] : report.provenance)
    if (name == set_on_command_line) return value;
  return {};
}

std::string program_version(const CalibrationReport& report) {
  for (const auto& [name, value] : report.provenance)
    if (name == "demcal") return value;
  return "unknown";
}

std::vector<std::string> first_lines(const CalibrationReport& report) {
  std::vector<std::string> lines = report.warnings;
  for (const CaseReport& result : report.cases)
    for (const std::string& warning : result.warnings)
      if (std::find(lines.begin(), lines.end(), warning) == lines.end()) lines.push_back(warning);
  return lines;
}

bool has_warning(const CalibrationReport& report) { return report.warning || !first_lines(report).empty(); }

}  // namespace uq
