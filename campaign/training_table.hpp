#pragma once
// OUT/training.h5 and training.csv: written so that no row is ever lost and their order does not depend on how they
// came about.
#include "campaign/workspace.hpp"
#include "data/run_table.hpp"

namespace campaign {

/// Reads OUT/training.h5. Where it is damaged, the rows are those of training.csv beside it, and `notes` says so. Where
/// that file is no better, throws InputError (65).
data::TableRead read_own_table(const Workspace& workspace, std::vector<std::string>& notes);

/// Writes both files: the rows in use, and those of other settings that the table held, ordered by material, then by a
/// hash of what identifies a row. So a campaign that was interrupted ends with the table of one that was not.
void write_tables(const Workspace& workspace, const data::RunTable& rows, const std::vector<data::RunRow>& kept);

}  // namespace campaign
