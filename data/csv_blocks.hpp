#pragma once
// The blocks of a table, each a heading and the rows below it. A logger that appends to its file writes one block a
// session, the software of an instrument one a hold.
#include <string>
#include <vector>

#include "data/csv_records.hpp"

namespace data {

struct CsvBlock {
  std::vector<std::string> headings;
  std::vector<std::string> units;       ///< from a row below the heading, without brackets; empty: no such row
  bool in_comment = false;              ///< the heading stands in a comment
  int line = 0, units_line = 0;         ///< lines of heading and units in the file; units_line 0: no row of units
  std::size_t heading = 0;              ///< index of its record; of a heading in a comment, the first row
  std::size_t first = 0, end = 0;       ///< the block's records: its rows, and lines among them
  std::size_t rows = 0;                 ///< rows with as many fields as the heading
  std::size_t footers = 0;              ///< lines of words below the rows of the last block
  std::vector<std::string> statistics;  ///< names that the lines of statistics below those rows bear: "Average"
};

/// Every heading with its rows, in the order of the file. A line of words is a heading where a row with as many fields
/// follows, perhaps below a row of units; among the rows of another heading it has to be told from a row of words: by
/// the same names, an empty line above it, units, another number of fields, or columns that hold numbers above it and
/// words below. A comment is a heading where there is no other, or where it names the columns of the one above.
std::vector<CsvBlock> find_blocks(const std::vector<CsvRecord>& records, char separator);

/// Whether two headings name the same columns, in one order; units do not count, nor do upper and lower case.
bool same_columns(const std::vector<std::string>& one, const std::vector<std::string>& other);

/// Whether the line is a row (a number in it, or no value at all), and whether it is made of words alone.
bool is_row(const CsvRecord& record);
bool is_words(const CsvRecord& record);

/// A line of measurements rather than of a preamble's names and values: it begins with a number and holds two, or holds
/// one word among three numbers and more.
bool is_measurement(const CsvRecord& record);

bool holds_number(const CsvRecord& record);

/// The first field of a line that begins with the name of a statistic ("Average", "Std. dev.:"); empty where none does.
std::string statistic_of(const CsvRecord& record);

/// The number of fields up to the last one that is not empty.
std::size_t without_trailing(const std::vector<std::string>& fields);

}  // namespace data
