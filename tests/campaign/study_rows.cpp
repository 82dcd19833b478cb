// Rows of a table that was written before the study had all its outputs.
#include "campaign/study_rows.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "campaign/design.hpp"
#include "campaign/out_files.hpp"
#include "campaign/run_point.hpp"
#include "campaign/training_table.hpp"
#include "dem/run/run_file.hpp"
#include "tests/campaign/fake_slurm.hpp"
#include "tests/temporary.hpp"

using namespace campaign;

namespace {

std::string said(const StudyRows& rows) {
  std::string all;
  for (const std::string& note : rows.notes) all += note + "\n";
  return all;
}

}  // namespace

TEST_CASE(
    "an output that comes to a study is read from the runs that were made, and runs that are gone are made again") {
  const TemporaryFolder folder;
  const std::string out = folder.path("out");
  const Workspace before = test::small_study(out);
  make_out(before, "runs");
  data::RunTable table = data::empty_table(before.study);
  const std::vector<PlannedRun> runs = test::planned(before, 3);
  for (const PlannedRun& run : runs) {
    test::write_result(before, run);
    table.rows.push_back(to_row(before, run.point, *finished_run(before, run.point, run_path(before, run.point))));
  }
  write_tables(before, table, {});

  const Workspace after = test::small_study(out, "200", {"outputs.axial_flow.unit=g/s"});
  REQUIRE(after.study.outputs.size() == before.study.outputs.size() + 1);
  const StudyRows whole = study_rows(after);
  REQUIRE(whole.all.rows.size() == 3);
  for (const data::RunRow& row : whole.all.rows) CHECK_FALSE(data::lacks_output(whole.all, row));
  CHECK_THAT(said(whole), Catch::Contains("3 of 3 rows") && Catch::Contains("completed from their runs"));
  const std::size_t design = plan_campaign(after, whole.all, 0).points.size();

  std::filesystem::remove(run_path(before, runs[1].point));
  const StudyRows part = study_rows(after);
  CHECK_THAT(said(part), Catch::Contains("1 of 3 rows") && Catch::Contains("demcal train makes them again"));
  const Campaign campaign = plan_campaign(after, part.all, 0);
  CHECK(campaign.points.size() == design + 1);
  CHECK(std::any_of(campaign.points.begin(), campaign.points.end(),
                    [&](const Point& point) { return point.inputs == runs[1].point.inputs; }));
}
