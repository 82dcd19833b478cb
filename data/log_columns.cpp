#include "data/log_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <vector>

#include "data/error.hpp"
#include "data/number_text.hpp"
#include "data/time_text.hpp"
#include "data/unit_text.hpp"

namespace data {
namespace {

std::string heading_place(const Csv& csv) { return fmt::format("{}:{}", csv.file, csv.header_line); }

bool is_named(const std::string& name, const LogColumn& wanted) {
  const auto same = [&](const std::string& other) { return lower_case(name) == lower_case(other); };
  return same(wanted.name) || std::any_of(wanted.also.begin(), wanted.also.end(), same);
}

/// The size of a unit of speed in rpm, where UDUNITS-2 reads it as a multiple of rpm: 60 for Hz.
std::optional<double> multiple_of_rpm(const Unit& unit) {
  if (!unit.symbol.ends_with(" rpm")) return {};
  return std::strtod(unit.symbol.c_str(), nullptr);
}

/// Whether a column in this unit can only be the quantity of that dimension: a joule is an energy, and a hertz or "1/s"
/// may be a shear rate or any other frequency.
bool tells_quantity(const std::string& unit, std::string_view dimension) {
  static constexpr std::array frequencies{"hz", "khz", "mhz", "1/s", "s-1", "s^-1", "/s"};
  if (unit.empty() || !unit_meant(unit, dimension)) return false;
  if (dimension == "N m") return unit.find('J') == std::string::npos;
  return dimension != "rpm" || std::find(frequencies.begin(), frequencies.end(), lower_case(unit)) == frequencies.end();
}

/// The columns whose unit tells the quantity, whatever they are called.
std::vector<std::size_t> by_unit(const Csv& csv, std::string_view dimension) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < csv.columns.size(); ++i)
    if (tells_quantity(csv.units[i], dimension)) found.push_back(i);
  return found;
}

/// The columns of the name; where there are none, those of the other names.
std::vector<std::size_t> by_name(const Csv& csv, const LogColumn& wanted) {
  const auto named = [&](std::size_t i, const std::string& name) {
    return lower_case(csv.columns[i]) == lower_case(name) || lower_case(csv.headings[i]) == lower_case(name);
  };
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < csv.columns.size(); ++i)
    if (named(i, wanted.name)) found.push_back(i);
  if (!found.empty()) return found;
  for (std::size_t i = 0; i < csv.columns.size(); ++i)
    if (std::any_of(wanted.also.begin(), wanted.also.end(), [&](const std::string& name) { return named(i, name); }))
      found.push_back(i);
  return found;
}

/// The columns whose first value is a time of day or a date with one.
std::vector<std::size_t> of_clock(const Csv& csv) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < csv.columns.size(); ++i) {
    const auto first =
        std::find_if(csv.rows.begin(), csv.rows.end(), [i](const CsvRow& row) { return !is_missing(row.fields[i]); });
    if (first != csv.rows.end() && read_time(first->fields[i])) found.push_back(i);
  }
  return found;
}

}  // namespace

bool may_be_column(const Csv& csv, const LogColumn& wanted, const LogQuantity& quantity) {
  return !by_name(csv, wanted).empty() || (!wanted.also.empty() && !by_unit(csv, quantity.dimension).empty());
}

std::size_t find_column(const Csv& csv, const LogColumn& wanted, const LogQuantity& quantity,
                        std::vector<std::string>& took) {
  std::vector<std::size_t> found = by_name(csv, wanted);
  // "t" and "T" are a time and a torque.
  const auto as_written = [&](std::size_t i) {
    return std::find(wanted.also.begin(), wanted.also.end(), csv.columns[i]) != wanted.also.end();
  };
  if (found.size() > 1 && std::count_if(found.begin(), found.end(), as_written) == 1)
    found = {*std::find_if(found.begin(), found.end(), as_written)};
  while (found.size() > 1 && csv.headings[found[0]] == csv.headings[found[1]] && csv.same_values(found[0], found[1]))
    found.erase(found.begin() + 1);
  if (found.size() == 1) return found.front();
  if (found.size() > 1)
    refuse_data(heading_place(csv),
                fmt::format("both '{}' and '{}' may be the column '{}'", csv.headings[found[0]], csv.headings[found[1]],
                            wanted.name),
                fmt::format("say which with --{}", quantity.option));
  if (quantity.option == "time" && !csv.no_time.empty())
    refuse_data(csv.file, csv.no_time, "give the samples per second with --rate, if they are even all through");
  const bool any_name = !wanted.also.empty();  // the command line named none
  const std::vector<std::size_t> in_unit = any_name ? by_unit(csv, quantity.dimension) : std::vector<std::size_t>{};
  if (in_unit.size() == 1) {
    took.push_back(
        fmt::format("'{}' as the {}: the only column in a unit of it", csv.headings[in_unit[0]], quantity.word));
    return in_unit.front();
  }
  const std::vector<std::size_t> clocks =
      any_name && quantity.option == time_of_log.option ? of_clock(csv) : std::vector<std::size_t>{};
  if (clocks.size() == 1) {
    took.push_back(fmt::format("'{}' as the time: the only column of a clock's times", csv.headings[clocks[0]]));
    return clocks.front();
  }
  std::string remedy = fmt::format("name it with --{}", quantity.option);
  if (in_unit.size() > 1) {
    std::vector<std::string> names;
    for (const std::size_t i : in_unit) names.push_back("'" + csv.headings[i] + "'");
    remedy = fmt::format("name it with --{}: {} are in a unit of it", quantity.option, fmt::join(names, " and "));
  }
  if (quantity.option == "rpm") remedy += ", or give the speed of the whole log with --constant-speed";
  if (csv.columns.size() == 1)
    remedy = "its columns are not parted by commas, semicolons, tabs or blanks, or it has one column only";
  refuse_data(
      heading_place(csv),
      fmt::format("the column '{}' is missing (the columns are {})", wanted.name, fmt::join(csv.headings, ", ")),
      remedy);
}

