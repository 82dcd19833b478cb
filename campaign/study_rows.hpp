#pragma once
// What a study learns from: the rows shipped with it and those of its own campaign.
#include <optional>
#include <string>
#include <vector>

#include "campaign/workspace.hpp"
#include "data/finding.hpp"
#include "data/run_table.hpp"

namespace campaign {

/// The rows shipped with the study and those in OUT/training.h5, merged; rows of other settings are left out.
struct StudyRows {
  data::RunTable all;                   ///< all rows, whatever their state
  data::RunTable table;                 ///< rows to fit: of the steady flow, without outputs whose errors are not known
  std::optional<data::RunTable> low;    ///< rows of the cheaper level, where the study names some
  std::vector<std::string> notes;       ///< rows left out and why
  std::vector<data::RunRow> kept;       ///< rows of OUT/training.h5 under other settings: left out, and written back
  std::vector<data::Finding> findings;  ///< findings of the reading of the tables
};
StudyRows study_rows(const Workspace& workspace);

/// Throws data::InputError (66) when no row can be learnt from; `study`: as the user named it.
void require_rows(const Workspace& workspace, const StudyRows& rows, const std::string& study);

}  // namespace campaign
