// Jobs are followed, lost runs submitted again, and nothing is submitted twice or lost, whatever Slurm does.
#include <catch2/catch.hpp>
#include <ctime>
#include <filesystem>
#include <set>

#include "campaign/slurm_record.hpp"
#include "campaign/training_table.hpp"
#include "tests/campaign/fake_slurm.hpp"
#include "tests/temporary.hpp"

using namespace campaign;
using Catch::Contains;
using test::FakeSlurm;

namespace {

/// A study of a few runs, a Slurm, and what was said.
struct Site {
  TemporaryFolder folder;
  Workspace workspace = test::small_study(folder.path("out"));
  std::vector<PlannedRun> runs;
  std::map<std::string, PlannedRun> by_name;
  FakeSlurm slurm;
  std::string said;

  explicit Site(int count) : runs(test::planned(workspace, count)) {
    for (const PlannedRun& run : runs) by_name[run_name(workspace, run.point)] = run;
  }

  /// Makes the runs of a task, which ends.
  void finish(FakeSlurm::Job& job, int task) {
    for (const std::string& name : FakeSlurm::runs(job, task)) test::write_result(workspace, by_name.at(name));
    job.tasks[static_cast<std::size_t>(task)].word = "CD";
  }

  BatchResult follow(SlurmOptions options = {}, std::stop_token stop = {}) {
    options.program = {"demcal", "train", "study"};
    if (options.runs_per_task == 0) options.runs_per_task = 1;
    options.first_wait = 1e-4;
    options.longest_wait = 1e-3;
    options.start = [this](const data::ProgramCall& call) { return slurm.start(call); };
    data::Progress progress(
        "runs", runs.size(),
        {.style = data::ProgressStyle::lines, .write = [this](const std::string& t) { said += t; }});
    const BatchOptions batch{.jobs = 1, .kept = {}, .stop = stop, .progress = &progress};
    std::vector<std::string> notes;
    data::RunTable table = data::empty_table(workspace.study);
    if (std::filesystem::exists(folder.path("out/training.h5"))) table = read_own_table(workspace, notes).table;
    return run_on_slurm(workspace, runs, table, batch, options);
  }
};

}  // namespace

TEST_CASE("runs are submitted once, collected once, and the table has a row for each") {
  Site site(10);
  site.slurm.max_array_size = 3;
  site.slurm.step = [&](const std::string&, int task, FakeSlurm::Job& job) {
    if (site.slurm.looks > 2 + task && job.tasks[static_cast<std::size_t>(task)].word == "R") site.finish(job, task);
  };
  const BatchResult result = site.follow({.runs_per_task = 2});
  CHECK(site.slurm.submissions == 2);  // 5 tasks, 3 in a job
  CHECK(result.finished == 10);
  CHECK(result.table.rows.size() == 10);
  CHECK(result.failures.empty());
  CHECK(!result.left.any());
  CHECK(runs_with_slurm(site.workspace, site.runs) == 0);
  std::vector<std::string> notes;
  CHECK(read_own_table(site.workspace, notes).table.rows.size() == 10);
}

TEST_CASE("runs that their files hold already are not submitted") {
  Site site(3);
  for (const PlannedRun& run : site.runs) test::write_result(site.workspace, run);
  CHECK(site.follow().finished == 3);
  CHECK(site.slurm.submissions == 0);
}

TEST_CASE("a task that ends before its runs are made is submitted again, run by run") {
  Site site(4);
  const bool forgotten = GENERATE(false, true);  // the queue still tells how it ended, or does not
  int lost = 0;
  site.slurm.step = [&](const std::string&, int task, FakeSlurm::Job& job) {
    std::string& word = job.tasks[static_cast<std::size_t>(task)].word;
    if (word != "R") return;
    if (job.runs_per_task == 4) {
      test::write_result(site.workspace, site.by_name.at(FakeSlurm::runs(job, task).front()));
      word = forgotten ? "" : "NF";
      ++lost;
    } else {
      site.finish(job, task);
    }
  };
  const BatchResult result = site.follow({.runs_per_task = 4});
  CHECK(lost == 1);
  CHECK(result.finished == 4);
  CHECK(site.slurm.submissions == 2);
  REQUIRE(site.slurm.jobs.size() == 2);
  CHECK(site.slurm.jobs.rbegin()->second.tasks.size() == 3);
  CHECK_THAT(site.said, Contains("3 runs left Slurm's queue without a result and are submitted again"));
}

TEST_CASE("a run whose task never gives a result fails with the end of its log, and the others are made") {
  Site site(3);
  const std::string cursed = run_name(site.workspace, site.runs[1].point);
  site.slurm.step = [&](const std::string& name, int task, FakeSlurm::Job& job) {
    std::string& word = job.tasks[static_cast<std::size_t>(task)].word;
    if (word != "R") return;
    if (FakeSlurm::runs(job, task).front() == cursed) {
      std::ofstream(fmt::format("{}/{}-{}.txt", job.log, name, task)) << "first\nslurmstepd: error: oom_kill event\n";
      word = "OOM";
    } else {
      site.finish(job, task);
    }
  };
  const BatchResult result = site.follow({.most_tries = 3});
  CHECK(site.slurm.submissions == 3);
  CHECK(result.finished == 2);
  REQUIRE(result.failures.size() == 1);
  CHECK_THAT(result.failures[0], Contains("ran out of memory") && Contains("3 tries") && Contains("oom_kill event"));
  CHECK(std::count(result.ended.begin(), result.ended.end(), true) == 3);
  CHECK(runs_with_slurm(site.workspace, site.runs) == 0);  // the next call tries anew
}

