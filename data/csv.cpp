#include "data/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "data/edit_distance.hpp"
#include "data/error.hpp"
#include "data/number_text.hpp"
#include "data/unit_text.hpp"

namespace data {
namespace {

/// A heading as a name of a study would write it, without capitals: "Static Friction" as "static_friction".
std::string with_underscores(std::string_view heading) {
  std::string name = lower_case(trimmed(heading));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == '-' || c == '.' || c == ':'; }, '_');
  return name;
}

}  // namespace

std::optional<std::size_t> Csv::find(std::string_view column, Capitals capitals) const {
  // In a name of one letter, a capital may mean another quantity.
  const bool any = capitals == Capitals::any && column.size() > 1;
  static constexpr std::array<std::string (*)(std::string_view), 3> spellings{
      [](std::string_view name) { return std::string(name); }, lower_case, with_underscores};
  for (const auto spelling : spellings) {
    if (spelling != spellings.front() && !any) break;
    const std::string wanted = spelling(column);
    const auto named = [&](const std::string& one) { return spelling(one) == wanted; };
    for (const std::vector<std::string>* names : {&columns, &headings}) {
      const auto found = std::find_if(names->begin(), names->end(), named);
      if (found == names->end()) continue;
      const auto first = static_cast<std::size_t>(found - names->begin());
      for (std::size_t again = first + 1; again < names->size(); ++again)
        if (named((*names)[again]) && !same_values(first, again))
          refuse_data(fmt::format("{}:{}", file, header_line), fmt::format("the column '{}' is there twice", column),
                      "rename or remove one");
      return first;
    }
  }
  return {};
}

bool Csv::same_values(std::size_t one, std::size_t other) const {
  return units[one] == units[other] &&
         std::all_of(rows.begin(), rows.end(), [&](const CsvRow& row) { return row.fields[one] == row.fields[other]; });
}

namespace {

/// What a column that states another error than the standard error of a mean would take to be one; nothing where there
/// is none.
std::string other_error_column(const std::vector<std::string>& columns, std::string_view name) {
  const std::string output(name.substr(0, name.size() - 3));
  const std::array<std::pair<const char*, const char*>, 8> others{
      {{"_sd", "a standard deviation: divided by the root of the number of its samples"},
       {"_std", "a standard deviation: divided by the root of the number of its samples"},
       {"_stdev", "a standard deviation: divided by the root of the number of its samples"},
       {"_var", "a variance: the root of it over the number of its samples"},
       {"_variance", "a variance: the root of it over the number of its samples"},
       {"_ci", "half of a 95 % interval: divided by 1.96"},
       {"_ci95", "half of a 95 % interval: divided by 1.96"},
       {"_u95", "an expanded uncertainty: divided by its coverage factor, mostly 2,"}}};
  for (const auto& [ending, what] : others)
    for (const std::string& column : columns)
      if (lower_case(column) == lower_case(output + ending))
        return fmt::format("; '{}' is {} it is {}", column, what, name);
  return "";
}

/// A heading that is the name with brackets whose unit cannot be read, or nothing.
std::string with_unknown_unit(const std::vector<std::string>& headings, std::string_view name) {
  for (const std::string& heading : headings) {
    const std::size_t open = heading.find_first_of("([{");
    if (open != std::string::npos && open > 0 &&
        lower_case(trimmed(std::string_view(heading).substr(0, open))) == lower_case(name))
      return heading;
  }
  return "";
}

}  // namespace

std::size_t Csv::column(std::string_view name) const {
  if (const auto found = find(name, Capitals::any)) return *found;
  std::vector<std::string> same;  // that differ in their units alone
  std::copy_if(headings.begin(), headings.end(), std::back_inserter(same),
               [&](const std::string& heading) { return read_heading(heading).name == name; });
  if (same.size() > 1)
    refuse_data(fmt::format("{}:{}", file, header_line),
                fmt::format("{} columns are called '{}': {}", same.size(), name, fmt::join(same, ", ")),
                "give the whole heading of the one that is meant");
  std::string remedy = fmt::format("the columns are {}", fmt::join(headings, ", "));
  // torque_sd is not torque_se: an sd of the samples is no error of their mean.
  const bool of_error = name.ends_with("_se");
  if (const auto near = nearest(name, columns);
      near && edit_distance(name, *near) <= 2 && !(of_error && near->ends_with("_sd"))) {
    remedy += fmt::format("; is '{}' meant?", *near);
  }
  if (of_error) remedy += other_error_column(columns, name);
  if (std::any_of(comments.begin(), comments.end(),
                  [](const std::string& line) { return line.starts_with("written by demcal"); }))
    remedy += fmt::format(
        "; demcal wrote the file before the study had '{}': choose another --out for the study as it is "
        "now",
        name);
  if (const std::string heading = with_unknown_unit(headings, name); !heading.empty())
    refuse_data(fmt::format("{}:{}", file, header_line), fmt::format("the unit in '{}' is unknown", heading),
                "write one that UDUNITS-2 knows, like \"mN m\", or none");
  refuse_data(fmt::format("{}:{}", file, header_line), fmt::format("the column '{}' is missing", name), remedy);
}

