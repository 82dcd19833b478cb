// Which runs a campaign around the posterior begins with.
#include "campaign/posterior_runs.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "campaign/design.hpp"
#include "tests/campaign/fake_slurm.hpp"
#include "tests/temporary.hpp"
#include "uq/posterior/control_reach.hpp"

using namespace campaign;

TEST_CASE("a campaign begins with runs that reach the measured controls, where those that are there do not") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"));
  const data::Control& rpm = workspace.study.controls.at(0);
  const double slack = uq::control_reach * (rpm.high - rpm.low);
  double least = rpm.high, most = rpm.low;
  for (const data::Observation& point : workspace.study.observations.at(0).points) {
    least = std::min(least, point.controls[0]);
    most = std::max(most, point.controls[0]);
  }
  const std::size_t at = workspace.study.parameters.size();
  const auto table_of = [&](double low, double high) {
    data::RunTable table = data::empty_table(workspace.study);
    for (const Point& point : training_design(workspace, "powder", 0, 64))
      if (point.inputs[at] >= low && point.inputs[at] <= high)
        table.rows.push_back({.material = "powder",
                              .inputs = point.inputs,
                              .seed = workspace.study.seed,
                              .settings = settings_hash(workspace, "powder")});
    return table;
  };
  CHECK(starting_runs(workspace, table_of(rpm.low, rpm.high)).empty());

  const data::RunTable middle = table_of(least + 2.0 * slack, most - 2.0 * slack);
  REQUIRE(middle.rows.size() > 10);
  double low = rpm.high, high = rpm.low;
  const std::vector<PlannedRun> added = starting_runs(workspace, middle);
  for (const PlannedRun& run : added) {
    low = std::min(low, run.point.inputs[at]);
    high = std::max(high, run.point.inputs[at]);
  }
  CHECK(added.size() >= 2);
  CHECK(added.size() < 10);
  CHECK(low <= least + slack);
  CHECK(high >= most - slack);
  CHECK(without_rows(workspace, added, middle).size() == added.size());
}
