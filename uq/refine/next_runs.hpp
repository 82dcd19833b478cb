#pragma once
// The next batch of runs: those that are expected to take most from the integrated variance of the cases' posterior
// densities (uq/refine/acquire.hpp), each case's in shares of its own.
//
// Candidates of a material, in shares:
//   posterior   draws of a case's posterior: where its density is large
//   tempered    points of the prior kept with probability proportional to likelihood^(1/4): where the density may yet
//               turn out to be large
//   filling     scrambled Sobol points of the prior and of the ranges of the controls
//   replicates  points that have runs: another run with a seed of its own (replicate or explore)
// The first two stand at the measured settings of the controls in turn, every fourth at a setting anywhere in the
// range. The batch is picked one run at a time, each given those before it, so it does not crowd; the same candidate is
// picked again where a second seed is worth more than another place.
#include <Eigen/Dense>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "uq/refine/acquire.hpp"

namespace uq {

/// A case as it stands: its model and draws of its posterior.
struct CaseState {
  std::shared_ptr<const CaseModel> model;
  Eigen::MatrixXd draws;      ///< rows in u
  double log_evidence = 0.0;  ///< NaN: not known
};

struct CandidateOptions {
  int posterior = 96, tempered = 64, filling = 64;  ///< per material and case
  int replicates = 64;                              ///< per material, at most
};

/// What the batch is chosen from, and for.
struct Acquisition {
  std::vector<CaseState> cases;
  std::vector<RunPoint> existing;                           ///< runs that there are, pending ones included
  std::function<RunNoise(const Emulator& emulator)> noise;  ///< noise of one more run
  std::function<RunPoint(const RunPoint& point)> rounded;   ///< the point in digits that can be typed; empty: as it is
};

struct NextRunsOptions {
  int runs = 2;
  std::uint64_t seed = 0;
  CandidateOptions candidates;
  ReferenceOptions reference;
};

struct BatchRun {
  RunPoint point;
  bool replicate = false;  ///< the point has a run already, or is twice in the batch
  double reduction = 0.0;  ///< expected, summed over the cases, each in shares of its own integral of E p^2
};

struct Batch {
  std::vector<BatchRun> runs;
  std::vector<double> variance_before, variance_after;  ///< per case: integrated variance, share of integral E p^2
};

/// The run that gives row `row` of the group at u; what the emulator does not have as an input is 0.
RunPoint run_at(const RowGroup& group, Eigen::Index row, const Eigen::VectorXd& u);

/// Whether two runs set the same.
bool same_run(const RunPoint& a, const RunPoint& b);

/// Chooses the next batch. The result depends on the arguments alone.
Batch next_batch(const Acquisition& acquisition, const NextRunsOptions& options);

}  // namespace uq
