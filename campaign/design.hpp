#pragma once
// The training campaign: which points are to be simulated, and which of them are still missing.
#include <cstdint>
#include <string>
#include <vector>

#include "campaign/point.hpp"

namespace campaign {

constexpr int point_digits = 5;  ///< significant digits of a point's values in their units

/// Points first .. first + runs - 1 of the material's training design: scrambled Sobol' over what its runs vary
/// (parameters on their scale, controls linearly), each value rounded to five digits in its unit, so that a point that
/// is typed in is the same point.
std::vector<Point> training_design(const Workspace& workspace, const std::string& material, int first, int runs);

/// What a campaign simulates now, and what it leaves for later.
struct Campaign {
  std::vector<Point> points;
  std::vector<Point> later;  ///< points of OUT/design.csv that are not made now, and stay in it
  bool continues = false;    ///< an earlier campaign was unfinished, and nothing is added to it

  /// All that OUT/design.csv lists while `now` of the points are still to be made.
  std::vector<Point> listed(std::vector<Point> now) const;
};

/// The points to simulate now: points without a row in `table`, or with a row that is not of the steady flow and whose
/// run would now go on for longer, or with one that lacks an output which the study has by now. First come those that
/// OUT/design.csv lists, as an unfinished campaign left it or somebody wrote it, then the study's own design. When
/// nothing was left unfinished, further points are added up to `runs`, shared among the materials. `runs` above 0 is
/// also the most.
Campaign plan_campaign(const Workspace& workspace, const data::RunTable& table, int runs);

/// Reads OUT/design.csv: material, parameters and controls in the study's units.
std::vector<Point> read_design(const Workspace& workspace);
std::vector<Point> read_points(const Workspace& workspace, const std::string& path);
/// A further column of a file of points, behind the others.
struct PointColumn {
  std::string name;
  std::vector<std::string> values;  ///< one value a point
};
/// Writes points as CSV, with a line that says their units. `more`: further columns; `head`: lines of comment above the
/// columns' names.
void write_points(const Workspace& workspace, const std::string& path, const std::vector<Point>& points,
                  const std::vector<PointColumn>& more = {}, const std::string& head = "");

/// A run to make. Runs at one point with other seeds are replicates: they share nothing but the point.
struct PlannedRun {
  Point point;
  std::uint64_t seed = 0;  ///< seed of the run's random streams and of its row
};
std::vector<Point> points_of(const std::vector<PlannedRun>& runs);
/// The column from which `read_runs` takes the runs' seeds.
PointColumn seeds_of(const std::vector<PlannedRun>& runs);
/// Reads points with their seeds. Throws data::InputError (65) where a seed is no whole number.
std::vector<PlannedRun> read_runs(const Workspace& workspace, const std::string& path);

/// The first `runs` points of OUT/next-runs.csv that have no row yet. Throws InputError (66) when there is no such
/// file.
Campaign plan_at_posterior(const Workspace& workspace, const data::RunTable& table, int runs);
/// Writes OUT/design.csv, as read_design reads it.
void write_design(const Workspace& workspace, const std::vector<Point>& points);

/// The name of the run's file: "zirconia-100-1f3a..". It is equal for equal point, seed and settings.
std::string run_name(const Workspace& workspace, const Point& point);
/// The path of the run's file: OUT/runs/NAME.h5.
std::string run_path(const Workspace& workspace, const Point& point);

}  // namespace campaign
