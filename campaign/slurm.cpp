#include "campaign/slurm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <set>

#include "campaign/design.hpp"
#include "campaign/foretell.hpp"
#include "campaign/run_point.hpp"
#include "campaign/slurm_commands.hpp"
#include "campaign/slurm_record.hpp"
#include "campaign/slurm_task.hpp"
#include "campaign/training_table.hpp"
#include "data/atomic_file.hpp"

namespace campaign {
namespace {
namespace fs = std::filesystem;

/// When the file was last written; 0 where there is none.
std::int64_t change_of(const std::string& path) {
  std::error_code none;
  const auto time = fs::last_write_time(path, none);
  return none ? 0 : static_cast<std::int64_t>(time.time_since_epoch().count());
}

/// The last lines of a task's output, as one line.
std::string end_of_log(const std::string& path) {
  std::string text;
  try {
    text = data::read_file(path);
  } catch (const data::InputError&) {
    return "";
  }
  constexpr std::size_t most = 300;
  while (!text.empty() && text.back() == '\n') text.pop_back();
  if (text.size() > most) {
    text.erase(0, text.size() - most);
    text.erase(0, text.find('\n') + 1);
  }
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// A run of this call that is followed.
struct Followed {
  std::string name, path;
  std::int64_t seen = 0;  ///< change of its file when it was read last
  int looks_without = 0;
};

class Follower {
 public:
  Follower(const Workspace& workspace, const std::vector<PlannedRun>& runs, data::RunTable table,
           const BatchOptions& batch, const SlurmOptions& options)
      : workspace_(workspace),
        runs_(runs),
        batch_(batch),
        options_(options),
        commands_(options.start),
        folder_(slurm_folder(workspace.out)),
        ledger_(std::move(table), runs.size()),
        record_(load_slurm_record(workspace.out, workspace.study.name)) {
    for (const PlannedRun& run : runs) {
      const Workspace own = with_seed(workspace, run.seed);
      followed_.push_back({.name = run_name(own, run.point), .path = run_path(own, run.point)});
    }
  }

  BatchResult follow() {
    collect();
    write_tables(workspace_, ledger_.result.table, batch_.kept);
    int looks = 0;
    for (bool first = true; !over(); first = false) {
      if (!first) wait(looks++);
      if (batch_.stop.stop_requested()) break;
      ask_slurm();
      collect();
      decide();
      const bool all_there = submit();
      if (options_.detach && (limited_ || (all_there && !in_doubt()))) break;
    }
    return result();
  }

 private:
  void note(const std::string& line) {
    if (batch_.progress != nullptr) batch_.progress->note(line);
  }

  bool over() const {
    for (std::size_t i = 0; i < runs_.size(); ++i)
      if (!ledger_.result.ended[i] && !cancelled_.contains(i)) return false;
    return true;
  }

  /// Whether a task has just left the queue, so that the next look decides about it.
  bool in_doubt() const {
    for (std::size_t i = 0; i < runs_.size(); ++i)
      if (!ledger_.result.ended[i] && followed_[i].looks_without > 0) return true;
    return false;
  }

  /// Waits longer each time, but not when the program is to stop.
  void wait(int looks) {
    const double seconds = std::min(options_.longest_wait, options_.first_wait * (1.0 + 0.2 * looks));
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any never;
    never.wait_for(lock, batch_.stop, std::chrono::duration<double>(seconds), [] { return false; });
  }

  /// Says what the queue holds when it is something else than before and nothing runs yet.
  void tell_queue() {
    const bool running = std::any_of(queue_.begin(), queue_.end(),
                                     [](const auto& task) { return task.second.state == TaskState::running; });
    const bool held = std::any_of(queue_.begin(), queue_.end(),
                                  [](const auto& task) { return task.second.state == TaskState::held; });
    const std::string text = running && !held ? std::string() : queue_text(queue_);
    if (!text.empty() && text != told_queue_) note("Slurm: " + text);
    told_queue_ = text;
  }

  /// Asks Slurm for the jobs' tasks, and settles which submissions in doubt were taken.
  void ask_slurm() {
    std::vector<std::string> names;
    for (const auto& [name, job] : record_.jobs) names.push_back(name);
    queue_.clear();
    if (names.empty()) return;
    const SlurmCommands::Seen seen = commands_.ask(names);
    tell_answer(seen.answered, seen.said);
    if (!seen.answered) return;
    queue_ = seen.queue;
    for (const auto& [key, task] : queue_)
      if (const auto job = record_.jobs.find(key.first); job != record_.jobs.end() && job->second.id.empty())
        job->second.id = task.id;
    // A job that sbatch did not confirm and the queue does not know was never there: its runs do not lose a try.
    std::erase_if(record_.runs, [&](const auto& run) { return record_.jobs.at(run.second.job).id.empty(); });
    forget_others();
    tell_queue();
    for (Followed& run : followed_) {
      const auto with = record_.runs.find(run.name);
      if (with == record_.runs.end()) continue;
      const QueuedTask* task = task_of(with->second);
      const bool there = task != nullptr && task->state != TaskState::ended;
      run.looks_without = there ? 0 : run.looks_without + 1;
    }
  }

  /// Runs of earlier calls that this one does not ask for are remembered while their tasks are in the queue.
  void forget_others() {
    std::set<std::string> asked;
    for (const Followed& run : followed_) asked.insert(run.name);
    std::erase_if(record_.runs, [&](const auto& run) {
      const QueuedTask* task = task_of(run.second);
      const bool there = task != nullptr && task->state != TaskState::ended && task->state != TaskState::cancelled;
      return !asked.contains(run.first) && !there;
    });
  }

  void tell_answer(bool answered, const std::string& said) {
    if (answered == silent_)
      note(answered
               ? "Slurm answers again"
               : fmt::format("Slurm does not answer ({}); its jobs go on without it, and this waits for it", said));
    silent_ = !answered;
  }

  const QueuedTask* task_of(const SlurmRun& run) const {
    const auto found = queue_.find({run.job, run.task});
    return found == queue_.end() ? nullptr : &found->second;
  }

  std::uint64_t steps_of(std::size_t i) const {
    if (change_of(followed_[i].path) == 0) return 0;
    return steps_made(with_seed(workspace_, runs_[i].seed), runs_[i].point, followed_[i].path);
  }

  /// Reads the files that were written since the last time.
  void collect() {
    std::size_t taken = 0;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      Followed& run = followed_[i];
      if (ledger_.result.ended[i]) continue;
      const std::int64_t change = change_of(run.path);
      // Some clocks of files are coarse: when its task is gone, the file is read whatever its time says.
      if (change == 0 || (change == run.seen && run.looks_without == 0)) continue;
      run.seen = change;
      const Workspace own = with_seed(workspace_, runs_[i].seed);
      const auto ended = ended_run(own, runs_[i].point, run.path);
      if (!ended) continue;
      ledger_.take(i, own, runs_[i].point, *ended, batch_.progress);
      record_.runs.erase(run.name);
      cancelled_.erase(i);
      ++taken;
    }
    if (taken == 0) return;
    write_tables(workspace_, ledger_.result.table, batch_.kept);
    save_slurm_record(workspace_.out, record_);
  }

  /// Decides what becomes of the runs whose tasks are no longer in the queue.
  void decide() {
    if (silent_) return;
    std::size_t again = 0;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      Followed& run = followed_[i];
      const auto with = record_.runs.find(run.name);
      if (ledger_.result.ended[i] || with == record_.runs.end()) continue;
      const QueuedTask* task = task_of(with->second);
      // Read only for those that are lost: a task in the queue has not ended.
      const bool advanced = run.looks_without > 1 && steps_of(i) > with->second.steps;
      const int tries = with->second.tries;
      switch (fate_of(task, {.tries = tries, .looks_without = run.looks_without, .advanced = advanced},
                      options_.most_tries)) {
        case Fate::wait:
          continue;
        case Fate::left:
          cancelled_.insert(i);
          break;
        case Fate::submit_again:
          tries_[run.name] = advanced ? tries : tries + 1;
          ++again;
          break;
        case Fate::failed:
          ledger_.take_failure(i, failure_text(i, with->second, task), batch_.progress);
          break;
      }
      record_.runs.erase(with);
    }
    if (again > 0) note(fmt::format("{} runs left Slurm's queue without a result and are submitted again", again));
  }

