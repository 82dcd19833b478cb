// What a run's file holds is the run.
#include "campaign/run_point.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "data/atomic_file.hpp"
#include "dem/run/run_file.hpp"
#include "tests/campaign/fake_slurm.hpp"
#include "tests/temporary.hpp"

using namespace campaign;
using Catch::Contains;

TEST_CASE("a steady run that was kept without its last state is read back, and not made again") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"));
  const PlannedRun run = test::planned(workspace, 1).front();
  const std::string path = run_path(workspace, run.point);
  CHECK_FALSE(ended_run(workspace, run.point, path));
  test::write_result(workspace, run);
  const auto back = ended_run(workspace, run.point, path);
  REQUIRE(back);
  CHECK(back->checkpoint.state.position.empty());
  CHECK(back->summary.mean.front().mean == 1e-5 * run.point.inputs[0]);
  CHECK(run_point(workspace, run.point, {.path = path, .keep_state = false}).summary.cpu_seconds == 0.0);
  Workspace other = workspace;
  ++other.study.seed;
  CHECK_FALSE(ended_run(other, run.point, path));
}

TEST_CASE("a run kept without its last state is measured anew where it is as long as it need be, and else made again") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"), "60");
  const PlannedRun run = test::planned(workspace, 1).front();
  const std::string path = run_path(workspace, run.point);
  dem::RunResult whole = run_point(workspace, run.point, {.path = path, .keep_state = true});
  whole.checkpoint = {};
  dem::write_run(path, case_at(workspace, run.point), whole);

  const auto with_longest = [&](double longest) {
    Workspace other = workspace;
    for (auto& [material, c] : other.cases) c.run.longest = longest;
    return other;
  };
  const dem::RunResult anew = run_point(with_longest(0.38), run.point, {.path = path, .keep_state = true}),
                       fresh = run_point(with_longest(0.38), run.point,
                                         {.path = folder.path("fresh.h5"), .keep_state = true});
  CHECK(anew.series.torque == fresh.series.torque);
  CHECK(anew.series.torque.size() < whole.series.torque.size());
  CHECK(anew.summary.mean.front().mean == fresh.summary.mean.front().mean);
  CHECK(anew.summary.cpu_seconds == whole.summary.cpu_seconds);
  CHECK(anew.diagnostics.steps == whole.diagnostics.steps);
  CHECK(anew.checkpoint.state.position.empty());

  const dem::RunResult longer = run_point(with_longest(0.45), run.point, {.path = path, .keep_state = true});
  CHECK(longer.series.torque.size() > whole.series.torque.size());
}

TEST_CASE("a longer run goes on from a shorter one in another file, which stays, to the bits of a fresh run") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"), "60");
  const PlannedRun run = test::planned(workspace, 1).front();
  Workspace further = workspace;
  for (auto& [material, c] : further.cases) c.run.longest *= 1.5;
  const auto run_in = [&](const Workspace& of, const char* name, const std::string& from) {
    return run_point(of, run.point, {.path = folder.path(name), .from = from});
  };
  CHECK(longest_run(further, run.point, folder.path()).empty());
  const dem::RunResult first = run_in(workspace, "run.h5", "");
  CHECK(longest_run(further, run.point, folder.path()) == folder.path("run.h5"));
  std::filesystem::create_directory(folder.path("fresh"));
  const dem::RunResult fresh = run_in(further, "fresh/run.h5", "");
  const std::string kept = data::read_file(folder.path("run.h5"));
  const dem::RunResult longer = run_in(further, "run-longer.h5", folder.path("run.h5"));
  REQUIRE(fresh.series.torque.size() > first.series.torque.size());
  CHECK(longer.series.torque == fresh.series.torque);
  CHECK(longer.summary.mean.front().mean == fresh.summary.mean.front().mean);
  CHECK(longer.summary.cpu_seconds > first.summary.cpu_seconds);
  CHECK(data::read_file(folder.path("run.h5")) == kept);
  CHECK(longest_run(workspace, run.point, folder.path()) == folder.path("run-longer.h5"));
  Workspace other = further;
  ++other.study.seed;
  CHECK(longest_run(other, run.point, folder.path()).empty());
}

TEST_CASE(
    "a point whose rig cannot be simulated is a failed run with the reason, and the others of its batch are made") {
  const TemporaryFolder folder;
  const Workspace workspace =
      test::small_study(folder.path("out"), "480",
                        {"rig.rpm=\"200 rpm\"", "controls.rpm.target=\"rig.blade_radius\"", "controls.rpm.unit=\"mm\"",
                         "controls.rpm.low=3", "controls.rpm.high=7"});
  std::vector<PlannedRun> runs = test::planned(workspace, 2);
  const std::size_t blade = runs[0].point.inputs.size() - 1;
  runs[0].point.inputs[blade] = 6.9e-3;  // the trough's radius is 6 mm
  runs[1].point.inputs[blade] = 3.6e-3;
  for (int start = 0; start < 2; ++start) {
    const BatchResult batch = run_batch(workspace, runs, data::empty_table(workspace.study), {.jobs = 1});
    CHECK_FALSE(batch.error);
    INFO(batch.failures.back());
    REQUIRE(batch.failures.size() == 1);
    CHECK_THAT(batch.failures.front(), Contains("6.9 mm") && Contains("the blade turns inside rig.trough_radius"));
    CHECK(batch.table.rows.size() == 1);
    const std::string path = run_path(workspace, runs[0].point);
    CHECK(is_done(workspace, runs[0].point, path));  // a campaign that is started again does not try it again
  }
}

TEST_CASE("a damaged run is made again and named, a frame that cannot be written costs no run") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"), "60");
  const PlannedRun run = test::planned(workspace, 1).front();
  const std::string path = run_path(workspace, run.point);
  std::filesystem::create_directories(folder.path("frames/0001.vtkhdf/full"));
  const dem::RunResult whole =
      run_point(workspace, run.point, {.path = path, .frames = 2, .frames_folder = folder.path("frames")});
  REQUIRE(!whole.warnings.empty());
  CHECK_THAT(whole.warnings.back(), Contains("a frame is lacking") && Contains("0001.vtkhdf"));
  CHECK(is_done(workspace, run.point, path));

  std::string bytes = data::read_file(path);
  bytes[bytes.size() / 2] ^= 1;
  std::filesystem::remove(path);
  data::write_bytes(path, bytes);
  const dem::RunResult again = run_point(workspace, run.point, {.path = path});
  REQUIRE(!again.warnings.empty());
  CHECK_THAT(again.warnings.back(), Contains("was damaged, and the run is made again"));
  CHECK(again.series.torque == whole.series.torque);
}

TEST_CASE("a file of somebody else's in the place of a run is refused before any run is made") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"), "60");
  make_out(workspace, "runs");
  const std::vector<PlannedRun> runs = test::planned(workspace, 2);
  data::write_bytes(run_path(workspace, runs[1].point), "mine");
  CHECK_THAT(failure_of(folder, [&] { run_batch(workspace, runs, data::empty_table(workspace.study), {.jobs = 1}); }),
             Contains("73:") && Contains(".h5"));
  CHECK_FALSE(std::filesystem::exists(run_path(workspace, runs[0].point)));
}
