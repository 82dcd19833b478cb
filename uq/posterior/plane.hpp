#pragma once
// Convex hulls in the plane. Andrew's monotone chain: A. M. Andrew, Inf. Process. Lett. 9:216 (1979).
#include <Eigen/Dense>
#include <vector>

namespace uq {

/// The hull's corners, counter-clockwise; one or two where all points coincide or lie on a line. `points`: one per row.
std::vector<Eigen::Vector2d> convex_hull(const Eigen::MatrixXd& points);

/// The distance of a point to the hull; 0 inside.
double distance_to_hull(const std::vector<Eigen::Vector2d>& hull, const Eigen::Vector2d& point);

}  // namespace uq
