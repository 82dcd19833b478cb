// What a run's file holds is the run.
#include "campaign/run_point.hpp"

#include <catch2/catch.hpp>

#include "tests/campaign/fake_slurm.hpp"
#include "tests/temporary.hpp"

using namespace campaign;

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
