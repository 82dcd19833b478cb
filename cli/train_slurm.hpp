#pragma once
// demcal train --slurm: its options, what a task of a job does, and what is said when runs are left with Slurm.
#include <optional>
#include <string>
#include <vector>

#include "campaign/slurm.hpp"
#include "cli/command.hpp"

namespace cli {

struct SlurmChoice {
  bool slurm = false, detach = false;
  std::vector<std::string> options;  ///< options of sbatch, with their hyphens
  int runs_per_task = 0;
  std::string task_list;  ///< the list of runs in a task's own call
  int task = 0;
};

void add_slurm_options(CLI::App& command, SlurmChoice& choice);

/// The options of Slurm by which a task starts this program with the study and settings of this command line.
SlurmOptions slurm_options(const Common& common, const SlurmChoice& choice, const CLI::App& command);

/// Does what a task of an array job does: makes its runs, each kept in its file, and nothing else.
data::ExitStatus make_task(const Common& common, const SlurmChoice& choice);

/// Says which runs are not made, and what becomes of them. Returns the exit status where there are such runs.
std::optional<data::ExitStatus> tell_left(const Common& common, const BatchResult& result, bool detached);

nlohmann::json slurm_json(const LeftWithSlurm& left);

}  // namespace cli
