#include "campaign/slurm_task.hpp"

#include <fmt/core.h>

#include "campaign/design.hpp"
#include "campaign/run_point.hpp"
#include "campaign/slurm_jobs.hpp"
#include "data/csv.hpp"

namespace campaign {
namespace {

// No parameter's name has a point in it.
constexpr const char* name_column = "run.name";

}  // namespace

void write_task_list(const Workspace& workspace, const std::string& path, const std::vector<PlannedRun>& runs) {
  PointColumn names{name_column, {}};
  for (const PlannedRun& run : runs) names.values.push_back(run_name(with_seed(workspace, run.seed), run.point));
  write_points(workspace, path, points_of(runs), {names, seeds_of(runs)});
}

TaskOutcome run_task(const Workspace& workspace, const std::string& list, int task, int runs_per_task,
                     const std::stop_token& stop) {
  const data::Csv csv = data::read_csv(list);
  const std::vector<PlannedRun> runs = read_runs(workspace, list);
  const TaskRuns own_runs = runs_of_task(task, runs_per_task, runs.size());
  TaskOutcome outcome;
  for (std::size_t i = own_runs.first; i < own_runs.end; ++i) {
    const Workspace own = with_seed(workspace, runs[i].seed);
    const std::string& listed = csv.rows[i].fields[csv.column(name_column)];
    if (const std::string name = run_name(own, runs[i].point); name != listed)
      throw data::InputError(
          data::ExitStatus::bad_study,
          {workspace.study.file, fmt::format("was changed since its runs were submitted: {} is now {}", listed, name),
           "start demcal train --slurm again: it submits the runs of the study as it is"});
    const dem::RunResult result =
        run_point(own, runs[i].point, {.path = run_path(own, runs[i].point), .keep_state = false, .stop = stop});
    if (result.status == dem::RunStatus::interrupted) {
      outcome.interrupted = true;
      return outcome;
    }
    ++outcome.ended;
    if (result.status == dem::RunStatus::failed)
      outcome.failures.push_back(
          fmt::format("{} {}: {}", runs[i].point.material, describe(own.study, runs[i].point), result.reason));
  }
  return outcome;
}

}  // namespace campaign
