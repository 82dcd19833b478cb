#include "data/study_value.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "data/number_text.hpp"
#include "data/unit_text.hpp"

namespace data {
namespace {

double clamp_to(double value, const Range& range) {
  if (std::isnan(value)) value = 0.0;
  return std::min(std::max(value, range.low), range.high);
}

}  // namespace

std::string shown_value(const toml::node& node) {
  if (const auto* text = node.as_string()) return fmt::format("'{}'", text->get());
  if (const auto* whole = node.as_integer()) return fmt::format("{}", whole->get());
  if (const auto* real = node.as_floating_point()) return fmt::format("{}", real->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (node.is_array()) return "a list";
  if (node.is_table()) return "a table";
  return "a date or time";
}

std::optional<double> bare_number(const toml::node& node) {
  if (const auto* whole = node.as_integer()) return static_cast<double>(whole->get());
  if (const auto* real = node.as_floating_point()) return real->get();
  return {};
}

double missing_value(const Range& range, const std::optional<double>& fallback) {
  return fallback.value_or(std::isfinite(range.low) ? range.low : std::isfinite(range.high) ? range.high : 0.0);
}

double check_range(const Section::Node& node, std::string_view key, double value, const Range& range,
                   const std::pair<std::string, BoundText>& shown) {
  const auto& [text, display] = shown;
  std::string allowed;
  if (std::isfinite(range.low)) {
    allowed = fmt::format("{} {}", range.open_low ? "above" : "from", display.text(range.low));
  }
  if (std::isfinite(range.high)) {
    allowed += fmt::format("{}{} {}", allowed.empty() ? "" : " ", range.open_high ? "below" : "up to",
                           display.text(range.high));
  }
  const std::string remedy = allowed.empty() ? "choose a finite number" : fmt::format("choose a value {}", allowed);
  if (!std::isfinite(value)) {
    node.problem(key, fmt::format("{} is not a finite number", text), remedy);
  } else if (value < range.low || (range.open_low && value == range.low)) {
    node.problem(key,
                 range.open_low
                     ? fmt::format("{} is not above {}", text, display.text(range.low))
                     : fmt::format("{} is below the smallest value {} allowed", text, display.text(range.low)),
                 remedy);
  } else if (value > range.high || (range.open_high && value == range.high)) {
    node.problem(key,
                 range.open_high
                     ? fmt::format("{} is not below {}", text, display.text(range.high))
                     : fmt::format("{} is above the largest value {} allowed", text, display.text(range.high)),
                 remedy);
  }
  return clamp_to(value, range);
}

std::optional<double> read_quantity(const Section::Node& node, std::string_view key, const toml::node& value,
                                    std::string_view si_unit, const ExpectedQuantity& expected) {
  const auto& [range, default_unit, difference] = expected;
  const bool dimensionless = convertible(si_unit, "1");
  std::optional<double> number = bare_number(value);
  std::string unit_text;
  if (const auto* text = value.as_string()) {
    if (auto written = number_with_unit(text->get())) {
      number = written->value;
      unit_text = std::move(written->unit);
    }
  }
  const std::string_view usual_unit = si_unit == "rad/s" ? "rpm" : si_unit;
  const std::string example = default_unit != nullptr ? fmt::format("\"1 {}\"", default_unit->symbol)
                              : dimensionless         ? std::string("0.5")
                                                      : fmt::format("\"1 {}\"", usual_unit);
  if (!number) {
    node.problem(key, fmt::format("{} is not a quantity", shown_value(value)),
                 fmt::format("write a number with its unit, like {}", example));
    return {};
  }
  if (unit_text.empty()) {
    if (default_unit != nullptr) {
      return check_range(node, key, default_unit->to_si(*number), range,
                         {shown_value(value), BoundText{default_unit, default_unit->symbol}});
    }
    if (dimensionless) return check_range(node, key, *number, range, {shown_value(value), BoundText{}});
    node.problem(key, fmt::format("{} has no unit", shown_value(value)),
                 fmt::format("write it with a unit of {}, like \"{:.10g} {}\"", usual_unit, *number, usual_unit));
    return {};
  }
  try {
    if (const auto meant = unit_meant(unit_text, si_unit))
      return check_range(node, key, (difference ? meant->differences() : *meant).to_si(*number), range,
                         {shown_value(value), BoundText{nullptr, si_unit}});
    parse_unit(unit_text);  // throws where it is none
    node.problem(key,
                 fmt::format("{} has the wrong unit: '{}' does not measure what {} does", shown_value(value), unit_text,
                             dimensionless ? "a plain number" : fmt::format("'{}'", si_unit)),
                 fmt::format("write it like {}", example));
    return {};
  } catch (const std::invalid_argument& unknown) {
    node.problem(key, fmt::format("{} has an unknown unit: {}", shown_value(value), unknown.what()),
                 fmt::format("write it like {}", example));
    return {};
  }
}

}  // namespace data
