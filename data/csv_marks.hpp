#pragma once
// Which decimal mark the numbers of a table have. One number that can be read in one way alone decides for all; where
// none does and two readings remain, the table is refused.
#include "data/csv_table.hpp"
#include "data/number_text.hpp"

namespace data {

/// Finds the mark by the numbers that can be read in one way alone. Between commas, a comma in quotes may stand in a
/// text: it is a decimal mark only where no number has a point. Notes in `texts` the columns of remarks where only
/// these columns disagree.
DecimalMark find_mark(CsvTable& table);

}  // namespace data
