#pragma once
// OUT/slurm/campaign.json: which runs are with Slurm, in which jobs. It is written before a job is submitted and after,
// so that a later start of the program finds the jobs of one that was killed at any moment.
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "campaign/slurm_jobs.hpp"

namespace campaign {

struct SlurmJob {
  std::string id;  ///< Slurm's number; empty while sbatch has not said that the job is there
  int tasks = 0;
};

/// A run that is with Slurm and has no result yet.
struct SlurmRun {
  std::string job;  ///< name
  int task = 0;
  int tries = 1;            ///< RunHistory::tries
  std::uint64_t steps = 0;  ///< that its file held when it was submitted
};

struct SlurmRecord {
  std::string prefix;                    ///< of the jobs' names: "demcal-quick-1f3a9c20"
  int next = 1;                          ///< number of the next job
  std::map<std::string, SlurmJob> jobs;  ///< by name; those that have runs
  std::map<std::string, SlurmRun> runs;  ///< by the run's name (run_name)
  std::string saved = {};                ///< the text that the file holds
};

std::string slurm_folder(const std::string& out);  ///< OUT/slurm

/// What the folder remembers; with a new prefix, and no runs, where it remembers nothing or the file is damaged.
SlurmRecord load_slurm_record(const std::string& out, const std::string& study);
/// Writes it, without the jobs that no run is with any more.
void save_slurm_record(const std::string& out, SlurmRecord& record);

/// The numbers of the jobs, for scancel.
std::vector<std::string> job_ids(const SlurmRecord& record);

}  // namespace campaign
