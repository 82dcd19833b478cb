#include "dem/run/silhouette.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace dem {
namespace {

constexpr double cells_across_sphere = 4.0;
constexpr int most_cells = 256;
constexpr double fit_from = 0.1, fit_to = 0.6;  // of R, from the line through axis and centre
constexpr double most_left_out = 0.1;           // of the surface, where powder lies above it
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The two ends of the box along a direction, counted from the origin [m].
std::pair<double, double> extent(const Box& box, Vec3 origin, Vec3 direction) {
  const Vec3 middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
  const double at = dot(direction, middle - origin);
  const double reach = std::abs(direction.x) * half.x + std::abs(direction.y) * half.y + std::abs(direction.z) * half.z;
  return {at - reach, at + reach};
}

/// First and last cell whose centre lies within `half` of `at`, both in cells, of `cells`.
struct Range {
  int first, last;
};
Range covered(double at, double half, int cells) {
  return {std::max(0, static_cast<int>(std::ceil(at - half - 0.5))),
          std::min(cells - 1, static_cast<int>(std::floor(at + half - 0.5)))};
}

/// The time-averaged projection in the frame of the slope: s up along it, h across it, both from the axis.
class Slope {
 public:
  Slope(const PicturePlane& plane, const Exposure& exposure, double angle)
      : plane_(plane), exposure_(exposure), cos_(std::cos(angle)), sin_(std::sin(angle)) {
    limit_ = plane.cell * std::hypot(plane.columns, plane.rows) +
             std::hypot(plane.left, plane.bottom);  // beyond all cells, seen from the axis
  }

  struct Surface {
    double height;  ///< m
    bool open;      ///< nothing lies above it
  };
  /// At s [m], looked for from the height `from`.
  std::optional<Surface> surface(double s, double from) const {
    const double step = 0.5 * plane_.cell;
    double h = from;
    if (powder(s, h)) {
      while (powder(s, h + step)) h += step;
    } else {
      while (!powder(s, h - step)) {
        h -= step;
        if (h < -limit_) return {};
      }
      h -= step;
    }
    bool open = true;
    for (double above = h + 2.0 * step; above < limit_; above += plane_.cell) open = open && !powder(s, above);
    const double below = share(s, h), over = share(s, h + step);
    return Surface{h + step * (below - silhouette_share) / (below - over), open};
  }

  bool powder(double s, double h) const { return share(s, h) > silhouette_share; }

 private:
  double share(double s, double h) const {
    const double u = (s * cos_ - h * sin_ - plane_.left) / plane_.cell - 0.5,
                 v = (s * sin_ + h * cos_ - plane_.bottom) / plane_.cell - 0.5;
    const double i = std::floor(u), j = std::floor(v), du = u - i, dv = v - j;
    const auto column = static_cast<int>(i), row = static_cast<int>(j);
    return (1.0 - dv) * ((1.0 - du) * of_cell(column, row) + du * of_cell(column + 1, row)) +
           dv * ((1.0 - du) * of_cell(column, row + 1) + du * of_cell(column + 1, row + 1));
  }
  double of_cell(int column, int row) const {
    if (column < 0 || row < 0 || column >= plane_.columns || row >= plane_.rows) return 0.0;
    const std::size_t at =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(plane_.columns) + static_cast<std::size_t>(column);
    return static_cast<double>(exposure_.covered[at]) / static_cast<double>(exposure_.pictures);
  }

  const PicturePlane& plane_;
  const Exposure& exposure_;
  double cos_, sin_, limit_;
};

/// The slope of the line of least squares through the surface on one side: `way` is 1 uphill and -1 downhill.
double fitted_slope(const Slope& slope, const PicturePlane& plane, double centre, double way) {
  if (!slope.powder(0.0, centre)) return unknown;
  double n = 0.0, left_out = 0.0, s1 = 0.0, h1 = 0.0, ss = 0.0, sh = 0.0, from = centre;
  for (double s = 0.0; s < fit_to * plane.reach; s += plane.cell) {
    const auto found = slope.surface(way * s, from);
    if (!found) return unknown;
    from = found->height;
    if (s <= fit_from * plane.reach) continue;
    (found->open ? n : left_out) += 1.0;
    if (!found->open) continue;
    s1 += s;
    h1 += from;
    ss += s * s;
    sh += s * from;
  }
  if (left_out > most_left_out * (n + left_out)) return unknown;
  return way * (n * sh - s1 * h1) / (n * ss - s1 * s1);  // 0 / 0 of fewer than two columns
}

}  // namespace

