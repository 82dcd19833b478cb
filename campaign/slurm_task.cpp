#include "campaign/slurm_task.hpp"

#include <fmt/core.h>

#include <charconv>

#include "campaign/design.hpp"
#include "campaign/run_point.hpp"
#include "campaign/slurm_jobs.hpp"
#include "data/csv.hpp"

namespace campaign {
namespace {

// No parameter's name has a point in it.
constexpr const char *name_column = "run.name", *seed_column = "run.seed";

std::uint64_t read_seed(const data::Csv& csv, const data::CsvRow& row) {
  const std::size_t column = csv.column(seed_column);
  const std::string& text = row.fields[column];
  std::uint64_t seed = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || rest != text.data() + text.size())
    throw data::InputError(data::ExitStatus::bad_data, {csv.place(row, column), fmt::format("'{}' is no seed", text),
                                                        "start demcal train --slurm again"});
  return seed;
}

}  // namespace

void write_task_list(const Workspace& workspace, const std::string& path, const std::vector<PlannedRun>& runs) {
  std::vector<Point> points;
  PointColumn names{name_column, {}}, seeds{seed_column, {}};
  for (const PlannedRun& run : runs) {
    points.push_back(run.point);
    names.values.push_back(run_name(with_seed(workspace, run.seed), run.point));
    seeds.values.push_back(std::to_string(run.seed));
  }
  write_points(workspace, path, points, {names, seeds});
}

TaskOutcome run_task(const Workspace& workspace, const std::string& list, int task, int runs_per_task,
                     const std::stop_token& stop) {
  const data::Csv csv = data::read_csv(list);
  const std::vector<Point> points = read_points(workspace, list);
  const TaskRuns own_runs = runs_of_task(task, runs_per_task, points.size());
  TaskOutcome outcome;
  for (std::size_t i = own_runs.first; i < own_runs.end; ++i) {
    const Workspace own = with_seed(workspace, read_seed(csv, csv.rows[i]));
    const std::string& listed = csv.rows[i].fields[csv.column(name_column)];
    if (const std::string name = run_name(own, points[i]); name != listed)
      throw data::InputError(
          data::ExitStatus::bad_study,
          {workspace.study.file, fmt::format("was changed since its runs were submitted: {} is now {}", listed, name),
           "start demcal train --slurm again: it submits the runs of the study as it is"});
    const dem::RunResult result =
        run_point(own, points[i], {.path = run_path(own, points[i]), .keep_state = false, .stop = stop});
    if (result.status == dem::RunStatus::interrupted) {
      outcome.interrupted = true;
      return outcome;
    }
    ++outcome.ended;
    if (result.status == dem::RunStatus::failed)
      outcome.failures.push_back(
          fmt::format("{} {}: {}", points[i].material, describe(own.study, points[i]), result.reason));
  }
  return outcome;
}

}  // namespace campaign
