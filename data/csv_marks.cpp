#include "data/csv_marks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "data/error.hpp"

namespace data {
namespace {

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

MarkEvidence mark_evidence(const CsvTable& table) {
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

[[noreturn]] void refuse_two_readings(const CsvTable& table, const CsvRecord& record, const std::string& field) {
  refuse_data(table.line(record),
              fmt::format("'{}' may be {} or {}", field, plain_number(field, DecimalMark::comma).value_or("?"),
                          plain_number(field, DecimalMark::point).value_or("?")),
              plain_decimals);
}

/// Where no number of a table says what a point is, a column of whole numbers and of 1.012 may be one of thousands:
/// 950, 1012. It is asked back where its numbers lie closer together so.
void ask_for_thousands(const CsvTable& table, const MarkEvidence& found) {
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
std::vector<bool> text_columns(const CsvTable& table) {
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

}  // namespace

DecimalMark find_mark(CsvTable& table) {
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

}  // namespace data
