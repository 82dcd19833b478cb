#pragma once
// Training around the posterior: how much of it the surrogates leave uncertain, and which runs reduce that part. This
// is orchestration without words: `demcal train --until posterior` and `demcal calibrate --verify` say what comes of
// it.
#include <optional>
#include <string>
#include <vector>

#include "campaign/run_batch.hpp"
#include "campaign/study_rows.hpp"
#include "uq/calibrate/calibrate.hpp"
#include "uq/posterior/surrogate_share.hpp"
#include "uq/refine/next_runs.hpp"

namespace campaign {

/// The posteriors of all cases with the rows so far.
struct Assessment {
  std::vector<uq::FittedSurrogate> surrogates;
  std::vector<uq::SampledCase> cases;      ///< in the study's order
  std::vector<uq::SurrogateShare> shares;  ///< surrogate's share of each case, in the study's order
  std::size_t worst = 0;                   ///< the case with the largest share
  double share() const { return shares.empty() ? 0.0 : shares[worst].share; }
  /// Whether the surrogates' share is at most this in every case, as far as converged draws tell.
  bool settled(double most) const;
};

/// Assesses the posteriors. The result depends on the rows and the study alone, not on the order of the rows.
Assessment assess(const Workspace& workspace, const StudyRows& rows);

/// The runs that take most from the integrated variance of the posteriors (uq/refine/next_runs.hpp). `tried` counts
/// runs that failed before, so that other runs are chosen.
struct ChosenRuns {
  std::vector<PlannedRun> runs;
  int replicates = 0;            ///< number of them at points that have runs
  double variance_before = 0.0;  ///< of the posterior density, share of its mean square; the worst case's
  double variance_after_expected = 0.0;
};
ChosenRuns choose_runs(const Workspace& workspace, const StudyRows& rows, const Assessment& assessment, int runs,
                       int tried = 0);

/// The run that gives row `row` of a case's group at the unknowns u, in five digits.
Point point_at(const Workspace& workspace, const std::vector<uq::FittedSurrogate>& surrogates,
               const uq::RowGroup& group, Eigen::Index row, const Eigen::VectorXd& u);

/// The first points of each material's training design that have no row, so that a surrogate can be fitted at all:
/// five an input, ten at least, and no more than the study's own design. After them, points of the design until the
/// runs reach every measured control as far as a case asks for (uq::control_reach).
std::vector<PlannedRun> starting_runs(const Workspace& workspace, const data::RunTable& table);

/// A seed that no row at this point has: the study's seed, or the first free one after it.
std::uint64_t free_seed(const Workspace& workspace, const data::RunTable& table, const std::vector<PlannedRun>& planned,
                        const Point& point);

/// Contents of OUT/posterior-runs.csv: the runs of a campaign around the posterior that is not finished. Columns:
/// material, parameters and controls in the study's units, seed.
struct PosteriorRuns {
  std::vector<PlannedRun> runs;
  std::optional<int> left;  ///< runs that the campaign may still make, those listed included; none: no such limit
};
void write_posterior_runs(const Workspace& workspace, const PosteriorRuns& next);
/// Reads OUT/posterior-runs.csv; none where there is no file.
std::optional<PosteriorRuns> read_posterior_runs(const Workspace& workspace);

/// Runs of the list that the table lacks.
std::vector<PlannedRun> without_rows(const Workspace& workspace, const std::vector<PlannedRun>& runs,
                                     const data::RunTable& table);

/// Median CPU time of the table's runs [s]; 0 when no row states one.
double median_run_time(const data::RunTable& table);

}  // namespace campaign
