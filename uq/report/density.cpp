#include "uq/report/density.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

namespace uq {
namespace {

constexpr double bandwidth2 = 0.8 * 0.8;  ///< b^2; the neighbours are a piece of the whole, so b is not small

/// A symmetric two-by-two covariance.
struct Covariance {
  double xx = 0.0, xy = 0.0, yy = 0.0;
};

/// Points of the unit square.
struct Points {
  std::vector<double> x, y;
};

/// Covariance about point i of the `count` draws nearest to it.
Covariance neighbourhood(const Points& points, std::size_t i, std::size_t count) {
  const std::size_t n = points.x.size();
  std::vector<std::pair<double, std::size_t>> by_distance(n);
  for (std::size_t j = 0; j < n; ++j) {
    by_distance[j] = {std::hypot(points.x[j] - points.x[i], points.y[j] - points.y[i]), j};
  }
  std::nth_element(by_distance.begin(), by_distance.begin() + static_cast<std::ptrdiff_t>(count), by_distance.end());
  double mean_x = 0.0, mean_y = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    mean_x += points.x[by_distance[k].second];
    mean_y += points.y[by_distance[k].second];
  }
  mean_x /= static_cast<double>(count);
  mean_y /= static_cast<double>(count);
  Covariance covariance;
  for (std::size_t k = 0; k < count; ++k) {
    const double dx = points.x[by_distance[k].second] - mean_x;
    const double dy = points.y[by_distance[k].second] - mean_y;
    covariance.xx += dx * dx;
    covariance.xy += dx * dy;
    covariance.yy += dy * dy;
  }
  const double share = 1.0 / static_cast<double>(count);
  return {covariance.xx * share, covariance.xy * share, covariance.yy * share};
}

/// Adds one kernel that sums to 1/n on the grid of `cells` x `cells` over the unit square.
void add_kernel(std::vector<double>& density, int cells, std::pair<double, double> centre, const Covariance& shape,
                double weight) {
  const double determinant = shape.xx * shape.yy - shape.xy * shape.xy;
  const double reach_x = 4.0 * std::sqrt(shape.xx), reach_y = 4.0 * std::sqrt(shape.yy);
  const auto cell = [cells](double at) { return std::clamp(static_cast<int>(at * cells), 0, cells - 1); };
  const int x_first = cell(centre.first - reach_x), x_last = cell(centre.first + reach_x);
  const int y_first = cell(centre.second - reach_y), y_last = cell(centre.second + reach_y);
  std::vector<double> kernel;
  kernel.reserve((x_last - x_first + 1) * (y_last - y_first + 1));
  double sum = 0.0;
  for (int i = x_first; i <= x_last; ++i) {
    const double dx = (i + 0.5) / cells - centre.first;
    for (int j = y_first; j <= y_last; ++j) {
      const double dy = (j + 0.5) / cells - centre.second;
      const double distance2 = (shape.yy * dx * dx - 2.0 * shape.xy * dx * dy + shape.xx * dy * dy) / determinant;
      kernel.push_back(std::exp(-0.5 * distance2));
      sum += kernel.back();
    }
  }
  if (!(sum > 0.0)) return;
  std::size_t k = 0;
  for (int i = x_first; i <= x_last; ++i) {
    for (int j = y_first; j <= y_last; ++j) density[i * cells + j] += weight / sum * kernel[k++];
  }
}

/// The density at which the highest cells have gathered `mass`.
double level_of(const std::vector<double>& falling, double mass) {
  double gathered = 0.0;
  for (const double value : falling) {
    gathered += value;
    if (gathered >= mass) return value;
  }
  return falling.empty() ? 0.0 : falling.back();
}

}  // namespace

DensityGrid joint_density(const std::vector<double>& x, const std::vector<double>& y, const PlotBox& box,
                          const DensityOptions& options) {
  const double width = box.x_high - box.x_low, height = box.y_high - box.y_low;
  if (!(width > 0.0) || !(height > 0.0)) return {};
  Points points;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    const double u = (x[i] - box.x_low) / width, v = (y[i] - box.y_low) / height;
    if (!(u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0)) continue;
    points.x.push_back(u);
    points.y.push_back(v);
  }
  const std::size_t n = points.x.size();
  if (n < 20) return {};
  const auto [x_min, x_max] = std::minmax_element(points.x.begin(), points.x.end());
  const auto [y_min, y_max] = std::minmax_element(points.y.begin(), points.y.end());
  if (!(*x_max > *x_min) || !(*y_max > *y_min)) return {};

  // A kernel is never narrower than what a cell can show.
  const int cells = options.cells;
  const double floor = 0.8 / cells * 0.8 / cells;
  const auto neighbours =
      std::clamp(static_cast<std::size_t>(options.neighbour_share * static_cast<double>(n)), std::size_t{10}, n - 1);
  DensityGrid grid;
  grid.density.assign(cells * cells, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    Covariance shape = neighbourhood(points, i, neighbours);
    shape = {bandwidth2 * shape.xx + floor, bandwidth2 * shape.xy, bandwidth2 * shape.yy + floor};
    add_kernel(grid.density, cells, {points.x[i], points.y[i]}, shape, 1.0 / static_cast<double>(n));
  }
  for (int i = 0; i < cells; ++i) {
    grid.x.push_back(box.x_low + width * (i + 0.5) / cells);
    grid.y.push_back(box.y_low + height * (i + 0.5) / cells);
  }
  std::vector<double> falling = grid.density;
  std::sort(falling.begin(), falling.end(), std::greater<>());
  grid.level50 = level_of(falling, 0.5);
  grid.level90 = level_of(falling, 0.9);
  return grid;
}

}  // namespace uq