  std::string failure_text(std::size_t i, const SlurmRun& run, const QueuedTask* task) const {
    const std::string log = fmt::format("{}/log/{}-{}.txt", folder_, run.job, run.task);
    const std::string said = end_of_log(log);
    return fmt::format("{} {}: its task {} in each of {} tries{}", runs_[i].point.material,
                       describe(workspace_.study, runs_[i].point), ending_text(task), run.tries,
                       said.empty() ? std::string() : fmt::format("; {} ends with: {}", data::shown_path(log), said));
  }

  /// Submits the runs that are not with Slurm. Whether all of them are there now.
  bool submit() {
    std::vector<std::size_t> fresh, again;
    for (std::size_t i = 0; i < runs_.size(); ++i)
      if (!ledger_.result.ended[i] && !cancelled_.contains(i) && !record_.runs.contains(followed_[i].name))
        (tries_.contains(followed_[i].name) ? again : fresh).push_back(i);
    if (fresh.empty() && again.empty()) {
      save_slurm_record(workspace_.out, record_);
      return true;
    }
    if (max_array_size_ == 0) {
      const auto size = commands_.max_array_size();
      tell_answer(size.has_value(), "scontrol has no configuration");
      if (!size) return false;
      max_array_size_ = *size;
    }
    // Lost runs are submitted one by one, so that a run that ends its task cannot take others along.
    return submit(fresh, fresh.empty() ? 1 : runs_per_task(fresh.size())) && submit(again, 1);
  }

