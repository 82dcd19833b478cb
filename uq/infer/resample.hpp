#pragma once
// Systematic resampling: `count` draws of weighted points with one random number, so that a point of share w is drawn
// w count times, rounded up or down (J. Carpenter, P. Clifford, P. Fearnhead, IEE Proc. Radar 146:2 (1999)).
#include <Eigen/Dense>
#include <vector>

namespace uq {

/// Indices in rising order. `weights`: none negative, not all 0. `offset`: uniform on [0, 1), or 0.5 for the draws in
/// the middle of their strata.
std::vector<Eigen::Index> resample(const Eigen::ArrayXd& weights, Eigen::Index count, double offset);

}  // namespace uq
