// What Slurm is told and what it says.
#include "campaign/slurm_jobs.hpp"

#include <catch2/catch.hpp>

using namespace campaign;
using Catch::Contains;

TEST_CASE("array jobs hold each run once, with indices below the limit, and are as few as can be") {
  const std::size_t runs = GENERATE(1, 2, 7, 10, 11, 1000, 10007);
  const int per_task = GENERATE(1, 3, 10), limit = GENERATE(1, 4, 1001);
  std::vector<int> made(runs, 0);
  const std::vector<ArrayJob> jobs = split_runs(runs, per_task, limit);
  for (const ArrayJob& job : jobs) {
    CHECK(job.tasks <= limit);
    std::size_t last_first = 0;
    for (int task = 0; task < job.tasks; ++task) {
      const TaskRuns own = runs_of_task(task, job.runs_per_task, job.runs);
      CHECK(own.first < own.end);  // no task without a run
      CHECK(own.end - own.first <= static_cast<std::size_t>(per_task));
      for (std::size_t i = own.first; i < own.end; ++i) ++made[job.first + i];
      last_first = own.first;
    }
    CHECK(last_first < job.runs);
  }
  CHECK(std::count(made.begin(), made.end(), 1) == static_cast<std::ptrdiff_t>(runs));
  const std::size_t of_a_job = static_cast<std::size_t>(per_task) * static_cast<std::size_t>(limit);
  CHECK(jobs.size() == (runs + of_a_job - 1) / of_a_job);
}

TEST_CASE("no runs make no job, and a task beyond the list has no runs") {
  CHECK(split_runs(0, 5, 100).empty());
  CHECK(runs_of_task(3, 5, 12).first == runs_of_task(3, 5, 12).end);
  CHECK(runs_of_task(2, 5, 12).end == 12);
}

TEST_CASE("a task has about ten minutes of runs, at least one, and a few runs are spread over eight tasks") {
  CHECK(usual_runs_per_task(100.0, 1000) == 6);
  CHECK(usual_runs_per_task(599.0, 1000) == 1);
  CHECK(usual_runs_per_task(90000.0, 1000) == 1);
  CHECK(usual_runs_per_task(1e-9, 100000) == 1000);
  CHECK(usual_runs_per_task(0.0, 1000) == 1);
  CHECK(usual_runs_per_task(1.0, 24) == 3);
  CHECK(usual_runs_per_task(1.0, 5) == 1);
  CHECK(usual_runs_per_task(1.0, 0) == 1);
}

TEST_CASE("the largest array is read from the configuration, and is Slurm's default where there is none") {
  CHECK(parse_max_array_size("ClusterName = x\nMaxArraySize            = 10001\nMaxDBDMsgs = 2\n") == 10001);
  CHECK(parse_max_array_size("MaxArraySize=77") == 77);
  CHECK(parse_max_array_size("") == 1001);
  CHECK(parse_max_array_size("MaxArraySize = N/A\n") == 1001);
}

TEST_CASE("the job's number is what sbatch printed, and nothing else is one") {
  CHECK(parse_job_id("1234\n") == "1234");
  CHECK(parse_job_id("1234;cluster\n") == "1234");
  CHECK_FALSE(parse_job_id(""));
  CHECK_FALSE(parse_job_id("Submitted batch job 12\n"));
  CHECK_FALSE(parse_job_id("12x\n"));
}

TEST_CASE("a silent controller, a limit and a wrong job are told apart") {
  for (const char* text :
       {"sbatch: error: Batch job submission failed: Unable to contact slurm controller (connect failure)",
        "sbatch: error: Batch job submission failed: Socket timed out on send/recv operation",
        "sbatch: error: slurm_persist_conn_open_without_init: Connection refused"})
    CHECK(refusal_of(text) == Refusal::silence);
  for (const char* text :
       {"sbatch: error: QOSMaxSubmitJobPerUserLimit",
        "sbatch: error: Batch job submission failed: Job violates accounting/QOS policy (job submit limit, user's size "
        "and/or time limits)",
        "sbatch: error: Slurm temporarily unable to accept job, sleeping and retrying"})
    CHECK(refusal_of(text) == Refusal::limit);
  CHECK(refusal_of("sbatch: error: invalid partition specified: nowhere") == Refusal::other);
}

TEST_CASE("options that the submission sets itself are not passed on") {
  for (const char* option : {"--array=0-3", "-a0-3", "-a 0-3", "--job-name=x", "-Jx", "--output=x", "-o", "--wait",
                             "-M other", "--clusters=other", "--wrap=ls", "qos=long"})
    CHECK_FALSE(forbidden_option(option).empty());
  for (const char* option :
       {"--qos=long", "--account=a", "-p", "-pshort", "--exclusive", "--nice=10", "--mail-type=END"})
    CHECK(forbidden_option(option).empty());
}