  bool submit(const std::vector<std::size_t>& which, int per_task) {
    for (std::size_t first = 0; first < which.size();) {
      const ArrayJob job = split_runs(which.size() - first, per_task, max_array_size_).front();
      const auto begin = which.begin() + static_cast<std::ptrdiff_t>(first);
      if (!submit_job({begin, begin + static_cast<std::ptrdiff_t>(job.runs)}, job)) return false;
      first += job.runs;
    }
    return true;
  }

  bool submit_job(const std::vector<std::size_t>& which, const ArrayJob& job) {
    const std::string name = fmt::format("{}-{}", record_.prefix, record_.next++);
    const Submission submission = write_job(name, which, job);
    record_.jobs[name] = {.id = "", .tasks = job.tasks};
    for (std::size_t k = 0; k < which.size(); ++k) {
      Followed& run = followed_[which[k]];
      run.looks_without = 0;
      const auto tries = tries_.find(run.name);
      record_.runs[run.name] = {.job = name,
                                .task = static_cast<int>(k) / job.runs_per_task,
                                .tries = tries == tries_.end() ? 1 : tries->second,
                                .steps = steps_of(which[k])};
    }
    save_slurm_record(workspace_.out, record_);
    const SlurmCommands::Submitted submitted = commands_.submit(submission);
    if (submitted.id) {
      record_.jobs[name].id = *submitted.id;
      save_slurm_record(workspace_.out, record_);
      tell_answer(true, "");
      limited_ = false;
      note(fmt::format("submitted job {}: {} runs in {} tasks", *submitted.id, which.size(), job.tasks));
      return true;
    }
    if (submitted.refusal == Refusal::silence) {  // the job may be there: ask_slurm() finds out
      tell_answer(false, submitted.said);
      return false;
    }
    for (const std::size_t i : which) record_.runs.erase(followed_[i].name);
    save_slurm_record(workspace_.out, record_);
    if (submitted.refusal == Refusal::limit && (job.tasks > 1 || !record_.jobs.empty())) {
      if (!limited_) note(fmt::format("Slurm takes no more tasks now ({}); the rest follows", submitted.said));
      limited_ = true;
      if (record_.jobs.empty()) max_array_size_ = std::max(1, job.tasks / 2);  // more than the limit at once
      return false;
    }
    throw data::InputError(data::ExitStatus::usage,
                           {"sbatch", fmt::format("refuses the job: {}", submitted.said),
                            "correct --partition, --account, --time, --mem or --slurm-option"});
  }

