#pragma once
// What the columns of a table are called and measured in.
#include <optional>
#include <vector>

#include "data/csv_table.hpp"
#include "data/unit.hpp"

namespace data {

/// Finds names and units of the columns out of headings, rows of units and comments.
void read_columns(Csv& csv);

/// The change from the unit of a block's column to that of the table's.
struct UnitChange {
  Unit from, to;
};

/// How the columns of block `k` change into those of the first one; a heading that is repeated to the letter has its
/// units. Throws InputError (65) where the two measure different things.
std::vector<std::optional<UnitChange>> changes_to_first(const CsvTable& table, std::size_t k);

}  // namespace data