TEST_CASE("a run that the DEM gives up fails at once, with the DEM's reason") {
  Site site(2);
  site.slurm.step = [&](const std::string&, int task, FakeSlurm::Job& job) {
    for (const std::string& name : FakeSlurm::runs(job, task))
      test::write_result(site.workspace, site.by_name.at(name),
                         task == 0 ? dem::RunStatus::failed : dem::RunStatus::done);
    job.tasks[static_cast<std::size_t>(task)].word = "CD";
  };
  const BatchResult result = site.follow();
  CHECK(site.slurm.submissions == 1);
  CHECK(result.finished == 1);
  REQUIRE(result.failures.size() == 1);
  CHECK_THAT(result.failures[0], Contains("a sphere left the box"));
}

TEST_CASE("a controller that does not answer is waited for, and said once") {
  Site site(3);
  int silences = 0;
  FakeSlurm& slurm = site.slurm;
  slurm.step = [&](const std::string&, int task, FakeSlurm::Job& job) {
    if (slurm.looks > 3) site.finish(job, task);
  };
  SlurmOptions options{.runs_per_task = 1};
  const auto answer = [&](const data::ProgramCall& call) {
    slurm.silent = call.words.front() == "squeue" && slurm.looks == 2 && silences < 20;
    silences += slurm.silent ? 1 : 0;
    return slurm.start(call);
  };
  options.program = {"demcal"};
  options.first_wait = options.longest_wait = 1e-4;
  options.start = answer;
  data::Progress progress(
      "runs", 3, {.style = data::ProgressStyle::lines, .write = [&](const std::string& t) { site.said += t; }});
  const BatchResult result = run_on_slurm(site.workspace, site.runs, data::empty_table(site.workspace.study),
                                          {.jobs = 1, .kept = {}, .stop = {}, .progress = &progress}, options);
  CHECK(silences == 20);
  CHECK(result.finished == 3);
  CHECK(slurm.submissions == 1);
  const std::size_t first = site.said.find("Slurm does not answer");
  REQUIRE(first != std::string::npos);
  CHECK(site.said.find("Slurm does not answer", first + 1) == std::string::npos);
  CHECK_THAT(site.said, Contains("Slurm answers again"));
}

TEST_CASE("a submission whose answer was lost is looked for: neither made twice nor forgotten") {
  Site site(3);
  FakeSlurm& slurm = site.slurm;
  slurm.step = [&](const std::string&, int task, FakeSlurm::Job& job) { site.finish(job, task); };
  SECTION("the job is there") {
    slurm.takes_silently = true;
    CHECK(site.follow().finished == 3);
    CHECK(slurm.submissions == 1);
  }
  SECTION("it is not, and no run loses a try by that") {
    int silences = 0;
    slurm.refuse = [&](int) {
      return ++silences <= 5 ? "sbatch: error: Unable to contact slurm controller (connect failure)" : "";
    };
    CHECK(site.follow({.most_tries = 1}).finished == 3);
    CHECK(slurm.submissions == 1);
  }
}

TEST_CASE("a later call follows what an earlier one submitted") {
  Site site(4);
  const BatchResult left = site.follow({.detach = true});
  CHECK(left.left.there == 4);
  CHECK(left.left.jobs == std::vector<std::string>{"101"});
  CHECK(runs_with_slurm(site.workspace, site.runs) == 4);
  int made = 0;
  SECTION("and collects what was finished in between") {
    for (auto& [name, job] : site.slurm.jobs)
      for (int k = 0; k < 2; ++k) site.finish(job, k);
    const BatchResult part = site.follow({.detach = true});
    CHECK(part.finished == 2);
    CHECK(part.left.there == 2);
  }
  SECTION("also when Slurm has forgotten the tasks: those without a result are submitted again") {
    site.slurm.jobs.clear();
    const BatchResult again = site.follow({.detach = true});
    CHECK(again.left.there == 4);
    CHECK(site.slurm.submissions == 2);
    made = 1;
  }
  site.slurm.step = [&](const std::string&, int task, FakeSlurm::Job& job) {
    if (job.tasks[static_cast<std::size_t>(task)].word == "R") site.finish(job, task);
  };
  CHECK(site.follow().table.rows.size() == 4);
  CHECK(site.slurm.submissions == 1 + made);
}

