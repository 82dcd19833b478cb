#pragma once
// A table's text as records of fields, before anything is known of heading and rows.
#include <string>
#include <string_view>
#include <vector>

#include "data/csv_dialect.hpp"

namespace data {

struct CsvRecord {
  std::vector<std::string> fields;
  int line = 0;
  bool comment = false;    ///< a comment; `fields` then holds its text alone
  bool gap_above = false;  ///< an empty line stands above it
};

/// Cuts the text into records. Throws InputError (65): a quote that does not end, text behind a closing quote.
std::vector<CsvRecord> read_records(std::string_view text, const Dialect& dialect, const std::string& file);

}  // namespace data
