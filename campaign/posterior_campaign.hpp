#pragma once
// A campaign of runs where they sharpen the posterior, batch after batch, without words and without making the runs:
//   look    at the posterior with the rows so far, once no run of a list is left to make
//   choose  the next batch: what an interrupted one left, what a surrogate needs at the least, then the posterior's runs
//   take    what came of it
// until the surrogate's error is a small enough share of the posterior variance, or a limit is met. What is left of a
// batch stands in OUT/posterior-runs.csv at every moment, so that an interrupted campaign goes on.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "campaign/posterior_runs.hpp"

namespace campaign {

struct PosteriorLimits {
  double share = 0.1;  ///< of the posterior variance that may stay the surrogate's
  int batch = 1;       ///< runs
  int runs = 0;        ///< most new runs; 0: as many as the study's design has, or no limit where seconds is one
  std::optional<double> seconds;  ///< wall time
};

enum class CampaignEnding {
  enough,            ///< the share is reached
  runs_made,         ///< those asked for
  design_made,       ///< as many as the study's own design has
  time_up,           ///< for another run
  nothing_to_learn,  ///< no run is expected to tell more
  too_many_failed,
};

/// What came of all batches.
struct CampaignTotals {
  std::size_t finished = 0, unsteady = 0;
  std::vector<std::string> failures, warnings;
};

class PosteriorCampaign {
 public:
  /// Takes up what an unfinished campaign left in OUT. `workspace` must outlive the object.
  PosteriorCampaign(const Workspace& workspace, const PosteriorLimits& limits, StudyRows rows);

  bool continued() const { return continued_; }
  /// Runs that it may still make; none: no such limit.
  std::optional<int> runs_left() const;

  /// Assesses the posterior, unless runs of a list are still to be made; whether it did.
  bool look();
  /// Finds the next batch and writes it to OUT; false where the campaign has ended. `elapsed`: seconds since its start.
  bool choose(double elapsed);
  const std::vector<PlannedRun>& batch() const { return pending_; }
  bool chosen() const { return chosen_; }  ///< the batch is the posterior's; else it was listed before
  /// Rows to give to the batch; they come back with `take`.
  data::RunTable hand_over_rows() { return std::move(rows_.all); }
  void take(const BatchResult& result);
  /// Removes OUT/posterior-runs.csv: nothing is left to go on with.
  void finish() const;

  std::optional<CampaignEnding> ending() const { return ending_; }
  const StudyRows& rows() const { return rows_; }
  const Assessment& assessment() const { return assessment_; }
  bool assessed() const { return !assessment_.shares.empty(); }
  const CampaignTotals& totals() const { return totals_; }
  /// Further runs that the share's fall so far, taken as exponential in the number of runs, asks for; 0: not known.
  int runs_to_go() const;

 private:
  bool end(CampaignEnding ending);

  const Workspace& workspace_;
  PosteriorLimits limits_;
  StudyRows rows_;
  std::optional<int> most_;  // new runs
  bool continued_ = false, chosen_ = false;
  std::vector<PlannedRun> pending_;
  Assessment assessment_;
  std::vector<std::pair<std::size_t, double>> shares_;  // rows, and the worst case's share with them
  CampaignTotals totals_;
  std::optional<CampaignEnding> ending_;
};

}  // namespace campaign
