#pragma once
// The two files of a run table; read_table chooses by the ending.
#include <optional>
#include <string>
#include <string_view>

#include "data/run_table.hpp"

namespace data {

/// Whether a column of a CSV says how a run ended ("status", "converged"), and whether its field has a word of failure.
bool is_status_column(std::string_view name);
bool is_user_column(std::string_view name);  ///< "use", "include", "keep": the user's own choice of rows
bool says_failed(std::string_view column, std::string_view field);

/// The unit of this symbol, 1 where there is none; nothing where it is unknown.
std::optional<Unit> known_unit(const std::string& symbol);

/// The row's mean of an output that the study has no longer; NaN where it has none.
OutputMean kept_mean(const RunRow& row, const Column& column);

/// Whether a label of [training] leave_out ("31", "runs.csv:31") names the row at `place` ("runs.csv:31").
bool names_row(const std::string& label, const std::string& place);

/// Marks the rows that are not learnt from (data/run_table_marks.cpp) and adds the findings about them.
void mark_rows(TableRead& read, const Study& study);

TableRead read_table_hdf5(const std::string& path, const Study& study);
TableRead read_table_csv(const std::string& path, const Study& study);

}  // namespace data
