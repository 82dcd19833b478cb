#include "uq/posterior/plane.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace uq {
namespace {

using Eigen::Vector2d;

/// Twice the area of the triangle a, b, c: positive when it turns left.
double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

double distance_to_segment(const Vector2d& a, const Vector2d& b, const Vector2d& point) {
  const Vector2d along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (point - a - t * along).norm();
}

}  // namespace

std::vector<Vector2d> convex_hull(const Eigen::MatrixXd& points) {
  std::vector<Vector2d> sorted;
  for (Eigen::Index i = 0; i < points.rows(); ++i) sorted.emplace_back(points(i, 0), points(i, 1));
  std::sort(sorted.begin(), sorted.end(),
            [](const Vector2d& a, const Vector2d& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  if (sorted.size() < 3) return sorted;
  std::vector<Vector2d> hull;
  const auto add = [&](const Vector2d& point, std::size_t least) {
    while (hull.size() > least && turn(hull[hull.size() - 2], hull.back(), point) <= 0.0) hull.pop_back();
    hull.push_back(point);
  };
  for (const Vector2d& point : sorted) add(point, 1);
  const std::size_t lower = hull.size();
  for (std::size_t i = sorted.size() - 1; i-- > 0;) add(sorted[i], lower);
  hull.pop_back();
  return hull;
}

double distance_to_hull(const std::vector<Vector2d>& hull, const Vector2d& point) {
  if (hull.empty()) return std::numeric_limits<double>::infinity();
  bool inside = hull.size() > 2;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2d& a = hull[i];
    const Vector2d& b = hull[(i + 1) % hull.size()];
    inside = inside && turn(a, b, point) >= 0.0;
    nearest = std::min(nearest, distance_to_segment(a, b, point));
  }
  return inside ? 0.0 : nearest;
}

}  // namespace uq
