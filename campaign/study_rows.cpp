#include "campaign/study_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "campaign/design.hpp"
#include "campaign/out_files.hpp"
#include "campaign/placeholder.hpp"
#include "campaign/point.hpp"
#include "campaign/run_batch.hpp"
#include "campaign/run_point.hpp"
#include "campaign/training_table.hpp"
#include "data/atomic_file.hpp"
#include "data/origin.hpp"
#include "data/run_table_files.hpp"
#include "uq/emulate/surrogates.hpp"

namespace campaign {
namespace fs = std::filesystem;
namespace {

/// Lines of [training] leave_out at which no row stands.
void tell_unknown_rows(const data::Study& study, StudyRows& rows) {
  const auto stands = [&](const std::string& label) {
    const auto named = [&](const data::RunRow& row) { return data::names_row(label, row.place); };
    return std::any_of(rows.table.rows.begin(), rows.table.rows.end(), named) ||
           (rows.low && std::any_of(rows.low->rows.begin(), rows.low->rows.end(), named));
  };
  for (const std::string& label : study.training.leave_out)
    if (!stands(label))
      rows.findings.push_back({.kind = data::FindingKind::rows_left_out,
                               .place = study.training.place,
                               .severity = data::Severity::warning,
                               .what = fmt::format("leave_out names {}, where no row is read", label),
                               .remedy = "name rows as the messages do: a line of the table, or \"FILE:LINE\"",
                               .places = {}});
}

/// Takes from the run's file what the row lacks; false where the file is gone, or of another run than the row.
bool complete(const Workspace& workspace, data::RunRow& row) {
  const Point point{row.material, row.inputs};
  const Workspace own = with_seed(workspace, row.seed);
  const std::optional<dem::RunResult> run = finished_run(own, point, run_path(own, point));
  if (!run) return false;
  const data::RunRow whole = to_row(own, point, *run);
  for (std::size_t i = 0; i < row.outputs.size(); ++i)
    if (!std::isnan(row.outputs[i]) && row.outputs[i] != whole.outputs[i]) return false;
  row.outputs = whole.outputs;
  row.standard_errors = whole.standard_errors;
  row.unreliable = whole.unreliable;
  return true;
}

/// Fills rows that lack an output, since it came to the study after they were written. Says how many lack it still.
void complete_rows(const Workspace& workspace, data::RunTable& table, std::vector<std::string>& notes) {
  std::size_t filled = 0, lacking = 0;
  for (data::RunRow& row : table.rows)
    if (!row.settings.empty() && data::lacks_output(table, row)) ++(complete(workspace, row) ? filled : lacking);
  const auto say = [&](std::size_t count, const char* what) {
    if (count == 0) return;
    notes.push_back(fmt::format("{}: {} of {} rows were written before all of the study's outputs were: {}",
                                data::shown_path(training_path(workspace)), count, table.rows.size(), what));
  };
  say(filled, "they are completed from their runs in runs/");
  say(lacking,
      "they count for their other outputs only, since runs/ has not these runs (demcal train makes them again)");
}

/// Leaves out the unsteady rows of the study's level or, with `cheaper`, of the level under it.
void leave_out_unsteady(const Workspace& workspace, bool cheaper, data::RunTable& table,
                        std::vector<std::string>& notes) {
  if (workspace.unsteady == Unsteady::use) return;
  const std::string of = cheaper ? "of the cheaper level, " : "";
  const std::size_t all = table.rows.size();
  std::map<std::string, int> left_out;
  std::erase_if(table.rows, [&](const data::RunRow& row) {
    const bool unsteady = data::is_unsteady(row);
    if (unsteady) ++left_out[row.state];
    return unsteady;
  });
  for (const auto& [state, count] : left_out)
    notes.push_back(of +
                    fmt::format("{} of {} runs are not of the steady flow ({}) and are left out: raise run.longest and "
                                "train again, or set training.unsteady = \"use\"",
                                count, all, state));
  for (const std::string& note : data::drop_unreliable(table, workspace.surrogates->fit.nugget))
    notes.push_back(of + note);
}

}  // namespace

StudyRows study_rows(const Workspace& workspace) {
  const data::Study& study = workspace.study;
  StudyRows result{data::empty_table(study), {}, {}, {}};
  std::map<std::string, std::string> settings;
  for (const auto& [material, unused] : workspace.cases) settings[material] = settings_hash(workspace, material);
  const auto add = [&](const std::string& path, const data::TableRead& read) {
    for (const std::string& left_out : read.left_out) result.notes.push_back(left_out);
    result.findings.insert(result.findings.end(), read.findings.begin(), read.findings.end());
    data::RunTable usable = read.table;
    const bool own = path != study.training.table;
    std::size_t stale = std::erase_if(usable.rows, [&](const data::RunRow& row) {
      const auto known = settings.find(row.material);
      const bool other = known != settings.end() && !row.settings.empty() && row.settings != known->second;
      if (other && own) result.kept.push_back(row);
      return other;
    });
    if (stale > 0)
      result.notes.push_back(
          fmt::format("{}: {} of {} rows were simulated under other settings than the study's and are left out (demcal "
                      "train makes them again)",
                      path, stale, read.table.rows.size()));
    if (own && own_engine(workspace)) complete_rows(workspace, usable, result.notes);
    result.all = data::merge(result.all, usable);
  };
  if (!study.training.table.empty()) add(study.training.table, data::read_table(study.training.table, study));
  const std::string own = training_path(workspace);
  const std::string copy = training_copy_path(workspace);
  const data::Origin of_copy = data::origin_of(copy);
  if (fs::exists(own) || of_copy == data::Origin::ours || of_copy == data::Origin::changed)
    add(own, read_own_table(workspace, result.notes));
  result.table = result.all;
  leave_out_unsteady(workspace, false, result.table, result.notes);
  if (!study.training.low.empty()) {
    data::TableRead read = data::read_table(study.training.low, study);
    for (std::string& left_out : read.left_out) result.notes.push_back(std::move(left_out));
    result.findings.insert(result.findings.end(), read.findings.begin(), read.findings.end());
    leave_out_unsteady(workspace, true, read.table, result.notes);
    result.low = std::move(read.table);
  }
  tell_unknown_rows(study, result);
  for (data::Finding& finding : placeholders(study)) result.findings.push_back(std::move(finding));
  return result;
}

void require_rows(const Workspace& workspace, const StudyRows& rows, const std::string& study) {
  if (data::used_rows(rows.table) > 0) return;
  const std::string why = rows.notes.empty() ? "" : ": " + rows.notes.front();
  throw data::InputError(data::ExitStatus::missing_input,
                         {workspace.study.file, "has no usable training runs" + why,
                          own_engine(workspace) ? "make them: demcal train " + study
                          : workspace.study.training.table.empty()
                              ? "name a table of runs under [training] table"
                              : "put runs into " + workspace.study.training.table + " (demcal design says which)"});
}

}  // namespace campaign
