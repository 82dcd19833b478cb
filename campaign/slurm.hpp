#pragma once
// Runs made by Slurm: submitted as array jobs, followed, collected. What is kept is what a batch on this machine keeps
// (run_batch.hpp), so the table is the same.
//
// OUT/slurm holds campaign.json (slurm_record.hpp), of each job its list of runs, its script, and the output of its
// tasks in log/. A run that is with Slurm already is followed, not submitted again: a later call with the same runs
// picks up where the last one left. A task may be started more than once: it makes what is missing. A task that has
// left the queue without all of its results is submitted again, run by run.
#include <functional>

#include "campaign/run_batch.hpp"
#include "data/program.hpp"

namespace campaign {

struct SlurmOptions {
  std::vector<std::string> program;       ///< command that starts this program on this study to make a task's runs
  std::vector<std::string> options = {};  ///< options of sbatch: "--partition=short"
  int runs_per_task = 0;                  ///< 0: as many as make about ten minutes
  int at_once = 0;                        ///< tasks of a job at the same time; 0: as many as Slurm starts
  bool detach = false;                    ///< return as soon as all is submitted
  int most_tries = 3;                     ///< submissions of a run; those that brought it further do not count
  double first_wait = 1.0;                ///< s between two looks at the queue; it grows
  double longest_wait = 20.0;             ///< longest wait between two looks, s
  std::function<data::ProgramEnd(const data::ProgramCall&)> start = data::run_program;
};

/// Makes the runs with Slurm. Returns when all runs have ended, when `batch.stop` is requested (the jobs stay), or as
/// SlurmOptions::detach says. `batch.jobs` has no meaning here. While the controller does not answer it waits, and says
/// so. Throws InputError: 69 where Slurm's programs are missing, 64 where sbatch refuses the job, 78 where the rig
/// makes a run nonsense.
BatchResult run_on_slurm(const Workspace& workspace, const std::vector<PlannedRun>& runs, data::RunTable table,
                         const BatchOptions& batch, const SlurmOptions& options);

/// How many of the runs an earlier call left with Slurm, as OUT/slurm/campaign.json says.
std::size_t runs_with_slurm(const Workspace& workspace, const std::vector<PlannedRun>& runs);

}  // namespace campaign
