#pragma once
// The joint density of two parameters from draws, on a grid, for contours of the highest-density regions.
//
// Each draw carries a Gaussian kernel whose shape is the covariance C_i of the draw's own neighbours (the nearest fifth
// of all draws), scaled:
//   p(x) = 1/n sum_i w_i exp(-1/2 (x - x_i)' [b^2 C_i]^-1 (x - x_i)),   b = 0.8,
// so that kernels lie along a curved ridge and do not blur it. w_i makes each kernel sum to one inside the box: at a
// bound no density leaks out. For drawing only: no number of the report is computed from it.
#include <vector>

namespace uq {

struct PlotBox {
  double x_low = 0.0, x_high = 1.0, y_low = 0.0, y_high = 1.0;
};

struct DensityGrid {
  std::vector<double> x, y;     ///< cell centres
  std::vector<double> density;  ///< x.size() * y.size() cells, x slowest; the cells sum to one
  double level50 = 0.0;         ///< density at the edge of the smallest region that holds half
  double level90 = 0.0;
};

struct DensityOptions {
  int cells = 96;                ///< cells per axis
  double neighbour_share = 0.2;  ///< share of the draws that shape a kernel
};

/// The density on a grid over the box. Draws beyond the box are left out. The grid is empty when fewer than 20 are left
/// or they do not vary.
DensityGrid joint_density(const std::vector<double>& x, const std::vector<double>& y, const PlotBox& box,
                          const DensityOptions& options = {});

/// A closed line; its last point joins its first.
struct Loop {
  std::vector<double> x, y;
};

/// The lines at which the density crosses `level`, by marching squares on the cell centres with linear interpolation.
/// Beyond the box the density counts as zero, so every line closes, along the box where the region touches it.
std::vector<Loop> contour(const DensityGrid& grid, const PlotBox& box, double level);

}  // namespace uq
