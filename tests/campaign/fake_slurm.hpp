#pragma once
// In the place of Slurm's programs: keeps jobs, and does with their tasks what the test says.
#include <fmt/core.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "campaign/design.hpp"
#include "campaign/run_batch.hpp"
#include "campaign/slurm.hpp"
#include "campaign/slurm_jobs.hpp"
#include "data/atomic_file.hpp"
#include "data/csv.hpp"
#include "dem/run/run_file.hpp"

namespace test {

inline campaign::Workspace small_study(const std::string& out, const std::string& fill = "200",
                                       const std::vector<std::string>& more = {}) {
  std::vector<std::string> set{"rig.fill=" + fill, "run.longest=\"0.4 s\"", "run.start_up_turns=0.25",
                               "training.unsteady=\"use\""};
  set.insert(set.end(), more.begin(), more.end());
  return campaign::open_workspace({.study = DEMCAL_SOURCE_DIR "/data/quick", .out = out, .seed = {}, .set = set});
}

inline std::vector<campaign::PlannedRun> planned(const campaign::Workspace& workspace, int runs) {
  std::vector<campaign::PlannedRun> all;
  for (const campaign::Point& point : campaign::training_design(workspace, "powder", 0, runs))
    all.push_back({point, workspace.study.seed});
  return all;
}

/// Keeps a run as a task would, with made-up numbers.
inline void write_result(const campaign::Workspace& workspace, const campaign::PlannedRun& run,
                         dem::RunStatus status = dem::RunStatus::done) {
  const campaign::Workspace own = campaign::with_seed(workspace, run.seed);
  dem::RunResult result{.status = status, .seed = campaign::run_seed(own, run.point)};
  if (status == dem::RunStatus::failed) result.reason = "a sphere left the box";
  for (std::size_t k = 0; k < dem::outputs().size(); ++k)
    result.summary.mean.push_back({.mean = 1e-5 * run.point.inputs[0], .standard_error = 1e-7, .reliable = true});
  result.summary.state = data::FlowState::steady;
  constexpr std::size_t samples = 200;
  for (std::vector<double>* values :
       {&result.series.time, &result.series.torque, &result.series.axial_flow, &result.series.coordination,
        &result.series.kinetic_energy, &result.series.normal_stress})
    values->assign(samples, 1e-5);
  dem::write_run(campaign::run_path(own, run.point), campaign::case_at(own, run.point), result);
}

struct FakeSlurm {
  struct Task {
    std::string word = "R";  ///< squeue's state; "": the queue does not know it
  };
  struct Job {
    std::string id, list, log;
    int runs_per_task = 1;
    std::vector<Task> tasks;
  };
  std::map<std::string, Job> jobs;  ///< by name
  int submissions = 0, looks = 0, max_array_size = 1001;
  /// Called for each task at each look, before squeue answers; changes the task, makes its runs.
  std::function<void(const std::string& name, int task, Job&)> step = [](const std::string&, int, Job&) {};
  /// What sbatch says instead of taking the job; empty: it takes it.
  std::function<std::string(int tasks)> refuse = [](int) { return ""; };
  bool silent = false;           ///< squeue and scontrol do not answer
  bool without_cluster = false;  ///< its programs have no configuration
  bool takes_silently = false;   ///< sbatch takes the job, and says that it has no answer
  std::function<void()> on_look = [] {};

  /// The names of the runs of a task, from its list.
  static std::vector<std::string> runs(const Job& job, int task) {
    const data::Csv csv = data::read_csv(job.list);
    const campaign::TaskRuns own = campaign::runs_of_task(task, job.runs_per_task, csv.rows.size());
    std::vector<std::string> names;
    for (std::size_t i = own.first; i < own.end; ++i) names.push_back(csv.rows[i].fields[csv.column("run.name")]);
    return names;
  }

  data::ProgramEnd start(const data::ProgramCall& call) {
    const std::string& program = call.words.front();
    if (call.words.back() == "--version") return {.out = "slurm 22.05.8\n"};
    if (without_cluster)
      return {.exit_status = 1, .err = program + ": fatal: Could not establish a configuration source\n"};
    if (program == "sbatch") return submit(call.words);
    if (silent) return {.exit_status = 1, .err = "slurm_load_jobs error: Unable to contact slurm controller\n"};
    if (program == "scontrol") return {.out = fmt::format("MaxArraySize            = {}\n", max_array_size)};
    ++looks;
    on_look();
    std::string lines;
    for (auto& [name, job] : jobs)
      for (int k = 0; k < static_cast<int>(job.tasks.size()); ++k) {
        step(name, k, job);
        if (const std::string& word = job.tasks[static_cast<std::size_t>(k)].word; !word.empty())
          lines += fmt::format("{}|{}|{}|{}|None\n", name, job.id, k, word);
      }
    return {.out = lines};
  }

  data::ProgramEnd submit(const std::vector<std::string>& words) {
    const auto value = [&](const std::string& option) {
      for (const std::string& word : words)
        if (word.starts_with(option + "=")) return word.substr(option.size() + 1);
      return std::string();
    };
    const int tasks = std::stoi(value("--array").substr(2)) + 1;
    if (const std::string said = refuse(tasks); !said.empty()) return {.exit_status = 1, .err = said};
    ++submissions;
    const std::string script = words.back(), name = value("--job-name");
    const std::string text = data::read_file(script);
    const std::string per_task = "--runs-per-task' ";
    Job job{.id = std::to_string(100 + submissions),
            .list = script.substr(0, script.size() - 3) + ".csv",
            .log = script.substr(0, script.rfind('/')) + "/log",
            .runs_per_task = std::atoi(text.c_str() + text.find(per_task) + per_task.size()),
            .tasks = std::vector<Task>(static_cast<std::size_t>(tasks))};
    jobs[name] = job;
    if (takes_silently) return {.exit_status = 1, .err = "sbatch: error: Socket timed out on send/recv operation\n"};
    return {.out = job.id + "\n"};
  }
};

}  // namespace test
