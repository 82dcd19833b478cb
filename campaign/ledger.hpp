#pragma once
// The outcome of the runs of a batch, taken one after the other, whoever makes them: rows of the table, failures,
// warnings.
#include <exception>
#include <string>
#include <unordered_map>
#include <vector>

#include "campaign/point.hpp"
#include "data/progress.hpp"

namespace campaign {

/// Runs of a batch that Slurm has, or is still to get (campaign/slurm.hpp).
struct LeftWithSlurm {
  std::size_t there = 0;          ///< runs that are with Slurm
  std::size_t cancelled = 0;      ///< runs whose tasks somebody cancelled; a later call submits them again
  std::size_t refused = 0;        ///< runs that a limit of Slurm's kept out; a later call submits them
  std::vector<std::string> jobs;  ///< numbers of the jobs that are left
  bool any() const { return there + cancelled + refused > 0; }
};

struct BatchResult {
  data::RunTable table;               ///< the rows there were, and one for each finished run
  std::size_t finished = 0;           ///< number of finished runs
  std::size_t unsteady = 0;           ///< finished runs that are not of the steady flow
  std::vector<bool> ended;            ///< per run: finished or failed
  std::vector<std::string> failures;  ///< point and reason of each failed run
  std::vector<std::string> warnings;  ///< not that a run is unsteady where the study takes unsteady runs
  std::exception_ptr error;           ///< error of a worker; the others stopped
  LeftWithSlurm left = {};            ///< runs left with Slurm; none where the runs are made here
};

class Ledger {
 public:
  Ledger(data::RunTable table, std::size_t runs);

  /// Run number `index` of the batch has finished or failed. `own` is the study under the run's seed. The row takes the
  /// place of an earlier, shorter run of the point. `progress` is told; it may be none.
  void take(std::size_t index, const Workspace& own, const Point& point, const dem::RunResult& run,
            data::Progress* progress);
  /// Run number `index` has failed without a result.
  void take_failure(std::size_t index, const std::string& point_and_reason, data::Progress* progress);

  BatchResult result;

 private:
  std::unordered_map<std::string, std::size_t> places_;  ///< places of rows, by their key
};

}  // namespace campaign