  Submission write_job(const std::string& name, const std::vector<std::size_t>& which, const ArrayJob& job) {
    fs::create_directories(fs::path(folder_) / "log");
    std::vector<PlannedRun> listed;
    for (const std::size_t i : which) listed.push_back(runs_[i]);
    const std::string list = fmt::format("{}/{}.csv", folder_, name), script = fmt::format("{}/{}.sh", folder_, name);
    write_task_list(workspace_, list, listed);
    std::vector<std::string> words = options_.program;
    for (const std::string& word :
         {std::string("--task-list"), list, std::string("--runs-per-task"), std::to_string(job.runs_per_task)})
      words.push_back(word);
    data::write_atomically(script, job_script(name, words));
    return {.name = name,
            .tasks = job.tasks,
            .at_once = options_.at_once,
            .log = folder_ + "/log",
            .script = script,
            .options = options_.options};
  }

  /// The user's number, or by the dearest of the materials.
  int runs_per_task(std::size_t runs) const {
    if (options_.runs_per_task > 0) return options_.runs_per_task;
    std::set<std::string> materials;
    for (const PlannedRun& run : runs_) materials.insert(run.point.material);
    double seconds = 0.0;
    for (const std::string& material : materials) {
      const Point middle = parse_point(workspace_, material, {});
      seconds = std::max(seconds, cost_of(foretell(workspace_, middle).prepared).seconds);
    }
    return usual_runs_per_task(seconds, runs);
  }

  BatchResult result() {
    save_slurm_record(workspace_.out, record_);
    BatchResult result = std::move(ledger_.result);
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      if (result.ended[i] || cancelled_.contains(i)) continue;
      ++(record_.runs.contains(followed_[i].name) ? result.left.there : result.left.refused);
    }
    result.left.cancelled = cancelled_.size();
    result.left.jobs = job_ids(record_);
    if (record_.runs.empty()) remove_empty_logs();
    return result;
  }

  void remove_empty_logs() const {
    std::error_code ignored;
    for (fs::directory_iterator file(folder_ + "/log", ignored), end; !ignored && file != end;
         file.increment(ignored)) {
      std::error_code failed;
      if (file->is_regular_file(failed) && file->file_size(failed) == 0) fs::remove(file->path(), failed);
    }
  }

  const Workspace& workspace_;
  const std::vector<PlannedRun>& runs_;
  const BatchOptions& batch_;
  const SlurmOptions& options_;
  SlurmCommands commands_;
  std::string folder_;
  Ledger ledger_;
  SlurmRecord record_;
  std::vector<Followed> followed_;    ///< one for each of runs_
  std::set<std::size_t> cancelled_;   ///< runs whose tasks somebody cancelled
  std::map<std::string, int> tries_;  ///< tries of runs that were lost, by name
  Queue queue_;                       ///< as it was when Slurm answered last
  int max_array_size_ = 0;            ///< 0: not known yet
  bool silent_ = false;               ///< Slurm did not answer last time
  bool limited_ = false;              ///< Slurm takes no more tasks now
  std::string told_queue_;
};

}  // namespace

BatchResult run_on_slurm(const Workspace& workspace, const std::vector<PlannedRun>& runs, data::RunTable table,
                         const BatchOptions& batch, const SlurmOptions& options) {
  SlurmCommands(options.start).require_programs();
  require_places(workspace, runs);
  foretell_materials(workspace, runs, 0);
  return Follower(workspace, runs, std::move(table), batch, options).follow();
}

std::size_t runs_with_slurm(const Workspace& workspace, const std::vector<PlannedRun>& runs) {
  const SlurmRecord record = load_slurm_record(workspace.out, workspace.study.name);
  if (record.runs.empty()) return 0;
  return static_cast<std::size_t>(std::count_if(runs.begin(), runs.end(), [&](const PlannedRun& run) {
    return record.runs.contains(run_name(with_seed(workspace, run.seed), run.point));
  }));
}

}  // namespace campaign
