#include "uq/posterior/runs_around.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "uq/posterior/plane.hpp"

namespace uq {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool in_gap(const std::pair<double, double>& gap, double value, double slack) {
  const double margin = std::min(slack, 0.25 * (gap.second - gap.first));
  return value > gap.first + margin && value < gap.second - margin;
}

std::vector<Plane> planes_of(const RunCloud& runs, const std::vector<InputLine>& lines) {
  std::vector<Plane> planes;
  for (Index a = 0; a < runs.points.cols(); ++a)
    for (Index b = a + 1; b < runs.points.cols(); ++b) {
      std::set<std::pair<double, double>> distinct;
      for (Index i = 0; i < runs.points.rows(); ++i) distinct.emplace(runs.points(i, a), runs.points(i, b));
      Plane plane{.first = a,
                  .second = b,
                  .points = MatrixXd(static_cast<Index>(distinct.size()), 2),
                  .hull = {},
                  .regular = {0.5 * lines[a].spacing, 0.5 * lines[b].spacing}};
      Index row = 0;
      for (const auto& [x, y] : distinct) plane.points.row(row++) << x, y;
      const double count = static_cast<double>(std::max<std::size_t>(distinct.size(), 3));
      plane.radius = std::sqrt(std::log(count) / (std::numbers::pi * count));
      plane.hull = convex_hull(plane.points);
      planes.push_back(std::move(plane));
    }
  return planes;
}

bool is_empty(const Plane& plane, const Eigen::Vector2d& at, double factor) {
  const Eigen::ArrayXXd away = (plane.points.rowwise() - at.transpose()).array().abs();
  const Eigen::ArrayXXd beyond = (away.rowwise() - plane.regular.transpose()).max(0.0);
  const double nearest = std::sqrt(beyond.square().rowwise().sum().minCoeff());
  if (nearest > factor * plane.radius) return true;
  return nearest > plane.radius && distance_to_hull(plane.hull, at) > 0.1;
}

/// Variance of the function at each point over that without any runs.
VectorXd variance_ratio(const Emulator& emulator, const MatrixXd& points) {
  const surrogate::Prediction prediction = emulator.predict(points);
  Eigen::ArrayXd variance = prediction.covariance.diagonal().array().max(0.0);
  if (emulator.runs->logarithmic) variance = (variance / prediction.mean.array().square()).log1p();
  return (variance / emulator.runs->prior_variance).matrix();
}

/// At how many of a draw's rows each test rejects.
struct Rejected {
  std::vector<Index> outside, gap;  ///< per input
  std::vector<Index> holes;         ///< per plane
  Index empty = 0, uncertain = 0, any = 0;
};

/// Which gap of a line a value lies in, or -1; of several the last.
int gap_at(const InputLine& line, double value) {
  int found = -1;
  for (std::size_t g = 0; g < line.gaps.size(); ++g)
    if (in_gap(line.gaps[g], value, line.slack)) found = static_cast<int>(g);
  return found;
}

/// Points of the unit cube on the scales on which the runs are learnt, in length scales.
MatrixXd scaled(const Emulator& emulator, const MatrixXd& points) {
  return learnt_points(emulator.inputs, points).array().rowwise() / emulator.runs->length_scales.transpose().array();
}

/// Distance of each row to the nearest run, in length scales: the sum over the rows.
double summed_distance(const Ground& ground, const MatrixXd& points) {
  const MatrixXd here = scaled(ground.group->emulator, points);
  double sum = 0.0;
  for (Index i = 0; i < here.rows(); ++i)
    sum += std::sqrt((ground.scaled.rowwise() - here.row(i)).rowwise().squaredNorm().minCoeff());
  return sum;
}

}  // namespace

InputLine line_of(const VectorXd& column, const SupportThresholds& t) {
  std::vector<double> values(column.begin(), column.end());
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end(), [](double a, double b) { return b - a < 1e-6; }),
               values.end());
  InputLine line{.low = values.front(), .high = values.back(), .slack = t.slack_most, .gaps = {}};
  const std::size_t spacings = values.size() - 1;
  if (spacings == 0) return line;
  const double mean = (line.high - line.low) / static_cast<double>(spacings);
  if (spacings > 1) line.spacing = mean;  // two values are no regular levels: nothing shows what lies between
  line.slack = std::clamp(t.slack_gaps * mean, t.slack_least, t.slack_most);
  for (std::size_t i = 0; i < spacings && spacings > 1; ++i) {
    const double gap = values[i + 1] - values[i];
    const double others = (line.high - line.low - gap) / static_cast<double>(spacings - 1);
    if (gap > t.gap_least && gap > t.gap_factor * others) line.gaps.emplace_back(values[i], values[i + 1]);
  }
  return line;
}

