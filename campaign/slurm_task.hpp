#pragma once
// The list of an array job, OUT/slurm/JOB.csv, and a task that makes its runs.
#include <stop_token>
#include <string>
#include <vector>

#include "campaign/run_batch.hpp"

namespace campaign {

/// A line for each run: its name (run_name), its point in the study's units, its seed.
void write_task_list(const Workspace& workspace, const std::string& path, const std::vector<PlannedRun>& runs);

struct TaskOutcome {
  std::size_t ended = 0;  ///< number of runs that have ended, now or before
  std::vector<std::string> failures;
  bool interrupted = false;
};
/// Makes the runs of a task, each in its file in OUT/runs, one after the other; it writes nothing else. What other
/// tasks have made is not made again, so a task may be started any number of times. Throws InputError (78) where the
/// study was changed since the list was written.
TaskOutcome run_task(const Workspace& workspace, const std::string& list, int task, int runs_per_task,
                     const std::stop_token& stop);

}  // namespace campaign
