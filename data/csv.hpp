#pragma once
// Text tables as spreadsheets, loggers, instruments and scripts write them: one reader for observations, run tables,
// torque logs and positions. It finds out how a table is written and says so in `took`; what could be read in two ways
// is refused, never guessed.
//
//   text       UTF-8, UTF-16 and older encodings (text_encoding.hpp); any line ends; zeros behind the end, as of a logger that lost power
//   columns    parted by commas, semicolons, tabs, bars or blanks; "sep=;"; quotes; separators behind the last column
//   numbers    decimal point or comma, thousands, exponents of Fortran: in `fields` as plain decimals
//   missing    empty, nan, N/A and other words (is_missing of number_text.hpp)
//   heading    behind any preamble, or in a comment; a unit in it, in a row below it, or in a line "# units: a [m]"
//   blocks     the heading again, as where a logger appended to its file: joined, units converted to the first one's
//   comments   lines that begin with '#', '%' or "//"
//   LabVIEW    measurement files (.lvm) by their headers (lvm.hpp)
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/unit.hpp"

namespace data {

struct CsvRow {
  std::vector<std::string> fields;  ///< as many as there are columns, without surrounding blanks; plain decimals
  int line = 0;                     ///< in the file, from 1
};

struct Csv {
  std::string file;                   ///< as named in messages
  std::vector<std::string> comments;  ///< above the first row, without '#' and the blank after it
  std::vector<std::string> columns;   ///< without their units
  std::vector<std::string> headings;  ///< the columns' names as the heading writes them
  std::vector<std::string> units;     ///< "" where none is given
  int header_line = 0;
  std::vector<CsvRow> rows;
  std::vector<std::size_t> sections;  ///< index of the first row below each further heading
  std::string no_time;                ///< why there is no column of times, where the file's form has one
  std::vector<std::string>
      took;  ///< how the table was read, where it is not plain CSV or not as demcal wrote it: "separated by semicolons"

  /// Finds a column by its name, with or without its unit. With Capitals::any, where no column is spelled so, "Speed"
  /// is found for speed and "Run Time" for run_time. Throws InputError (65) where two columns have the name and differ.
  enum class Capitals { as_written, any };
  std::optional<std::size_t> find(std::string_view column, Capitals capitals = Capitals::as_written) const;
  /// Whether two columns hold the same in every row.
  bool same_values(std::size_t one, std::size_t other) const;
  /// The column of this name, whatever its capitals. Throws InputError (65) naming the columns that are there.
  std::size_t column(std::string_view name) const;
  /// The number in a field of a row; NaN where there is no value. Throws InputError (65) with line and column name.
  double number(const CsvRow& row, std::size_t column) const;
  /// The number in a field of a column that need not hold any; NaN where it does not.
  double number_if_any(const CsvRow& row, std::size_t column) const;
  /// The least and the largest number of a column. None where a field is neither a number nor missing, or all are
  /// missing.
  std::optional<std::pair<double, double>> number_range(std::size_t column) const;
  std::string place(const CsvRow& row, std::size_t column) const;  ///< "bench.csv:3: speed"
  /// The unit of a column's numbers: the table's own where it gives one, else `wanted`. Throws InputError (65) where
  /// the two measure different things.
  Unit unit(std::size_t column, const Unit& wanted) const;
  /// `took` as one line: "bench.csv: read as UTF-16, separated by tabs"; empty for plain CSV.
  std::string took_line() const;
};

/// Reads a file. Throws InputError: 66 missing; 65 no header, a column named twice, a row with too few or too many
/// fields, a quote that does not end, two ways to read it.
Csv read_csv(const std::string& path);
Csv parse_csv(const std::string& text, const std::string& file);

/// A column and what it holds: "fill (from 200 to 300)", "fill (0.5 everywhere)", "note (text)".
std::string column_in_words(const Csv& csv, std::size_t column);

/// The text as a field of a CSV file, quoted where it must be.
std::string csv_field(std::string_view text);

/// The shortest decimal that reads back to the same double.
std::string shortest(double value);

}  // namespace data