Ground ground_of(const RowGroup& group, const SupportThresholds& t) {
  Ground ground{.group = &group,
                .lines = {},
                .planes = {},
                .rows = {},
                .scaled = scaled(group.emulator, group.emulator.runs->points)};
  for (Index k = 0; k < group.emulator.runs->points.cols(); ++k)
    ground.lines.push_back(line_of(group.emulator.runs->points.col(k), t));
  ground.planes = planes_of(*group.emulator.runs, ground.lines);
  constexpr Index most = 8;
  const Index rows = group.base.rows();
  for (Index i = 0; i < std::min(rows, most); ++i)
    ground.rows.push_back(rows <= most ? i : i * (rows - 1) / (most - 1));
  return ground;
}

MatrixXd points_at(const Ground& ground, const VectorXd& u) {
  const RowGroup& group = *ground.group;
  MatrixXd points(static_cast<Index>(ground.rows.size()), group.base.cols());
  for (Index i = 0; i < points.rows(); ++i)
    for (Index k = 0; k < points.cols(); ++k) points(i, k) = group.input(ground.rows[i], k, u);
  return points;
}

RunsAround runs_around(const Ground& ground, const VectorXd& u, const SupportThresholds& t) {
  const Emulator& emulator = ground.group->emulator;
  const MatrixXd points = points_at(ground, u);
  const VectorXd ratios = variance_ratio(emulator, points);
  const Index rows = points.rows();
  const std::vector<Index> none(ground.lines.size(), 0);
  Rejected rejected{.outside = none, .gap = none, .holes = std::vector<Index>(ground.planes.size(), 0)};
  RunsAround met{.outside = {}, .gap = std::vector<int>(ground.lines.size(), -1)};

  // Each row by itself: beyond the runs, in a gap, in a hole, or where the surrogate knows little.
  for (Index i = 0; i < rows; ++i) {
    bool bad = false, hole = false;
    for (std::size_t k = 0; k < ground.lines.size(); ++k) {
      const InputLine& line = ground.lines[k];
      const double value = points(i, k);
      const bool beyond = value < line.low - line.slack || value > line.high + line.slack;
      const int gap = gap_at(line, value);
      if (gap >= 0) met.gap[k] = gap;
      rejected.outside[k] += beyond;
      rejected.gap[k] += gap >= 0;
      bad = bad || beyond || gap >= 0;
    }
    for (std::size_t p = 0; p < ground.planes.size(); ++p) {
      const Plane& plane = ground.planes[p];
      if (!is_empty(plane, {points(i, plane.first), points(i, plane.second)}, t.empty_factor)) continue;
      hole = true;
      ++rejected.holes[p];
    }
    const bool uncertain = ratios[i] > t.uncertain;
    rejected.empty += hole;
    rejected.uncertain += uncertain;
    rejected.any += bad || hole || uncertain;
  }

  // The draw: what holds at half of its rows or more. Where only all tests together reject so many, each that rejects
  // any row is named.
  Index most = std::max(rejected.empty, rejected.uncertain);
  for (std::size_t k = 0; k < ground.lines.size(); ++k) most = std::max({most, rejected.outside[k], rejected.gap[k]});
  const bool together = 2 * rejected.any >= rows && 2 * most < rows;
  const auto at_half = [&](Index count) { return together ? count > 0 : 2 * count >= rows; };
  for (std::size_t k = 0; k < ground.lines.size(); ++k) {
    met.outside.push_back(at_half(rejected.outside[k]));
    if (!at_half(rejected.gap[k])) met.gap[k] = -1;
  }
  if (at_half(rejected.empty))
    met.empty_plane = static_cast<std::size_t>(std::max_element(rejected.holes.begin(), rejected.holes.end()) -
                                               rejected.holes.begin());
  met.uncertain = at_half(rejected.uncertain);
  met.unsupported = at_half(rejected.any);
  met.distance = summed_distance(ground, points) / static_cast<double>(rows);
  met.ratio = ratios.mean();
  return met;
}

InputValue input_value(const data::Study& study, const EmulatorInput& input, double u) {
  const data::Input named = input_of(study, input);
  return {named.name, named.unit, named.unit.from_si(named.axis.from_unit(u))};
}

}  // namespace uq
