#include "cli/make_runs.hpp"

#include "campaign/run_batch.hpp"
#include "data/progress.hpp"

namespace cli {

BatchResult make_runs(const Common& common, const Workspace& workspace, const std::vector<PlannedRun>& runs,
                      data::RunTable table, const std::vector<data::RunRow>& kept, const RunMaking& how,
                      std::stop_token stop) {
  data::Progress progress(how.what, runs.size(),
                          {.style = common.quiet ? data::ProgressStyle::quiet : data::ProgressStyle::automatic});
  const BatchOptions batch{.jobs = how.jobs, .kept = kept, .stop = std::move(stop), .progress = &progress};
  return how.slurm ? run_on_slurm(workspace, runs, std::move(table), batch, *how.slurm)
                   : run_batch(workspace, runs, std::move(table), batch);
}

void say_faults(const Common& common, const std::vector<std::string>& warnings,
                const std::vector<std::string>& failures) {
  for (const std::string& warning : warnings) say(common, "warning: " + warning);
  for (const std::string& failure : failures) say(common, "warning: failed: " + failure);
}

}  // namespace cli
