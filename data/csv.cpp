// The heading is the line without numbers that stands above the most rows with as many fields; a preamble has shorter
// lines or fewer of them. In a file without such a line it is the last comment above the rows.
#include "data/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "data/atomic_file.hpp"
#include "data/csv_records.hpp"
#include "data/edit_distance.hpp"
#include "data/error.hpp"
#include "data/lvm.hpp"
#include "data/number_text.hpp"
#include "data/text_encoding.hpp"
#include "data/time_text.hpp"
#include "data/unit_text.hpp"

namespace data {
namespace {

bool is_number(const std::string& field, bool commas) {
  return plain_number(field, DecimalMark::point) || (commas && plain_number(field, DecimalMark::comma)) ||
         read_time(field);
}

/// What is found out of a table on the way.
struct Table {
  Csv csv;
  Dialect dialect;
  std::vector<CsvRecord> records;
  std::optional<std::size_t> heading;  ///< of `records`
  std::size_t first_row = 0;           ///< of `records`, behind the heading and a row of units

  std::string line(const CsvRecord& record) const { return fmt::format("{}:{}", csv.file, record.line); }
  bool has_number(const CsvRecord& record) const {
    return std::any_of(record.fields.begin(), record.fields.end(),
                       [&](const std::string& field) { return is_number(field, true); });
  }
  bool is_row(const CsvRecord& record) const {
    return !record.comment &&
           (has_number(record) || std::all_of(record.fields.begin(), record.fields.end(),
                                              [](const std::string& field) { return is_missing(field); }));
  }
  bool is_words(const CsvRecord& record) const { return !record.comment && !is_row(record); }
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

std::size_t without_trailing(const std::vector<std::string>& fields) {
  std::size_t count = fields.size();
  while (count > 0 && fields[count - 1].empty()) --count;
  return count;
}

bool is_units_row(const CsvRecord& record) {
  bool any = false;
  for (const std::string& field : record.fields) {
    const std::string bare =
        field.size() >= 2 && (field.front() == '[' || field.front() == '(') ? field.substr(1, field.size() - 2) : field;
    if (!bare.empty() && !is_unit(bare)) return false;
    any = any || (!bare.empty() && bare != "-" && bare != "1");
  }
  return any;
}

/// Rows that could belong to a heading at `at`: with as many fields, up to the next line of words with as many.
struct Below {
  std::size_t rows = 0;
  bool units = false;
};
Below rows_below(const Table& table, std::size_t at) {
  Below below;
  const std::size_t columns = without_trailing(table.records[at].fields);
  for (std::size_t i = at + 1; i < table.records.size(); ++i) {
    const CsvRecord& record = table.records[i];
    if (record.comment) continue;
    const bool as_many = record.fields.size() >= columns && without_trailing(record.fields) <= columns;
    if (table.is_row(record)) {
      if (as_many) ++below.rows;
    } else if (below.rows == 0 && !below.units && as_many && is_units_row(record)) {
      below.units = true;
    } else if (below.rows == 0 || (as_many && record.gap_above)) {
      break;
    }
  }
  return below;
}

void use_heading(Table& table, std::vector<std::string> names, int line) {
  names.resize(without_trailing(names));
  table.csv.header_line = line;
  table.csv.headings = std::move(names);
}

void find_heading(Table& table) {
  std::size_t most = 0, candidates = 0;
  bool units = false;
  std::optional<std::size_t> first_words;
  for (std::size_t i = 0; i < table.records.size(); ++i) {
    if (!table.is_words(table.records[i]) || without_trailing(table.records[i].fields) == 0) continue;
    if (!first_words) first_words = i;
    const Below below = rows_below(table, i);
    if (below.rows > 0 && ++candidates > 200) break;  // lines of words among the rows: no heading is looked for there
    if (below.rows <= most) continue;
    most = below.rows;
    units = below.units;
    table.heading = i;
  }
  const auto first_row =
      std::find_if(table.records.begin(), table.records.end(), [&](const CsvRecord& one) { return table.is_row(one); });
  const auto row_at = static_cast<std::size_t>(first_row - table.records.begin());
  if (!table.heading && first_words && (row_at == table.records.size() || *first_words < row_at))
    table.heading = first_words;
  if (table.heading) {
    std::size_t skipped = 0;
    for (std::size_t i = 0; i < *table.heading; ++i) {
      if (table.records[i].comment) continue;
      ++skipped;
    }
    if (skipped > 0)
      table.csv.took.push_back(
          fmt::format("the heading in line {}, below a preamble", table.records[*table.heading].line));
    use_heading(table, table.records[*table.heading].fields, table.records[*table.heading].line);
    table.first_row = *table.heading + 1;
    if (!units) return;
    while (table.records[table.first_row].comment) ++table.first_row;
    table.csv.units = table.records[table.first_row].fields;
    for (std::string& unit : table.csv.units)
      if (unit.size() > 2 && (unit.front() == '[' || unit.front() == '(')) unit = unit.substr(1, unit.size() - 2);
    table.csv.took.push_back(fmt::format("units in line {}", table.records[table.first_row].line));
    ++table.first_row;
    return;
  }
  // A heading in a comment, perhaps with one of units below it.
  std::vector<std::size_t> above;
  for (std::size_t i = 0; i < row_at; ++i)
    if (table.records[i].comment) above.push_back(i);
  while (!above.empty() && row_at < table.records.size()) {
    const CsvRecord& comment = table.records[above.back()];
    CsvRecord split{.fields = split_line(comment.fields.front(), table.dialect.separator), .line = comment.line};
    if (split.fields.size() != without_trailing(first_row->fields) || !table.is_words(split)) break;
    if (table.csv.units.empty() && is_units_row(split) && above.size() > 1) {
      table.csv.units = split.fields;
      above.pop_back();
      continue;
    }
    table.csv.took.push_back(fmt::format("the heading in the comment of line {}", comment.line));
    use_heading(table, split.fields, comment.line);
    table.first_row = row_at;
    table.heading = row_at;  // comments before it stay comments
    return;
  }
  if (row_at == table.records.size())
    refuse_data(table.csv.file, "is empty: there is no header line", "the first line names the columns");
  refuse_data(table.line(*first_row), "there are numbers where the header line belongs",
              "the first line names the columns");
}

/// Which decimal mark the numbers have, by those that can be read in one way alone.
DecimalMark find_mark(const Table& table) {
  struct Place {
    const CsvRecord* record = nullptr;
    std::string field;
  };
  Place point, comma, maybe_comma;
  for (std::size_t i = table.first_row; i < table.records.size(); ++i) {
    const CsvRecord& record = table.records[i];
    if (record.comment) continue;
    for (const std::string& field : record.fields) {
      if (field.find_first_of(".,") == std::string::npos) continue;
      const Evidence evidence = decimal_evidence(field);
      Place* place = evidence == Evidence::point         ? &point
                     : evidence == Evidence::comma       ? &comma
                     : evidence == Evidence::maybe_comma ? &maybe_comma
                                                         : nullptr;
      if (place != nullptr && place->record == nullptr) *place = {&record, field};
    }
  }
  // A comma that parts columns stands in a quoted text, too: it is a decimal mark only where no number has a point.
  if (table.dialect.separator == ',')
    return comma.record != nullptr && point.record == nullptr ? DecimalMark::comma : DecimalMark::point;
  const char* const remedy = "write every number with a decimal point and without a mark for thousands";
  if (comma.record != nullptr && point.record != nullptr)
    refuse_data(table.line(*comma.record),
                fmt::format("'{}' has a decimal comma, but '{}' in line {} a decimal point", comma.field, point.field,
                            point.record->line),
                remedy);
  if (maybe_comma.record != nullptr && comma.record == nullptr)
    refuse_data(table.line(*maybe_comma.record),
                fmt::format("'{}' may be {} or {}", maybe_comma.field,
                            plain_number(maybe_comma.field, DecimalMark::comma).value_or("?"),
                            plain_number(maybe_comma.field, DecimalMark::point).value_or("?")),
                remedy);
  if (comma.record == nullptr) return DecimalMark::point;
  for (std::size_t i = table.first_row; i < table.records.size(); ++i)
    for (const std::string& field : table.records[i].fields)
      if (!table.records[i].comment && decimal_evidence(field) == Evidence::maybe_point)
        refuse_data(
            table.line(table.records[i]),
            fmt::format("'{}' may be a decimal number or thousands: other numbers of the table have a decimal comma",
                        field),
            remedy);
  return DecimalMark::comma;
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

void read_rows(Table& table) {
  const std::size_t columns = table.csv.headings.size();
  std::size_t end = table.records.size();
  const auto bare = [](const CsvRecord& record) { return without_trailing(record.fields) == 0; };
  while (end > table.first_row && !table.records[end - 1].comment && bare(table.records[end - 1])) --end;
  const std::size_t with_footer = end;
  while (end > table.first_row &&
         (table.records[end - 1].comment || (table.is_words(table.records[end - 1]) &&
                                             without_trailing(table.records[end - 1].fields) == 1 && columns > 1)))
    --end;
  std::size_t footers = 0;
  for (std::size_t i = end; i < with_footer; ++i) footers += table.records[i].comment ? 0 : 1;
  if (footers > 0) table.csv.took.push_back(fmt::format("{} lines of words below the table left out", footers));
  const DecimalMark mark = find_mark(table);
  if (mark == DecimalMark::comma) table.csv.took.push_back("decimal commas");
  std::size_t trailing = 0, repeated = 0;
  for (std::size_t i = table.first_row; i < end; ++i) {
    CsvRecord& record = table.records[i];
    if (record.comment) continue;
    if (record.fields.size() > columns && without_trailing(record.fields) <= columns) {
      record.fields.resize(columns);
      ++trailing;
    }
    if (record.fields == table.csv.headings) {
      ++repeated;
      continue;
    }
    if (record.fields.size() != columns)
      refuse_data(table.line(record),
                  fmt::format("has {} fields where the header has {}", record.fields.size(), columns),
                  wrong_count(table, record));
    for (std::string& field : record.fields)
      if (auto plain = plain_number(field, mark)) field = std::move(*plain);
    table.csv.rows.push_back({std::move(record.fields), record.line});
  }
  if (trailing > 0) table.csv.took.push_back("separators behind the last column left out");
  if (repeated > 0) table.csv.took.push_back(fmt::format("the heading again in {} lines left out", repeated));
}

/// Names and units of the columns; a unit in the heading counts before one in a row, and that before one in a comment.
void read_columns(Table& table) {
  Csv& csv = table.csv;
  csv.units.resize(csv.headings.size());
  std::map<std::string, std::size_t> names, whole;
  for (std::size_t i = 0; i < csv.headings.size(); ++i) {
    const std::string& heading = csv.headings[i];
    if (!heading.empty() && !whole.emplace(heading, i).second)
      refuse_data(fmt::format("{}:{}", csv.file, csv.header_line),
                  fmt::format("the column '{}' is there twice", heading), "rename or remove one");
    Heading split = read_heading(heading);
    if (!split.unit.empty()) csv.units[i] = std::move(split.unit);
    csv.columns.push_back(std::move(split.name));
    ++names[csv.columns.back()];
  }
  for (std::size_t i = 0; i < csv.columns.size(); ++i)
    if (names[csv.columns[i]] > 1) csv.columns[i] = csv.headings[i];
  for (const std::string& comment : csv.comments) {
    if (!comment.starts_with("units: ")) continue;
    std::string list = comment.substr(7, comment.find(';') - 7) + ",";
    for (std::size_t at = 0, comma = 0; (comma = list.find(',', at)) != std::string::npos; at = comma + 1) {
      const Heading split = read_heading(std::string_view(list).substr(at, comma - at));
      const auto found = std::find(csv.columns.begin(), csv.columns.end(), split.name);
      if (found == csv.columns.end() || split.unit.empty()) continue;
      std::string& unit = csv.units[found - csv.columns.begin()];
      if (unit.empty()) unit = split.unit;
    }
  }
}

}  // namespace

std::optional<std::size_t> Csv::find(std::string_view column) const {
  for (const std::vector<std::string>* names : {&columns, &headings}) {
    const auto found = std::find(names->begin(), names->end(), column);
    if (found != names->end()) return static_cast<std::size_t>(found - names->begin());
  }
  return {};
}

std::size_t Csv::column(std::string_view name) const {
  if (const auto found = find(name)) return *found;
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
    read_columns(table);
    return std::move(table.csv);
  }
  table.dialect = find_dialect(text);
  if (const std::string name = separator_name(table.dialect.separator); !name.empty())
    table.csv.took.push_back("separated by " + name);
  table.records = read_records(text, table.dialect, file);
  find_heading(table);
  for (std::size_t i = 0; i < table.first_row; ++i)
    if (table.records[i].comment && table.records[i].line != table.csv.header_line)
      table.csv.comments.push_back(table.records[i].fields.front());
  read_columns(table);
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
