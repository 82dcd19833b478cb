#pragma once
// Runs of a campaign made with progress, here or by Slurm, for each command that makes some.
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "campaign/slurm.hpp"
#include "cli/command.hpp"

namespace cli {

struct RunMaking {
  std::string what = "training runs";      ///< the progress's name
  int jobs = 1;                            ///< at the same time, of those that are made here
  std::optional<SlurmOptions> slurm = {};  ///< none: they are made here
};

/// `kept`: rows of other settings, written back beside the table's. Throws as run_batch and run_on_slurm do.
BatchResult make_runs(const Common& common, const Workspace& workspace, const std::vector<PlannedRun>& runs,
                      data::RunTable table, const std::vector<data::RunRow>& kept, const RunMaking& how,
                      std::stop_token stop);

/// Says what was odd about runs, and which failed.
void say_faults(const Common& common, const std::vector<std::string>& warnings,
                const std::vector<std::string>& failures);

}  // namespace cli
