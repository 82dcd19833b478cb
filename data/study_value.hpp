#pragma once
// The values of a study's keys: numbers and quantities with their units, and what is wrong with them.
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "data/study_node.hpp"
#include "data/unit.hpp"

namespace data {

/// A value as messages name it.
std::string shown_value(const toml::node& node);

std::optional<double> bare_number(const toml::node& node);

/// How the bounds of a range are written, in the unit that the reader used.
struct BoundText {
  const Unit* unit = nullptr;  ///< null: SI
  std::string_view symbol;
  std::string text(double si) const {
    const double value = unit != nullptr ? unit->from_si(si) : si;
    return fmt::format("{:.10g}{}", value, behind_number(symbol));
  }
};

/// The value that stands for one that is missing or wrong.
double missing_value(const Range& range, const std::optional<double>& fallback);

/// Records a problem when the value is outside; returns the nearest value inside.
double check_range(const Section::Node& node, std::string_view key, double value, const Range& range,
                   const std::pair<std::string, BoundText>& shown);

struct ExpectedQuantity {
  Range range;
  const Unit* default_unit = nullptr;  ///< unit of a bare number
  bool difference = false;             ///< units count without their offset
};

/// A number with its unit, in SI; records what is wrong with it.
std::optional<double> read_quantity(const Section::Node& node, std::string_view key, const toml::node& value,
                                    std::string_view si_unit, const ExpectedQuantity& expected);

}  // namespace data
