#pragma once
// Which columns of a CSV are those of a study's run table, and what is to be said of the others.
#include <optional>
#include <vector>

#include "data/csv.hpp"
#include "data/finding.hpp"
#include "data/run_table.hpp"

namespace data {

struct TableColumns {
  std::vector<std::size_t> inputs, outputs;
  std::vector<std::optional<std::size_t>> errors;  ///< none: nobody stated them, and 0 stands for it
  std::optional<std::size_t> material, seed, settings, isa, origin, cpu_seconds, state, unreliable;
  std::vector<std::size_t> status;  ///< columns that say how a run ended
  std::vector<std::size_t> unread;  ///< columns that nobody asks for
};

/// Throws InputError (65) where a column of an input or output is missing.
TableColumns find_columns(const Csv& csv, const RunTable& table, const Study& study);

/// Names the columns that do not enter, and what those of other codes' names do.
std::vector<Finding> column_findings(const Csv& csv, const TableColumns& at, const RunTable& table);

}  // namespace data