PicturePlane picture_plane(const Picture& picture, const Box& box, double smallest_radius) {
  PicturePlane plane{.picture = picture};
  if (!shows_bed(picture, box.periodic)) return plane;
  const auto [left, right] = extent(box, picture.origin, picture.right);
  const auto [bottom, top] = extent(box, picture.origin, picture.up);
  plane.left = left;
  plane.bottom = bottom;
  plane.cell = std::max(2.0 * smallest_radius / cells_across_sphere, std::max(right - left, top - bottom) / most_cells);
  plane.columns = std::clamp(static_cast<int>(std::ceil((right - left) / plane.cell)), 1, most_cells);
  plane.rows = std::clamp(static_cast<int>(std::ceil((top - bottom) / plane.cell)), 1, most_cells);
  plane.reach = 0.5 * (right - left);
  return plane;
}

void expose(const PicturePlane& plane, std::span<const PositionRow> spheres, Exposure& exposure) {
  const auto columns = static_cast<std::size_t>(plane.columns), rows = static_cast<std::size_t>(plane.rows);
  std::vector<std::uint8_t> picture(columns * rows);
  const auto row_of = [&](int row) { return picture.begin() + static_cast<std::ptrdiff_t>(row) * plane.columns; };
  for (const PositionRow& sphere : spheres) {
    const Vec3 at = sphere.at - plane.picture.origin;
    const double u = (dot(plane.picture.right, at) - plane.left) / plane.cell,
                 v = (dot(plane.picture.up, at) - plane.bottom) / plane.cell, radius = sphere.radius / plane.cell;
    const Range rows_in = covered(v, radius, plane.rows);
    for (int row = rows_in.first; row <= rows_in.last; ++row) {
      const double across = row + 0.5 - v;
      const Range in = covered(u, std::sqrt(std::max(0.0, radius * radius - across * across)), plane.columns);
      if (in.first <= in.last) std::fill(row_of(row) + in.first, row_of(row) + in.last + 1, std::uint8_t{1});
    }
    const int column = std::clamp(static_cast<int>(u), 0, plane.columns - 1);
    row_of(std::clamp(static_cast<int>(v), 0, plane.rows - 1))[column] = 1;
  }
  exposure.covered.resize(picture.size());
  for (std::size_t k = 0; k < picture.size(); ++k)
    exposure.covered[k] = static_cast<std::uint8_t>(exposure.covered[k] + picture[k]);
  ++exposure.pictures;
}

Silhouette silhouette_of(const PicturePlane& plane, const Exposure& exposure) {
  const double least = silhouette_share * exposure.pictures;
  double cells = 0.0, columns = 0.0, rows = 0.0;
  std::size_t at = 0;
  for (int row = 0; row < plane.rows; ++row) {
    for (int column = 0; column < plane.columns; ++column, ++at) {
      if (!(static_cast<double>(exposure.covered[at]) > least)) continue;
      cells += 1.0;
      columns += column + 0.5;
      rows += row + 0.5;
    }
  }
  Silhouette found{unknown, unknown, cells * plane.cell * plane.cell, unknown, unknown};
  if (cells == 0.0) return found;
  found.x = plane.left + plane.cell * columns / cells;
  found.z = plane.bottom + plane.cell * rows / cells;
  const double angle = std::atan2(found.x, -found.z), distance = std::hypot(found.x, found.z);
  const Slope slope(plane, exposure, angle);
  found.upper_angle = angle + std::atan(fitted_slope(slope, plane, -distance, 1.0));
  found.lower_angle = angle + std::atan(fitted_slope(slope, plane, -distance, -1.0));
  return found;
}

}  // namespace dem
