#pragma once
// Tables of comma-separated values (RFC 4180), as spreadsheets and scripts write them: a header line, quoted fields,
// CRLF or LF, an optional byte-order mark. Lines that begin with '#' are comments, empty lines are skipped.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace data {

struct CsvRow {
  std::vector<std::string> fields;  ///< as many as there are columns, without surrounding blanks
  int line = 0;                     ///< in the file, from 1
};

struct Csv {
  std::string file;                   ///< as named in messages
  std::vector<std::string> comments;  ///< at the head of the file, without '#' and the blank after it
  std::vector<std::string> columns;
  int header_line = 0;
  std::vector<CsvRow> rows;

  std::optional<std::size_t> find(std::string_view column) const;
  /// Throws InputError (65) naming the columns that are there.
  std::size_t column(std::string_view name) const;
  /// Of a row's field. Throws InputError (65) with line and column name; `nan` and an empty field give NaN.
  double number(const CsvRow& row, std::size_t column) const;
  std::string place(const CsvRow& row, std::size_t column) const;  ///< "bench.csv:3: speed"
};

/// Reads a file. Throws InputError: 66 missing; 65 no header, a column named twice, a row with too few or too many
/// fields, a quote that does not end.
Csv read_csv(const std::string& path);
Csv parse_csv(const std::string& text, const std::string& file);

/// A field as it is written: quoted where it must be.
std::string csv_field(std::string_view text);

/// The shortest decimal that reads back to the same double.
std::string shortest(double value);

}  // namespace data
