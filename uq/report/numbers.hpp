#pragma once
// Numbers as the page writes them: by the rules of uq/findings/wording, in a page's typography.
#include <fmt/format.h>

#include <string>
#include <string_view>

#include "uq/findings/wording.hpp"

namespace uq::page {

inline constexpr Typography pretty = Typography::unicode;
inline constexpr const char* nothing = "\u2013";

inline std::string with_error(double value, double error, std::string_view unit = {}) {
  return format_with_error(value, error, unit, pretty);
}
inline std::string rounded(double value, const Rounding& rounding, std::string_view unit = {}) {
  return format_value(value, rounding, unit, pretty);
}
inline std::string interval(double low, double high, const Rounding& rounding, std::string_view unit = {}) {
  return format_interval(low, high, rounding, unit, pretty);
}
inline std::string digits(double value, int significant_digits) {
  return significant(value, significant_digits, pretty);
}
inline std::string decimals(double value, int places) { return rounded(value, {.exponent = 0, .decimals = places}); }
inline std::string percent(double share) { return fmt::format("{:.0f}\u00a0%", 100.0 * share); }
inline std::string between(double low, double high) { return fmt::format("{:.4g} to {:.4g}", low, high); }
/// A control's setting, as it was given.
inline std::string setting(double value) { return fmt::format("{:.6g}", value); }
inline std::string nats(double information, double error) {
  return fmt::format("{:.2f} \u00b1 {:.2f}", information, error);
}

}  // namespace uq::page