double Csv::number_if_any(const CsvRow& row, std::size_t column) const {
  const std::string& field = row.fields.at(column);
  double value = 0.0;
  const char* const end = field.data() + field.size();
  const auto [rest, error] = std::from_chars(field.data(), end, value);
  return error == std::errc{} && rest == end ? value : std::numeric_limits<double>::quiet_NaN();
}

std::optional<std::pair<double, double>> Csv::number_range(std::size_t column) const {
  std::pair<double, double> range{HUGE_VAL, -HUGE_VAL};
  for (const CsvRow& row : rows) {
    const double value = number_if_any(row, column);
    if (std::isfinite(value))
      range = {std::min(range.first, value), std::max(range.second, value)};
    else if (!is_missing(row.fields[column]))
      return {};
  }
  if (range.first > range.second) return {};
  return range;
}

std::string column_in_words(const Csv& csv, std::size_t column) {
  const auto range = csv.number_range(column);
  if (!range) return csv.columns[column] + " (text)";
  const auto [low, high] = *range;
  return low == high ? fmt::format("{} ({:.5g} everywhere)", csv.columns[column], low)
                     : fmt::format("{} (from {:.5g} to {:.5g})", csv.columns[column], low, high);
}

std::string Csv::place(const CsvRow& row, std::size_t column) const {
  return fmt::format("{}:{}: {}", file, row.line, columns.at(column));
}

double Csv::number(const CsvRow& row, std::size_t column) const {
  const std::string& field = row.fields.at(column);
  const char* begin = field.data() + (field.starts_with('+') ? 1 : 0);
  const char* end = field.data() + field.size();
  double value = 0.0;
  const auto [rest, error] = std::from_chars(begin, end, value);
  if (error == std::errc::result_out_of_range && rest == end) {
    refuse_data(place(row, column), fmt::format("'{}' is too large or too small for a double", field),
                "write a number in range");
  }
  if (error != std::errc{} || rest != end) {
    if (is_missing(field)) return std::numeric_limits<double>::quiet_NaN();
    if (field.find("\xc2\xb1") != std::string::npos || field.find("+-") != std::string::npos ||
        field.find("+/-") != std::string::npos)
      refuse_data(
          place(row, column), fmt::format("'{}' is a number with an error", field),
          fmt::format("write the error into a column of its own, {}_se, if it is the standard error of the mean",
                      columns.at(column)));
    refuse_data(
        place(row, column), fmt::format("'{}' is not a number", field),
        field.find(':') == std::string::npos
            ? "write a plain number with a decimal point"
            : "write a plain number with a decimal point, or a time as 2024-05-03 14:02:00, with +02:00 for its zone");
  }
  return value;
}

Unit Csv::unit(std::size_t column, const Unit& wanted) const {
  const std::string& given = units.at(column);
  const std::string symbol = wanted.symbol.empty() ? "1" : wanted.symbol;
  if (given.empty() || given == symbol) return wanted;
  if (const auto meant = unit_meant(given, symbol))
    return meant->factor == wanted.factor && meant->offset == wanted.offset ? wanted : *meant;
  refuse_data(fmt::format("{}:{}: {}", file, header_line, columns.at(column)),
              fmt::format("is in '{}', which does not measure what the study's '{}' does", given, symbol),
              "correct the unit in the table or in the study");
}

std::string Csv::took_line() const {
  return took.empty() ? std::string() : fmt::format("{}: read as: {}", file, fmt::join(took, ", "));
}

std::string csv_field(std::string_view text) {
  const bool plain = text.find_first_of(",;\t\"\r\n#") == std::string_view::npos && trimmed(text) == text &&
                     !text.starts_with('%') && !text.starts_with("//");
  if (plain) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string shortest(double value) { return fmt::format("{}", value); }

}  // namespace data
