#include "cli/train_slurm.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "campaign/slurm_jobs.hpp"
#include "campaign/slurm_task.hpp"
#include "data/interrupt.hpp"

namespace cli {
namespace fs = std::filesystem;

void add_slurm_options(CLI::App& command, SlurmChoice& choice) {
  CLI::Option* const slurm = command.add_flag(
      "--slurm", choice.slurm,
      "make the runs as array jobs of Slurm and follow them; a later call goes on where one was ended");
  command
      .add_flag("--detach", choice.detach,
                "with --slurm: come back when all is submitted; the next call collects what is finished")
      ->needs(slurm);
  const auto passed_on = [&](const std::string& name, const std::string& purpose) {
    command
        .add_option_function<std::string>(
            name, [&choice, name](const std::string& value) { choice.options.push_back(name + "=" + value); },
            "with --slurm: " + purpose)
        ->needs(slurm);
  };
  passed_on("--partition", "of the jobs, as sbatch takes it");
  passed_on("--account", "of the jobs");
  passed_on("--time", "limit of a task, as 30 (minutes) or 2:00:00; a run that is cut off goes on from its checkpoint");
  passed_on("--mem", "memory of a task, as 2G");
  command
      .add_option_function<std::vector<std::string>>(
          "--slurm-option",
          [&choice](const std::vector<std::string>& values) {
            for (const std::string& value : values) {
              choice.options.push_back(value.starts_with("-") ? value : "--" + value);
              if (const std::string why = forbidden_option(choice.options.back()); !why.empty())
                throw CLI::ValidationError("--slurm-option", fmt::format("'{}' cannot be given: {}", value, why));
            }
          },
          "with --slurm: any other option of sbatch, as qos=long; repeatable")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false)
      ->type_name("TEXT")
      ->needs(slurm);
  CLI::Option* const per_task =
      command
          .add_option("--runs-per-task", choice.runs_per_task,
                      "with --slurm: runs that a task makes one after the other (default: about ten minutes of them, "
                      "but at least eight tasks)")
          ->check(CLI::Range(1, 100000));
  // The options that the scripts of the jobs give.
  command.add_option("--task-list", choice.task_list)->group("")->needs(per_task);
  command.add_option("--task", choice.task)->group("");
}

SlurmOptions slurm_options(const Common& common, const SlurmChoice& choice, const CLI::App& command) {
  SlurmOptions options{
      .program = {fs::read_symlink("/proc/self/exe").string(), "train", fs::absolute(common.study).string()},
      .options = choice.options,
      .runs_per_task = choice.runs_per_task,
      .detach = choice.detach};
  std::vector<std::string>& words = options.program;
  words.insert(words.end(), {"--out", open_workspace(common).out, "--quiet"});
  if (common.seed) words.insert(words.end(), {"--seed", std::to_string(*common.seed)});
  for (const std::string& one : common.set) words.insert(words.end(), {"--set", one});
  if (command.count("--isa") > 0) words.insert(words.end(), {"--isa", command.get_option("--isa")->results().front()});
  return options;
}

data::ExitStatus make_task(const Common& common, const SlurmChoice& choice) {
  const data::InterruptGuard interrupt;
  const Workspace workspace = open_workspace(common);
  require_own_runs(workspace);
  const TaskOutcome outcome =
      run_task(workspace, choice.task_list, choice.task, choice.runs_per_task, interrupt.token());
  for (const std::string& failure : outcome.failures) say(common, "failed: " + failure);
  return outcome.interrupted ? data::ExitStatus::interrupted : data::ExitStatus::done;
}

std::optional<data::ExitStatus> tell_left(const Common& common, const BatchResult& result, bool detached) {
  const LeftWithSlurm& left = result.left;
  if (!left.any()) return {};
  const std::string jobs = fmt::format("{}", fmt::join(left.jobs, " "));
  std::string text = fmt::format("{} new runs, {} in all", result.finished, result.table.rows.size());
  if (left.there > 0) text += fmt::format("; {} are with Slurm, in the jobs {}", left.there, jobs);
  if (left.refused > 0) text += fmt::format("; {} are not submitted yet", left.refused);
  if (left.cancelled > 0) text += fmt::format("; the tasks of {} were cancelled", left.cancelled);
  if (detached && left.cancelled == 0) {
    answer(common, text + ". The same command collects what is finished; without --detach it follows the rest");
    return data::ExitStatus::done;
  }
  say(common,
      text + (left.there > 0
                  ? fmt::format(". The jobs go on, and the same command collects them (scancel {} ends them)", jobs)
                  : ". The same command submits them again"));
  return data::ExitStatus::interrupted;
}

nlohmann::json slurm_json(const LeftWithSlurm& left) {
  return {
      {"with_slurm", left.there}, {"cancelled", left.cancelled}, {"not_submitted", left.refused}, {"jobs", left.jobs}};
}

}  // namespace cli
