#pragma once
// The making of a campaign's runs with a progress display, here or by Slurm, for each command that makes some.
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "campaign/slurm.hpp"
#include "cli/command.hpp"

namespace cli {

struct RunMaking {
  std::string what = "training runs";      ///< name that the progress display shows
  int jobs = 1;                            ///< runs at the same time, of those that are made here
  std::optional<SlurmOptions> slurm = {};  ///< how Slurm makes the runs; none: they are made here
};

/// Makes the runs. `kept`: rows of other settings, written back beside the table's. Throws as run_batch and
/// run_on_slurm do.
BatchResult make_runs(const Common& common, const Workspace& workspace, const std::vector<PlannedRun>& runs,
                      data::RunTable table, const std::vector<data::RunRow>& kept, const RunMaking& how,
                      std::stop_token stop);

/// Says what was odd about runs, and which failed.
void say_faults(const Common& common, const std::vector<std::string>& warnings,
                const std::vector<std::string>& failures);

}  // namespace cli
