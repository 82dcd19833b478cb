// A task of an array job.
#include "campaign/slurm_task.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "campaign/run_point.hpp"
#include "tests/campaign/fake_slurm.hpp"
#include "tests/temporary.hpp"

using namespace campaign;
using Catch::Contains;

TEST_CASE("the list of a job gives its points and seeds back to the last digit") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"));
  std::vector<PlannedRun> runs = test::planned(workspace, 3);
  runs[1].seed = 18446744073709551615ull;
  runs[2].point.inputs[0] = 0.1 + 0.2;
  const std::string list = folder.path("list.csv");
  write_task_list(workspace, list, runs);
  const data::Csv csv = data::read_csv(list);
  const std::vector<Point> points = read_points(workspace, list);
  REQUIRE(points.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(points[i].inputs == runs[i].point.inputs);
    CHECK(csv.rows[i].fields[csv.column("seed")] == std::to_string(runs[i].seed));
    const Workspace own = with_seed(workspace, runs[i].seed);
    CHECK(csv.rows[i].fields[csv.column("run.name")] == run_name(own, runs[i].point));
  }
}

TEST_CASE("a task ends the runs of its part alone, however often it is started, and writes nothing but their files") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"));
  const std::vector<PlannedRun> runs = test::planned(workspace, 3);
  const std::string list = folder.path("list.csv");
  write_task_list(workspace, list, runs);
  test::write_result(workspace, runs[0]);
  test::write_result(workspace, runs[1], dem::RunStatus::failed);
  for (int start = 0; start < 2; ++start) {
    const TaskOutcome outcome = run_task(workspace, list, 0, 2, {});
    CHECK(outcome.ended == 2);
    CHECK(outcome.failures.size() == 1);
  }
  CHECK_FALSE(std::filesystem::exists(run_path(workspace, runs[2].point)));
  CHECK_FALSE(std::filesystem::exists(folder.path("out/training.h5")));
  std::stop_source stop;
  stop.request_stop();
  CHECK(run_task(workspace, list, 1, 2, stop.get_token()).interrupted);
  CHECK(run_task(workspace, list, 7, 2, {}).ended == 0);
}

TEST_CASE("a task refuses the runs of a study that was changed since") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"));
  const std::string list = folder.path("list.csv");
  write_task_list(workspace, list, test::planned(workspace, 1));
  const Workspace changed = test::small_study(folder.path("out"), "201");
  CHECK_THAT(failure_of(folder, [&] { run_task(changed, list, 0, 1, {}); }),
             Contains("78: ") && Contains("was changed since its runs were submitted"));
}