TEST_CASE("runs of an earlier call that are no longer asked for are remembered while they are in the queue") {
  Site site(4);
  CHECK(site.follow({.detach = true}).left.there == 4);
  const std::vector<PlannedRun> all = site.runs;
  site.runs.resize(1);
  CHECK(site.follow({.detach = true}).left.there == 1);
  CHECK(runs_with_slurm(site.workspace, all) == 4);
  site.slurm.step = [&](const std::string&, int task, FakeSlurm::Job& job) { site.finish(job, task); };
  CHECK(site.follow().table.rows.size() == 1);
  CHECK(runs_with_slurm(site.workspace, all) == 0);
  site.runs = all;
  CHECK(site.follow().table.rows.size() == 4);  // their files were there
  CHECK(site.slurm.submissions == 1);
}

TEST_CASE("interruption leaves the jobs where they are") {
  Site site(2);
  std::stop_source stop;
  site.slurm.on_look = [&] {
    if (site.slurm.looks == 3) stop.request_stop();
  };
  const BatchResult result = site.follow({}, stop.get_token());
  CHECK(result.left.there == 2);
  CHECK(result.finished == 0);
  CHECK(runs_with_slurm(site.workspace, site.runs) == 2);
}

TEST_CASE("what somebody cancels is not submitted again before the next call") {
  Site site(3);
  site.slurm.step = [&](const std::string&, int task, FakeSlurm::Job& job) {
    if (task == 1)
      job.tasks[1].word = "CA";
    else
      site.finish(job, task);
  };
  const BatchResult result = site.follow();
  CHECK(site.slurm.submissions == 1);
  CHECK(result.finished == 2);
  CHECK(result.left.cancelled == 1);
  site.slurm.step = [&](const std::string&, int task, FakeSlurm::Job& job) { site.finish(job, task); };
  CHECK(site.follow().table.rows.size() == 3);
  CHECK(site.slurm.submissions == 2);
}

TEST_CASE("under a limit on submitted tasks the runs are submitted in parts") {
  Site site(9);
  FakeSlurm& slurm = site.slurm;
  const auto in_queue = [&] {
    int tasks = 0;
    for (const auto& [name, job] : slurm.jobs)
      for (const FakeSlurm::Task& task : job.tasks) tasks += task.word == "R" ? 1 : 0;
    return tasks;
  };
  int most = 0;
  slurm.refuse = [&](int tasks) { return in_queue() + tasks > 4 ? "sbatch: error: QOSMaxSubmitJobPerUserLimit" : ""; };
  slurm.step = [&](const std::string&, int task, FakeSlurm::Job& job) {
    most = std::max(most, in_queue());
    if (slurm.looks % 3 == 0 && job.tasks[static_cast<std::size_t>(task)].word == "R") site.finish(job, task);
  };
  const BatchResult result = site.follow();
  CHECK(result.finished == 9);
  CHECK(most <= 4);
  CHECK_THAT(site.said, Contains("Slurm takes no more tasks now"));
}

TEST_CASE("a job that sbatch refuses is an error with sbatch's words, and a missing sbatch one with the remedy") {
  Site site(1);
  site.slurm.refuse = [](int) { return "sbatch: error: invalid partition specified: nowhere"; };
  CHECK_THAT(failure_of(site.folder, [&] { site.follow(); }),
             Contains("64: sbatch: refuses the job") && Contains("invalid partition specified: nowhere"));
  CHECK(runs_with_slurm(site.workspace, site.runs) == 0);
  SlurmOptions options;
  options.program = {"demcal"};
  options.start = [](const data::ProgramCall&) { return data::ProgramEnd{.start_error = ENOENT}; };
  CHECK_THAT(
      failure_of(site.folder, [&] { run_on_slurm(site.workspace, site.runs, {}, BatchOptions{.jobs = 1}, options); }),
      Contains("69: sbatch: cannot be started") && Contains("slurm-client"));
}

TEST_CASE("Slurm's programs without a cluster are no controller that will answer again") {
  Site site(1);
  site.slurm.without_cluster = true;
  CHECK_THAT(failure_of(site.folder, [&] { site.follow(); }), Contains("69: scontrol: knows of no cluster here") &&
                                                                  Contains("configuration source") &&
                                                                  Contains("SLURM_CONF"));
}

// Processor time: the machine may be busy with other work.
TEST_CASE("ten thousand finished runs are collected in under a minute", "[slow]") {
  Site site(10000);
  site.slurm.max_array_size = 10001;
  std::clock_t made = 0;
  site.slurm.step = [&](const std::string&, int task, FakeSlurm::Job& job) {
    if (task == 0) {
      for (const PlannedRun& run : site.runs) test::write_result(site.workspace, run);
      made = std::clock();
    }
    job.tasks[static_cast<std::size_t>(task)].word = "CD";
  };
  const BatchResult result = site.follow({.runs_per_task = 10});
  const double seconds = static_cast<double>(std::clock() - made) / CLOCKS_PER_SEC;
  WARN(fmt::format("10,000 runs collected in {:.1f} s of processor time", seconds));
  CHECK(result.finished == 10000);
  CHECK(site.slurm.submissions == 1);
  CHECK(seconds < 60.0);
}