TEST_CASE("a submission names job, tasks and logs, and the user's options come before the script") {
  const std::vector<std::string> words = sbatch_words({.name = "demcal-a-1",
                                                       .tasks = 12,
                                                       .at_once = 3,
                                                       .log = "/home/50%/log",
                                                       .script = "/x/job.sh",
                                                       .options = {"--partition=short"}});
  const auto has = [&](const std::string& word) { return std::count(words.begin(), words.end(), word) == 1; };
  CHECK(words.front() == "sbatch");
  CHECK(words.back() == "/x/job.sh");
  CHECK(words[words.size() - 2] == "--partition=short");
  CHECK(has("--array=0-11%3"));
  CHECK(has("--job-name=demcal-a-1"));
  CHECK(has("--output=/home/50%%/log/%x-%a.txt"));  // Slurm would take "%/" for a field
  const std::vector<std::string> free = sbatch_words({.name = "a", .tasks = 1, .script = "b"});
  CHECK(std::count(free.begin(), free.end(), "--array=0-0") == 1);
}

TEST_CASE("a job's script quotes what a shell would obey") {
  const std::string script = job_script("demcal-a-1", {"/opt/my demcal", "train", "it's", "$(touch x)"});
  CHECK(script.starts_with("#!/bin/sh\n"));
  CHECK_THAT(script, Contains("exec '/opt/my demcal' train") && Contains("'$(touch x)'") &&
                         Contains("--task \"$SLURM_ARRAY_TASK_ID\""));
}

TEST_CASE("squeue's lines become tasks, and lines of another form are passed over") {
  const Queue queue = parse_queue(
      "demcal-a-1|12|0|R|None\ndemcal-a-1|12|1|PD|Resources\ndemcal-a-1|12|2|PD|JobHeldUser\ndemcal-a-1|12|3|CG|None\n"
      "demcal-a-1|12|4|OOM|OutOfMemory\ndemcal-a-1|12|5|CA|None\ndemcal-a-1|12|6|PD|launch failed requeued held\n"
      "demcal-a-2|13|0|RH|None\nslurm_load_jobs error\ndemcal-a-2|13|N/A|R|None\n\n");
  REQUIRE(queue.size() == 8);
  const auto state = [&](const std::string& name, int index) { return queue.at({name, index}).state; };
  CHECK(state("demcal-a-1", 0) == TaskState::running);
  CHECK(state("demcal-a-1", 1) == TaskState::waiting);
  CHECK(state("demcal-a-1", 2) == TaskState::held);
  CHECK(state("demcal-a-1", 3) == TaskState::running);  // until its last process is gone it may still write
  CHECK(state("demcal-a-1", 4) == TaskState::ended);
  CHECK(state("demcal-a-1", 5) == TaskState::cancelled);
  CHECK(state("demcal-a-1", 6) == TaskState::held);
  CHECK(state("demcal-a-2", 0) == TaskState::held);
  CHECK(queue.at({"demcal-a-1", 1}).id == "12");
  CHECK(queue_text(queue) == "2 running, 1 waiting (Resources), 3 held (scontrol release lets them go)");
}

TEST_CASE("a run without a result is waited for while its task is in the queue, and submitted again so many times") {
  constexpr int most = 3;
  const auto fate = [](std::optional<TaskState> state, RunHistory history) {
    const QueuedTask task{.id = "1", .state = state.value_or(TaskState::ended), .word = "", .reason = ""};
    return fate_of(state ? &task : nullptr, history, most);
  };
  for (const TaskState state : {TaskState::waiting, TaskState::held, TaskState::running})
    CHECK(fate(state, {.tries = 9, .looks_without = 9}) == Fate::wait);
  CHECK(fate(TaskState::cancelled, {.tries = 1, .looks_without = 0}) == Fate::left);
  for (const std::optional<TaskState> gone : {std::optional<TaskState>(), std::optional(TaskState::ended)}) {
    CHECK(fate(gone, {.tries = 1, .looks_without = 1}) == Fate::wait);  // its file may not be seen yet
    CHECK(fate(gone, {.tries = 1, .looks_without = 2}) == Fate::submit_again);
    CHECK(fate(gone, {.tries = most, .looks_without = 2}) == Fate::failed);
    // What a limit of time cuts off goes on from its checkpoint, as often as it takes.
    CHECK(fate(gone, {.tries = most, .looks_without = 2, .advanced = true}) == Fate::submit_again);
  }
}
