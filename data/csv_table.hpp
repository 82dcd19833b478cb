#pragma once
// Which part of a text is the table: the block with the most rows (csv_blocks.hpp), and the others with the same
// columns. What stands above them is a preamble; a second table is refused.
#include <string>
#include <vector>

#include "data/csv.hpp"
#include "data/csv_blocks.hpp"
#include "data/csv_dialect.hpp"
#include "data/csv_records.hpp"

namespace data {

/// A table while it is read: what was found out of it so far.
struct CsvTable {
  Csv csv;
  Dialect dialect;
  std::vector<CsvRecord> records;
  std::vector<CsvBlock> blocks;  ///< with the same columns; the first one's heading is the table's
  std::vector<bool> texts;       ///< columns of remarks, whose numbers say nothing of the decimal mark; empty: none

  bool is_text(std::size_t column) const { return column < texts.size() && texts[column]; }
  std::string line(const CsvRecord& record) const { return csv.file + ":" + std::to_string(record.line); }
  /// Visits every line among the rows of the blocks that is no comment.
  template <class Visit>
  void each_row(Visit visit) const {
    for (const CsvBlock& block : blocks)
      for (std::size_t i = block.first; i < block.end; ++i)
        if (!records[i].comment) visit(records[i]);
  }
};

/// Chooses the blocks; says in `took` what was left out. Throws InputError (65) where there is no heading, or where
/// measurements would be lost.
void find_table(CsvTable& table);

/// The comments between a record and the first row of a block, without its heading.
std::vector<std::string> comments_above(const CsvTable& table, std::size_t from, const CsvBlock& block);

}  // namespace data
