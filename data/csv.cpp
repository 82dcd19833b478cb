// The table is the block with the most rows (csv_blocks.hpp), and the others with the same columns. What stands above
// them is a preamble; a second table is refused.
#include "data/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>

#include "data/atomic_file.hpp"
#include "data/csv_blocks.hpp"
#include "data/csv_records.hpp"
#include "data/edit_distance.hpp"
#include "data/error.hpp"
#include "data/lvm.hpp"
#include "data/number_text.hpp"
#include "data/text_encoding.hpp"
#include "data/unit_text.hpp"

namespace data {
namespace {

/// What is found out of a table on the way.
struct Table {
  Csv csv;
  Dialect dialect;
  std::vector<CsvRecord> records;
  std::vector<CsvBlock> blocks;  ///< with the same columns; the first one's heading is the table's
  std::vector<bool> texts;       ///< columns of remarks, whose numbers say nothing of the decimal mark; empty: none

  bool is_text(std::size_t column) const { return column < texts.size() && texts[column]; }
  std::string line(const CsvRecord& record) const { return fmt::format("{}:{}", csv.file, record.line); }
  /// Every line among the rows of the blocks that is no comment.
  template <class Visit>
  void each_row(Visit visit) const {
    for (const CsvBlock& block : blocks)
      for (std::size_t i = block.first; i < block.end; ++i)
        if (!records[i].comment) visit(records[i]);
  }
};

/// Zeros at the end are what a logger left that lost power; the line before them may have lost its end.
std::string without_zero_tail(std::string text, Table& table) {
  const std::size_t end = text.find_last_not_of('\0') + 1;
  const std::size_t zeros = text.size() - end;
  text.resize(end);
  if (const auto inside = text.find('\0'); inside != std::string::npos)
    refuse_data(fmt::format("{}:{}", table.csv.file,
                            1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(inside), '\n')),
                "holds zero bytes: it is no text, or was damaged", "save the table as CSV again");
  if (zeros == 0) return text;
  table.csv.took.push_back(fmt::format("{} zero bytes behind the end left out", zeros));
  if (!text.empty() && text.back() != '\n' && text.back() != '\r') {
    text.resize(text.find_last_of("\r\n") + 1);
    table.csv.took.push_back("the line that breaks off there left out");
  }
  return text;
}

/// "line 2" or "lines 2, 3, 4", of a long list the first ones.
std::string some_lines(const std::vector<int>& lines) {
  constexpr std::size_t shown = 6;
  const auto end = lines.begin() + static_cast<std::ptrdiff_t>(std::min(lines.size(), shown));
  return fmt::format("line{} {}{}", lines.size() > 1 ? "s" : "", fmt::join(lines.begin(), end, ", "),
                     lines.size() > shown ? ", ..." : "");
}

/// Lines that hold numbers and belong to no block, above the first heading or from there on.
std::vector<int> numbers_left_out(const Table& table, bool above) {
  std::vector<int> lines;
  std::size_t from = above ? 0 : table.blocks.front().first;
  for (const CsvBlock& block : table.blocks) {
    const std::size_t to = above ? block.heading : block.first;
    for (; from < to; ++from)
      if (holds_number(table.records[from])) lines.push_back(table.records[from].line);
    if (above) return lines;
    from = block.end;
  }
  for (; from < table.records.size(); ++from)
    if (holds_number(table.records[from])) lines.push_back(table.records[from].line);
  return lines;
}

std::size_t measurements_in(const Table& table, std::size_t from, std::size_t to) {
  return static_cast<std::size_t>(std::count_if(table.records.begin() + static_cast<std::ptrdiff_t>(from),
                                                table.records.begin() + static_cast<std::ptrdiff_t>(to),
                                                is_measurement));
}

/// Another table than the one that is read must not be lost: measurements below another heading, or above the first.
/// A preamble may hold a line of numbers that is narrower than the table's rows, and names with values.
void refuse_other_tables(const Table& table, const std::vector<CsvBlock>& others, std::size_t first_heading) {
  const CsvBlock& main = table.blocks.front();
  std::size_t rows = 0;
  for (const CsvBlock& block : table.blocks) rows += block.rows;
  for (const CsvBlock& other : others) {
    const bool below = other.line > main.line && other.headings.size() > 2;
    const std::size_t lost = std::max(measurements_in(table, other.first, other.end), below ? other.rows : 0);
    if (lost > 1 || (lost == 1 && other.headings.size() == main.headings.size()))
      refuse_data(fmt::format("{}:{}", table.csv.file, other.line),
                  fmt::format("a heading with {} rows ({}) is another than that of line {} with {} rows ({})", lost,
                              fmt::join(other.headings, ", "), main.line, rows, fmt::join(main.headings, ", ")),
                  "name the columns alike in both, in one order, or put each table into a file of its own");
  }
  std::vector<const CsvRecord*> bare;
  for (std::size_t i = 0; i < first_heading; ++i)
    if (is_measurement(table.records[i]) && table.records[i].fields.size() == main.headings.size())
      bare.push_back(&table.records[i]);
  if (bare.size() > 1)
    refuse_data(table.line(*bare.front()),
                fmt::format("there are numbers where the header line belongs, in {} lines above the heading of line {}",
                            bare.size(), main.line),
                "the first line names the columns");
}

void say_headings(Table& table, bool units) {
  const CsvBlock& first = table.blocks.front();
  std::vector<std::string>& took = table.csv.took;
  const bool preamble =
      std::any_of(table.records.begin(), table.records.begin() + static_cast<std::ptrdiff_t>(first.heading),
                  [](const CsvRecord& record) { return !record.comment; });
  const std::vector<int> above = numbers_left_out(table, true), below = numbers_left_out(table, false);
  if (first.in_comment) took.push_back(fmt::format("the heading in the comment of line {}", first.line));
  if (preamble)
    took.push_back(fmt::format("the heading in line {}, below a preamble{}", first.line,
                               above.empty() ? "" : fmt::format(" (numbers in {} left out)", some_lines(above))));
  if (units) took.push_back(fmt::format("units in line {}", first.units_line));
  std::vector<int> again;
  for (std::size_t k = 1; k < table.blocks.size(); ++k) again.push_back(table.blocks[k].line);
  if (!again.empty()) took.push_back(fmt::format("the heading again in {}: the rows joined", some_lines(again)));
  if (!below.empty())
    took.push_back(fmt::format("numbers in {}, which are no rows of the table, left out", some_lines(below)));
}

/// A heading without rows: the first line of words, if no numbers stand above it.
void use_bare_heading(Table& table) {
  const auto words = std::find_if(table.records.begin(), table.records.end(), is_words);
  const auto row = std::find_if(table.records.begin(), table.records.end(), is_row);
  if (words == table.records.end() && row == table.records.end())
    refuse_data(table.csv.file, "is empty: there is no header line", "the first line names the columns");
  if (words == table.records.end() || row < words)
    refuse_data(table.line(*row), "there are numbers where the header line belongs",
                "the first line names the columns");
  CsvBlock block{.headings = words->fields, .line = words->line};
  block.headings.resize(without_trailing(block.headings));
  block.heading = static_cast<std::size_t>(words - table.records.begin());
  block.first = block.heading + 1;
  block.end = table.records.size();
  table.blocks = {block};
}

/// The blocks with the columns of the longest one. A preamble's names with values, however many, are no measurements.
void find_table(Table& table) {
  std::vector<CsvBlock> all = find_blocks(table.records, table.dialect.separator), others;
  if (all.empty()) {
    use_bare_heading(table);
  } else {
    const auto weight = [&](const CsvBlock& block) {
      return std::pair(measurements_in(table, block.first, block.end), block.rows);
    };
    const auto longest = std::max_element(all.begin(), all.end(),
                                          [&](const CsvBlock& a, const CsvBlock& b) { return weight(a) < weight(b); });
    const std::vector<std::string> headings = longest->headings;
    for (CsvBlock& block : all)
      (same_columns(block.headings, headings) ? table.blocks : others).push_back(std::move(block));
    refuse_other_tables(table, others, std::min(all.front().heading, table.blocks.front().heading));
  }
  const CsvBlock& first = table.blocks.front();
  table.csv.header_line = first.line;
  table.csv.headings = first.headings;
  table.csv.units = first.units;
  say_headings(table, first.units_line > 0);
}

/// The first number of each kind, by what it says of the decimal mark.
struct MarkEvidence {
  struct Place {
    const CsvRecord* record = nullptr;
    std::string field;
    explicit operator bool() const { return record != nullptr; }
    void note(const CsvRecord& at, const std::string& text) {
      if (record == nullptr) *this = {&at, text};
    }
  };
  Place point, comma, maybe_point, maybe_comma;
  bool thousands_commas = false;  ///< 1,234.5 is there: what looks like thousands is that
};

MarkEvidence mark_evidence(const Table& table) {
  MarkEvidence found;
  table.each_row([&](const CsvRecord& record) {
    for (std::size_t i = 0; i < record.fields.size(); ++i) {
      const std::string& field = record.fields[i];
      if (field.find_first_of(".,") == std::string::npos || table.is_text(i)) continue;
      switch (decimal_evidence(field)) {
        case Evidence::point:
          found.point.note(record, field);
          found.thousands_commas = found.thousands_commas || field.find(',') != std::string::npos;
          break;
        case Evidence::comma:
          found.comma.note(record, field);
          break;
        case Evidence::maybe_point:
          found.maybe_point.note(record, field);
          break;
        case Evidence::maybe_comma:
          found.maybe_comma.note(record, field);
          break;
        case Evidence::none:
          break;
      }
    }
  });
  return found;
}

constexpr const char* plain_decimals = "write every number with a decimal point and without a mark for thousands";

[[noreturn]] void refuse_two_readings(const Table& table, const CsvRecord& record, const std::string& field) {
  refuse_data(table.line(record),
              fmt::format("'{}' may be {} or {}", field, plain_number(field, DecimalMark::comma).value_or("?"),
                          plain_number(field, DecimalMark::point).value_or("?")),
              plain_decimals);
}

/// Where no number of a table says what a point is, a column of whole numbers and of 1.012 may be one of thousands: 950,
/// 1012. It is asked back where its numbers lie closer together so.
void ask_for_thousands(const Table& table, const MarkEvidence& found) {
  if (!found.maybe_point || found.point) return;
  struct Range {
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    void add(double value) {
      if (value == 0.0) return;
      low = std::min(low, std::abs(value));
      high = std::max(high, std::abs(value));
    }
    double ratio() const { return high / low; }
  };
  struct Readings {
    Range decimals, thousands;
    bool whole = false;
    const CsvRecord* marked = nullptr;
    std::string field;
  };
  std::vector<Readings> columns(table.csv.headings.size());
  table.each_row([&](const CsvRecord& record) {
    for (std::size_t i = 0; i < std::min(columns.size(), record.fields.size()); ++i) {
      const std::string& field = record.fields[i];
      const auto decimal = plain_number(field, DecimalMark::point), thousand = plain_number(field, DecimalMark::comma);
      if (!decimal || !thousand) continue;
      columns[i].decimals.add(std::strtod(decimal->c_str(), nullptr));
      columns[i].thousands.add(std::strtod(thousand->c_str(), nullptr));
      const bool marked = decimal_evidence(field) == Evidence::maybe_point;
      columns[i].whole = columns[i].whole || !marked;
      if (marked && columns[i].marked == nullptr) {
        columns[i].marked = &record;
        columns[i].field = field;
      }
    }
  });
  for (const Readings& column : columns)
    if (column.whole && column.marked != nullptr && column.thousands.ratio() < column.decimals.ratio())
      refuse_data(
          table.line(*column.marked),
          fmt::format("'{0}' may be {1}, like the whole numbers of its column, or {0}", column.field,
                      plain_number(column.field, DecimalMark::comma).value_or("?")),
          fmt::format("write {} or {}0", plain_number(column.field, DecimalMark::comma).value_or("?"), column.field));
}

/// Columns of which half and more of the fields are words.
std::vector<bool> text_columns(const Table& table) {
  std::vector<std::size_t> words(table.csv.headings.size()), filled(words.size());
  table.each_row([&](const CsvRecord& record) {
    for (std::size_t i = 0; i < std::min(words.size(), record.fields.size()); ++i) {
      const std::string& field = record.fields[i];
      if (is_missing(field)) continue;
      ++filled[i];
      words[i] += !plain_number(field, DecimalMark::point) && !plain_number(field, DecimalMark::comma);
    }
  });
  std::vector<bool> texts;
  for (std::size_t i = 0; i < words.size(); ++i) texts.push_back(filled[i] > 0 && 2 * words[i] >= filled[i]);
  return texts;
}

/// Which decimal mark the numbers have, by those that can be read in one way alone. Between commas, a comma in quotes
/// may stand in a text: it is a decimal mark only where no number has a point.
DecimalMark find_mark(Table& table) {
  MarkEvidence found = mark_evidence(table);
  const bool between_commas = table.dialect.separator == ',';
  if (found.comma && found.point && !between_commas) {
    table.texts = text_columns(table);
    found = mark_evidence(table);
  }
  if (found.comma && found.point && !between_commas)
    refuse_data(table.line(*found.comma.record),
                fmt::format("'{}' has a decimal comma, but '{}' in line {} a decimal point", found.comma.field,
                            found.point.field, found.point.record->line),
                plain_decimals);
  const bool commas = found.comma && !found.point;
  if (found.maybe_comma && !commas && !found.thousands_commas)
    refuse_two_readings(table, *found.maybe_comma.record, found.maybe_comma.field);
  if (commas && found.maybe_point)
    refuse_data(
        table.line(*found.maybe_point.record),
        fmt::format("'{}' may be a decimal number or thousands: other numbers of the table have a decimal comma",
                    found.maybe_point.field),
        plain_decimals);
  ask_for_thousands(table, found);
  return commas ? DecimalMark::comma : DecimalMark::point;
}

std::string wrong_count(const Table& table, const CsvRecord& record) {
  const bool numbers = std::all_of(record.fields.begin(), record.fields.end(), [](const std::string& field) {
    return plain_number(field, DecimalMark::point).has_value();
  });
  if (record.fields.size() < table.csv.headings.size()) return "complete the line; the file may have been cut off here";
  if (table.dialect.separator == ',' && numbers)
    return "its commas may be decimal marks as well as separators, which cannot be told apart: part the columns by "
           "semicolons";
  return table.dialect.separator == ',' ? "a field with a comma in it needs quotes" : "check the line";
}

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

void read_columns(Csv& csv) {
  CsvColumns columns = columns_of(csv.headings, std::move(csv.units), csv.comments);
  csv.columns = std::move(columns.names);
  csv.units = std::move(columns.units);
}

std::vector<std::string> comments_above(const Table& table, std::size_t from, const CsvBlock& block) {
  std::vector<std::string> comments;
  for (std::size_t i = from; i < block.first; ++i)
    if (table.records[i].comment && table.records[i].line != block.line)
      comments.push_back(table.records[i].fields.front());
  return comments;
}

/// From the unit of a block's column to that of the table's.
struct UnitChange {
  Unit from, to;
};

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

/// How the columns of a block change into those of the first one; a heading that is repeated to the letter has its units.
std::vector<std::optional<UnitChange>> changes_to_first(const Table& table, std::size_t k) {
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

/// A row's fields, as many as there are columns; nothing of a line that repeats the heading or its units.
std::optional<std::vector<std::string>> fields_of(const Table& table, const CsvRecord& record, std::size_t& trailing) {
  const std::size_t columns = table.csv.headings.size();
  std::vector<std::string> fields = record.fields;
  if (fields.size() > columns && without_trailing(fields) <= columns) {
    fields.resize(columns);
    ++trailing;
  }
  if (fields == table.csv.headings) return {};
  if (fields.size() != columns)
    refuse_data(table.line(record), fmt::format("has {} fields where the header has {}", fields.size(), columns),
                wrong_count(table, record));
  return fields;
}

void read_rows(Table& table) {
  const DecimalMark mark = find_mark(table);
  if (mark == DecimalMark::comma) table.csv.took.push_back("decimal commas");
  std::size_t trailing = 0, repeated = 0, converted = 0;
  for (std::size_t k = 0; k < table.blocks.size(); ++k) {
    const CsvBlock& block = table.blocks[k];
    const auto changes =
        k == 0 ? std::vector<std::optional<UnitChange>>(table.csv.headings.size()) : changes_to_first(table, k);
    converted += std::any_of(changes.begin(), changes.end(), [](const auto& one) { return one.has_value(); });
    for (std::size_t i = block.first; i < block.end; ++i) {
      const CsvRecord& record = table.records[i];
      if (record.comment) continue;
      auto fields = fields_of(table, record, trailing);
      if (!fields) {
        ++repeated;
        continue;
      }
      for (std::size_t c = 0; c < fields->size(); ++c) {
        const auto plain = table.is_text(c) ? std::nullopt : plain_number((*fields)[c], mark);
        if (plain) (*fields)[c] = changes[c] ? changes[c]->to.digits(changes[c]->from.to_si(*plain)) : *plain;
      }
      table.csv.rows.push_back({std::move(*fields), record.line});
    }
  }
  if (trailing > 0) table.csv.took.push_back("separators behind the last column left out");
  if (repeated > 0) table.csv.took.push_back(fmt::format("the heading again in {} lines left out", repeated));
  if (converted > 0)
    table.csv.took.push_back(
        fmt::format("the rows of {} of them converted to the units of line {}", converted, table.csv.header_line));
  if (table.blocks.back().footers > 0)
    table.csv.took.push_back(fmt::format("{} lines of words below the table left out", table.blocks.back().footers));
}

}  // namespace

std::optional<std::size_t> Csv::find(std::string_view column, Capitals capitals) const {
  // Of names of one letter, a capital may be another quantity.
  const bool any = capitals == Capitals::any && column.size() > 1;
  for (const bool lower : {false, true}) {
    if (lower && !any) break;
    const std::string wanted = lower ? lower_case(column) : std::string(column);
    const auto named = [&](const std::string& one) { return (lower ? lower_case(one) : one) == wanted; };
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

std::size_t Csv::column(std::string_view name) const {
  if (const auto found = find(name, Capitals::any)) return *found;
  std::string remedy = fmt::format("the columns are {}", fmt::join(headings, ", "));
  // torque_sd is not torque_se: an sd of the samples is no error of their mean.
  const bool of_error = name.ends_with("_se");
  if (const auto near = nearest(name, columns);
      near && edit_distance(name, *near) <= 2 && !(of_error && near->ends_with("_sd"))) {
    remedy += fmt::format("; is '{}' meant?", *near);
  }
  refuse_data(fmt::format("{}:{}", file, header_line), fmt::format("the column '{}' is missing", name), remedy);
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
    refuse_data(place(row, column), fmt::format("'{}' is not a number", field),
                "write a plain number with a decimal point");
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

Csv parse_csv(const std::string& bytes, const std::string& file) {
  Table table;
  table.csv.file = file;
  DecodedText decoded = decode_text(bytes, file);
  if (!decoded.took.empty()) table.csv.took.push_back(decoded.took);
  const std::string text = without_zero_tail(std::move(decoded.text), table);
  if (is_lvm(text)) {
    Csv read = read_lvm(text, file);
    read.took.insert(read.took.begin(), table.csv.took.begin(), table.csv.took.end());
    table.csv = std::move(read);
    read_columns(table.csv);
    return std::move(table.csv);
  }
  table.dialect = find_dialect(text);
  if (const std::string name = separator_name(table.dialect.separator); !name.empty())
    table.csv.took.push_back("separated by " + name);
  table.records = read_records(text, table.dialect, file);
  find_table(table);
  table.csv.comments = comments_above(table, 0, table.blocks.front());
  read_columns(table.csv);
  read_rows(table);
  return std::move(table.csv);
}

Csv read_csv(const std::string& path) { return parse_csv(read_file(path), shown_path(path)); }

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
