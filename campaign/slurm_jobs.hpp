#pragma once
// What Slurm is told and what it says, as texts: the split of runs into array jobs, the script of a job, the words of
// sbatch, the lines of squeue, and what follows from them for a run. Nothing here starts a program.
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace campaign {

/// An array job: `tasks` tasks with the indices 0, 1, ...; task k makes the runs k * runs_per_task, ... of its list.
struct ArrayJob {
  std::size_t first = 0;  ///< run of its list, counted in all runs
  std::size_t runs = 0;
  int tasks = 0;
  int runs_per_task = 1;
};
/// As few jobs as hold all runs when an index must be below `max_array_size`.
std::vector<ArrayJob> split_runs(std::size_t runs, int runs_per_task, int max_array_size);

/// As many runs as make about ten minutes when each takes `seconds`, so that Slurm's own time for a task does not
/// count; but a few runs are spread over eight tasks, to be made at the same time.
int usual_runs_per_task(double seconds, std::size_t runs);

/// The tasks of a job's list that a task makes.
struct TaskRuns {
  std::size_t first = 0, end = 0;
};
TaskRuns runs_of_task(int task, int runs_per_task, std::size_t runs);

/// MaxArraySize of `scontrol show config`; Slurm's own default, 1001, where the text has none.
int parse_max_array_size(const std::string& config);

/// The number that `sbatch --parsable` printed: "1234" or "1234;cluster". None where it printed something else.
std::optional<std::string> parse_job_id(const std::string& out);

/// Why sbatch took no job.
enum class Refusal {
  silence,  ///< the controller does not answer: the job may be there all the same
  limit,    ///< the user or the cluster has too many jobs already: later, or fewer tasks
  other,    ///< the job is wrong
};
Refusal refusal_of(const std::string& error);

/// Options that --slurm-option must not give, because the submission sets them; empty where the option may be given.
std::string forbidden_option(const std::string& option);

struct Submission {
  std::string name;  ///< of the job
  int tasks = 1;
  int at_once = 0;                        ///< tasks at the same time; 0: as many as Slurm starts
  std::string log;                        ///< folder of the tasks' output
  std::string script;                     ///< path
  std::vector<std::string> options = {};  ///< the user's, such as "--partition=short"
};
std::vector<std::string> sbatch_words(const Submission& submission);

/// The script of a job: its task starts the program with these words and the task's index.
std::string job_script(const std::string& name, const std::vector<std::string>& program);

/// The words that ask for all tasks of these jobs, ended ones too as far as Slurm remembers them.
std::vector<std::string> squeue_words(const std::vector<std::string>& names);

enum class TaskState {
  waiting,
  held,  ///< waits until somebody releases it
  running,
  cancelled,
  ended,  ///< in whatever way
};
struct QueuedTask {
  std::string id;  ///< of the array job
  TaskState state = TaskState::waiting;
  std::string word;    ///< Slurm's: "PD", "OOM"
  std::string reason;  ///< why it waits: "Resources"
};
/// By job's name and task's index, from the lines that squeue_words() asks for. Other lines are passed over.
using Queue = std::map<std::pair<std::string, int>, QueuedTask>;
Queue parse_queue(const std::string& lines);

/// What is known of a run that has no result yet.
struct RunHistory {
  int tries = 1;          ///< submissions so far, this one included, without those that brought the run further
  int looks_without = 0;  ///< in a row, at a queue without its task
  bool advanced = false;  ///< its file holds more of it than when it was submitted
};
enum class Fate { wait, submit_again, left, failed };
/// What to do about it. `task` is none where the queue does not know it. A task that has just left the queue gets a
/// second look, as its file may take a while to be seen from another machine. `left`: somebody cancelled it.
Fate fate_of(const QueuedTask* task, const RunHistory& history, int most_tries);

/// How the task ended in words: "ran out of memory (--mem asks for more)".
std::string ending_text(const QueuedTask* task);

/// "3 running, 12 waiting (Resources)"; empty for no tasks.
std::string queue_text(const Queue& queue);

}  // namespace campaign
