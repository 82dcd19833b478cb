#pragma once
// Confirmation of posteriors by runs of the simulation. Orchestration without words: `demcal calibrate --verify N` says
// what comes of it.
//
// OUT/verify-runs.csv lists the runs of a round. While it is there, rows of the table at its points are held back from
// the surrogates, so a round that was interrupted, or whose runs another code makes, starts again where it stood.
#include <optional>
#include <string>
#include <vector>

#include "campaign/posterior_runs.hpp"
#include "uq/refine/verification.hpp"

namespace campaign {

/// A run of a round and the case whose posterior it confirms.
struct ListedRun {
  PlannedRun run;
  std::string case_name;
  std::string label;  ///< "draw 3", "equivalent point 2"
};

/// `points` points of each case's posterior, its equivalent points first, then draws spread over it; each at up to
/// three of the measured settings of the controls (lowest, middle, highest), with a seed that the table does not have.
std::vector<ListedRun> verification_runs(const Workspace& workspace, const StudyRows& rows,
                                         const uq::Calibration& calibration, int points);

void write_verify_runs(const Workspace& workspace, const std::vector<ListedRun>& runs);
std::vector<ListedRun> read_verify_runs(const Workspace& workspace);

/// The table split: rows that are runs of the list, in its order (none where a run is missing), and all others.
struct HeldBack {
  data::RunTable others;
  std::vector<std::optional<data::RunRow>> listed;
  bool complete() const;
};
HeldBack hold_back(const Workspace& workspace, const data::RunTable& table, const std::vector<ListedRun>& runs);

/// Per case of the study, in its order: its runs beside the surrogates, which have not seen them. A case without runs
/// has no values.
std::vector<uq::VerificationReport> verify_cases(const Workspace& workspace,
                                                 const std::vector<uq::FittedSurrogate>& surrogates,
                                                 const std::vector<ListedRun>& runs, const HeldBack& held);

}  // namespace campaign
