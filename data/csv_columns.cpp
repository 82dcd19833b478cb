#include "data/csv_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <string_view>

#include "data/error.hpp"
#include "data/unit_text.hpp"

namespace data {
namespace {

/// Names of the columns, and their units: one in the heading counts before one in a row, and that before one in a
/// comment "units: a [m], b [s]".
struct CsvColumns {
  std::vector<std::string> names, units;
};

/// A spreadsheet that saved the file again may have put the comment's parts into cells: separators and quotes in it are
/// passed over.
void add_units_of_comment(CsvColumns& columns, const std::string& comment) {
  if (!comment.starts_with("units: ")) return;
  std::string list = comment.substr(7) + ",";
  list.erase(std::remove(list.begin(), list.end(), '"'), list.end());
  for (std::size_t at = 0, end = 0; (end = list.find_first_of(",;\t", at)) != std::string::npos; at = end + 1) {
    const Heading split = read_heading(std::string_view(list).substr(at, end - at));
    const auto found = std::find(columns.names.begin(), columns.names.end(), split.name);
    if (found == columns.names.end() || split.unit.empty()) continue;
    std::string& unit = columns.units[found - columns.names.begin()];
    if (unit.empty()) unit = split.unit;
  }
}

CsvColumns columns_of(const std::vector<std::string>& headings, std::vector<std::string> units,
                      const std::vector<std::string>& comments) {
  CsvColumns columns{.names = {}, .units = std::move(units)};
  columns.units.resize(headings.size());
  std::map<std::string, std::set<std::string>> names;
  for (std::size_t i = 0; i < headings.size(); ++i) {
    Heading split = read_heading(headings[i]);
    if (!split.unit.empty()) columns.units[i] = std::move(split.unit);
    columns.names.push_back(std::move(split.name));
    names[columns.names.back()].insert(headings[i]);
  }
  for (const std::string& comment : comments) add_units_of_comment(columns, comment);
  for (std::size_t i = 0; i < columns.names.size(); ++i)
    if (names[columns.names[i]].size() > 1) columns.names[i] = headings[i];
  return columns;
}

/// The change from one unit to another; `same` where they are the same; nothing where they measure different things.
struct FoundChange {
  bool same = false;
  std::optional<UnitChange> change;
};

FoundChange unit_change(const std::string& from, const std::string& to) {
  if (from == to) return {.same = true, .change = {}};
  for (const std::string& dimension : {std::string("N m"), std::string("rpm"), std::string("s"), to}) try {
      const auto one = unit_meant(from, dimension), other = unit_meant(to, dimension);
      if (one && other) return {one->factor == other->factor && one->offset == other->offset, UnitChange{*one, *other}};
    } catch (const std::invalid_argument&) {  // `to` is no unit
    }
  return {};
}

/// A heading of several lines in quotes, as spreadsheets wrap them, is one line.
std::string in_one_line(std::string_view heading) {
  std::string line;
  for (const char c : heading) {
    const bool blank = c == '\n' || c == '\r' || c == '\t' || c == ' ';
    if (!blank)
      line += c;
    else if (!line.empty() && line.back() != ' ')
      line += ' ';
  }
  if (line.ends_with(' ')) line.pop_back();
  return line;
}

}  // namespace

void read_columns(Csv& csv) {
  for (std::string& heading : csv.headings)
    if (heading.find_first_of("\n\r") != std::string::npos) heading = in_one_line(heading);
  CsvColumns columns = columns_of(csv.headings, std::move(csv.units), csv.comments);
  csv.columns = std::move(columns.names);
  csv.units = std::move(columns.units);
}

std::vector<std::optional<UnitChange>> changes_to_first(const CsvTable& table, std::size_t k) {
  std::vector<std::optional<UnitChange>> changes(table.csv.headings.size());
  const CsvBlock& block = table.blocks[k];
  const std::vector<std::string> comments = comments_above(table, table.blocks[k - 1].end, block);
  const CsvColumns columns = columns_of(block.headings, block.units, comments);
  const bool silent =
      std::all_of(columns.units.begin(), columns.units.end(), [](const auto& one) { return one.empty(); });
  if (silent && block.headings == table.csv.headings) return changes;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const std::string &unit = columns.units[i], &first = table.csv.units[i];
    const FoundChange found = unit_change(unit, first);
    if (found.same) continue;
    if (!found.change) {
      const auto shown = [](const std::string& one) {
        return one.empty() ? "without a unit" : fmt::format("in '{}'", one);
      };
      refuse_data(fmt::format("{}:{}: {}", table.csv.file, block.line, table.csv.columns[i]),
                  fmt::format("is {} in the {} rows below, but {} in the {} rows below line {}", shown(unit),
                              block.rows, shown(first), table.blocks.front().rows, table.csv.header_line),
                  "write the unit into both headings");
    }
    changes[i] = found.change;
  }
  return changes;
}

}  // namespace data
