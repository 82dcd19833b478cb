// Which runs are missing, and which are not added a second time.
#include "campaign/design.hpp"

#include <catch2/catch.hpp>

#include "campaign/out_files.hpp"
#include "campaign/run_point.hpp"
#include "tests/campaign/fake_slurm.hpp"
#include "tests/temporary.hpp"

using namespace campaign;

TEST_CASE("a campaign that was killed as its last run had ended is not begun a second time") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"));
  make_out(workspace, "runs");
  data::RunTable table = data::empty_table(workspace.study);
  const auto make = [&](const std::vector<Point>& points) {
    for (const Point& point : points) {
      test::write_result(workspace, {point, workspace.study.seed});
      const auto result = ended_run(workspace, point, run_path(workspace, point));
      REQUIRE(result);
      table.rows.push_back(to_row(workspace, point, *result));
    }
  };
  make(plan_campaign(workspace, table, 0).points);
  CHECK(plan_campaign(workspace, table, 0).points.empty());

  const Campaign more = plan_campaign(workspace, table, 3);
  CHECK(more.points.size() == 3);
  CHECK_FALSE(more.continues);
  write_design(workspace, more.points);
  make({more.points[0], more.points[1]});
  const Campaign rest = plan_campaign(workspace, table, 3);
  CHECK(rest.continues);
  CHECK(rest.points.size() == 1);
  make({more.points[2]});
  CHECK(plan_campaign(workspace, table, 3).points.empty());  // the design still stands
  write_design(workspace, {});
  CHECK(plan_campaign(workspace, table, 3).points.size() == 3);
}

TEST_CASE("points that somebody listed stay in the list until they are made, whatever a call makes of them") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"));
  make_out(workspace, "runs");
  const data::RunTable none = data::empty_table(workspace.study);
  const std::string material = workspace.study.materials.front().name;
  const std::vector<Point> mine = training_design(workspace, material, 100, 3);
  const auto same = [](const std::vector<Point>& a, const std::vector<Point>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Point& one, const Point& other) {
      return one.material == other.material && one.inputs == other.inputs;
    });
  };
  write_design(workspace, mine);
  const Campaign one = plan_campaign(workspace, none, 1);
  CHECK(same(one.points, {mine[0]}));
  CHECK(same(one.later, {mine[1], mine[2]}));
  CHECK(same(one.listed(one.points), mine));
  CHECK(same(one.listed({}), {mine[1], mine[2]}));
  CHECK(plan_campaign(workspace, none, 0).later.empty());  // all of them, and the design

  // A call that makes other points leaves them, too; what such a call left is done before, and nothing further.
  const std::vector<Point> posterior = training_design(workspace, material, 200, 3);
  write_points(workspace, next_runs_path(workspace), posterior);
  const Campaign two = plan_at_posterior(workspace, none, 2);
  CHECK(same(two.points, {posterior[0], posterior[1]}));
  CHECK(same(two.later, mine));
  write_design(workspace, two.listed({posterior[1]}));
  const Campaign rest = plan_at_posterior(workspace, none, 2);
  CHECK(rest.continues);
  CHECK(same(rest.points, {posterior[1]}));
  CHECK(same(rest.later, mine));
}

TEST_CASE("a design is read in the units that it was written in, when the study's have changed since") {
  const TemporaryFolder folder;
  Workspace workspace = test::small_study(folder.path("out"));
  make_out(workspace, "runs");
  const std::vector<Point> points = training_design(workspace, workspace.study.materials.front().name, 0, 3);
  write_design(workspace, points);
  const auto differ = [&](double by) {
    const std::vector<Point> again = read_design(workspace);
    REQUIRE(again.size() == points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      REQUIRE(again[k].inputs.size() == points[k].inputs.size());
      for (std::size_t i = 0; i < points[k].inputs.size(); ++i)
        if (std::abs(again[k].inputs[i] - points[k].inputs[i]) > by * std::abs(points[k].inputs[i])) return true;
    }
    return false;
  };
  CHECK_FALSE(differ(0.0));
  REQUIRE_FALSE(workspace.study.controls.empty());
  data::Unit& unit = workspace.study.controls.front().unit;
  unit = data::parse_unit(unit.symbol == "rpm" ? "rad/s" : "rpm");
  CHECK_FALSE(differ(1e-12));
}

TEST_CASE(
    "what is dropped of a run changes what its row means, and neither its course nor the file that it is kept in") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"));
  const Point point = test::planned(workspace, 1).front().point;
  Workspace other = workspace;
  for (auto& [material, c] : other.cases) c.run.start_up_turns += 1.0;
  CHECK(settings_hash(other, point.material) != settings_hash(workspace, point.material));
  CHECK(course_hash(other, point.material) == course_hash(workspace, point.material));
  CHECK(run_seed(other, point) == run_seed(workspace, point));
  CHECK(run_path(other, point) == run_path(workspace, point));
  Workspace softer = workspace;
  for (auto& [material, c] : softer.cases) c.contact.stiffness *= 0.5;
  CHECK(course_hash(softer, point.material) != course_hash(workspace, point.material));
  CHECK(run_path(softer, point) != run_path(workspace, point));
}

TEST_CASE("a list with a material that the study no longer has says where it stands, and what may be done") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"));
  make_out(workspace, "");
  write_design(workspace, training_design(workspace, workspace.study.materials.front().name, 0, 2));
  Workspace renamed = workspace;
  renamed.study.materials.front().name = "glass";
  CHECK_THAT(failure_of(folder, [&] { read_design(renamed); }),
             Catch::StartsWith("65: ") && Catch::Contains("design.csv:4: material") &&
                 Catch::Contains("the study has no material 'powder' (it has glass)") &&
                 Catch::Contains("or remove design.csv"));
}
