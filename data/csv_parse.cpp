// From the bytes of a file to a table: text, dialect, records, the table among them, its columns, its rows.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "data/atomic_file.hpp"
#include "data/csv.hpp"
#include "data/csv_columns.hpp"
#include "data/csv_marks.hpp"
#include "data/csv_table.hpp"
#include "data/error.hpp"
#include "data/lvm.hpp"
#include "data/number_text.hpp"
#include "data/origin.hpp"
#include "data/text_encoding.hpp"

namespace data {
namespace {

/// Files that are no tables of text, by how they begin.
void refuse_other_kinds(std::string_view bytes, const std::string& file) {
  using std::string_view_literals::operator""sv;
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 15> kinds{
      {{"PK\x03\x04"sv, "a spreadsheet (.xlsx, .ods) or a zip archive"},
       {"\xd0\xcf\x11\xe0"sv, "a spreadsheet of an older kind (.xls)"},
       {"\x1f\x8b"sv, "compressed (gzip)"},
       {"\x89HDF"sv, "an HDF5 or MATLAB file"},
       {"MATLAB 5.0"sv, "a MATLAB file"},
       {"TDSm"sv, "a LabVIEW TDMS file"},
       {"MDF "sv, "an MDF measurement (.mf4, .dat)"},
       {"%PDF"sv, "a PDF"},
       {"<?xml"sv, "XML"},
       {"<html"sv, "a web page"},
       {"<!DOCTYPE"sv, "a web page"},
       {"<table"sv, "a web page"},
       {"{\\rtf"sv, "a word processor's file"},
       {"{\""sv, "JSON"},
       {"[{"sv, "JSON"}}};
  const std::size_t mark = bytes.starts_with("\xef\xbb\xbf"sv) ? 3 : 0;
  for (const auto& [beginning, what] : kinds)
    if (bytes.substr(mark).starts_with(beginning))
      refuse_data(file, fmt::format("is {}, not a table of text", what), "save or export the table as CSV");
}

/// Zeros at the end are what a logger left that lost power; the line before them may have lost its end.
std::string without_zero_tail(std::string text, CsvTable& table) {
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

std::string wrong_count(const CsvTable& table, const CsvRecord& record) {
  const bool numbers = std::all_of(record.fields.begin(), record.fields.end(), [](const std::string& field) {
    return plain_number(field, DecimalMark::point).has_value();
  });
  if (record.fields.size() < table.csv.headings.size()) return "complete the line; the file may have been cut off here";
  if (table.dialect.separator == ',' && numbers)
    return "its commas may be decimal marks as well as separators, which cannot be told apart: part the columns by "
           "semicolons";
  return table.dialect.separator == ',' ? "a field with a comma in it needs quotes" : "check the line";
}

/// A row's fields, as many as there are columns; nothing of a line that repeats the heading or its units.
std::optional<std::vector<std::string>> fields_of(const CsvTable& table, const CsvRecord& record,
                                                  std::size_t& trailing) {
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

void read_rows(CsvTable& table) {
  const DecimalMark mark = find_mark(table);
  if (mark == DecimalMark::comma) table.csv.took.push_back("decimal commas");
  std::size_t trailing = 0, repeated = 0, converted = 0;
  for (std::size_t k = 0; k < table.blocks.size(); ++k) {
    const CsvBlock& block = table.blocks[k];
    const auto changes =
        k == 0 ? std::vector<std::optional<UnitChange>>(table.csv.headings.size()) : changes_to_first(table, k);
    converted += std::any_of(changes.begin(), changes.end(), [](const auto& one) { return one.has_value(); });
    if (k > 0) table.csv.sections.push_back(table.csv.rows.size());
    for (std::size_t i = block.first; i < block.end; ++i) {
      const CsvRecord& record = table.records[i];
      if (record.comment || without_trailing(record.fields) == 0) continue;
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
  const CsvBlock& last = table.blocks.back();
  if (last.footers > 0)
    table.csv.took.push_back(fmt::format("{} of words below the table left out", counted(last.footers, "line")));
  if (!last.statistics.empty())
    table.csv.took.push_back(fmt::format("{} of statistics below the table left out ({})",
                                         counted(last.statistics.size(), "line"), fmt::join(last.statistics, ", ")));
}

}  // namespace

Csv parse_csv(const std::string& bytes, const std::string& file) {
  CsvTable table;
  table.csv.file = file;
  refuse_other_kinds(bytes, file);
  if (origin_of_bytes(bytes) == Origin::changed)
    table.csv.took.push_back("it stands, though changed since demcal wrote it");
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

}  // namespace data