void take_unit_of_cells(Csv& csv, std::size_t column, const LogColumn& wanted, const LogQuantity& quantity,
                        std::vector<std::string>& took) {
  if (!wanted.unit.empty() || !csv.units[column].empty()) return;
  std::string unit;
  std::vector<std::string> numbers;
  for (const CsvRow& row : csv.rows) {
    const std::string& field = row.fields[column];
    const std::size_t gap = field.rfind(' ');
    const auto number = plain_number(field.substr(0, std::min(gap, field.size())), DecimalMark::point);
    if (gap == std::string::npos || !number) return;
    const std::string here = field.substr(gap + 1);
    if (unit.empty() && unit_meant(here, quantity.dimension)) unit = here;
    if (here != unit) return;
    numbers.push_back(*number);
  }
  if (unit.empty()) return;
  for (std::size_t i = 0; i < numbers.size(); ++i) csv.rows[i].fields[column] = std::move(numbers[i]);
  csv.units[column] = unit;
  took.push_back(fmt::format("'{}' in {}, which every cell says", csv.headings[column], unit));
}

Unit shown_unit(const Unit& meant, const std::string& given) {
  if (multiple_of_rpm(meant)) return parse_unit("rpm");
  Unit unit = meant;
  if (!unit.symbol.empty() && unit.symbol.front() >= '0' && unit.symbol.front() <= '9') unit.symbol = trimmed(given);
  return unit;
}

Unit find_unit(const Csv& csv, std::size_t column, const LogColumn& wanted, const LogQuantity& quantity) {
  std::string symbol = wanted.unit.empty() ? csv.units[column] : wanted.unit;
  if (symbol.empty()) symbol = wanted.usual;
  if (symbol.empty())
    refuse_data(heading_place(csv), fmt::format("the column '{}' has no unit", csv.headings[column]),
                fmt::format("write it in the header, '{} [N m]', or give --{}-unit", wanted.name, quantity.option));
  if (const auto unit = unit_meant(symbol, quantity.dimension)) return shown_unit(*unit, symbol);
  refuse_data(heading_place(csv), fmt::format("'{}' is not a unit of {}", symbol, quantity.option),
              fmt::format("a unit like '{}'; --{}-unit overrides the header", quantity.dimension, quantity.option));
}

double per_shown_unit(const Csv& csv, std::size_t column, const LogColumn& wanted) {
  const std::string& symbol = wanted.unit.empty() ? csv.units[column] : wanted.unit;
  const auto unit = unit_meant(symbol, "rpm");
  return unit ? multiple_of_rpm(*unit).value_or(1.0) : 1.0;
}

void part_headings(Csv& csv, const LogColumns& columns) {
  for (const auto& [wanted, quantity] :
       {std::pair(&columns.time, time_of_log), {&columns.torque, torque_of_log}, {&columns.speed, speed_of_log}})
    for (std::size_t i = 0; i < csv.columns.size(); ++i) {
      if (!csv.units[i].empty() && unit_meant(csv.units[i], quantity.dimension)) continue;
      const auto split = heading_with_unit(csv.headings[i], quantity.dimension);
      if (!split) continue;
      const bool named = is_named(csv.columns[i], *wanted) || is_named(csv.headings[i], *wanted);
      const bool named_less = is_named(split->name, *wanted);
      if (!named && named_less) csv.columns[i] = split->name;
      // Of any other name the unit may tell the quantity: "drive_torque_mNm".
      const bool by_unit = csv.units[i].empty() && quantity.option != time_of_log.option;
      if (named || named_less || (by_unit && tells_quantity(split->unit, quantity.dimension)))
        csv.units[i] = split->unit;
    }
}

}  // namespace data
