#pragma once
// Points of a posterior that lie far from all runs, as runs to make next. They are chosen one after the other, each the
// farthest from the runs and from those chosen before (maximin, in the unit cube), so that a few of them cover the
// posterior.
#include <Eigen/Dense>
#include <vector>

#include "uq/posterior/runs_around.hpp"

namespace uq {

/// A run proposed, which gives all outputs of its material.
struct ProposedRun {
  NextRun run;
  Eigen::VectorXd point;  ///< point in the emulator's inputs
};

/// Up to `count` runs among the draws at the observed settings of one emulator. They keep away from its runs and from
/// those of its material that are `proposed` already.
std::vector<ProposedRun> farthest_runs(const data::Study& study, const Ground& ground, const Eigen::MatrixXd& draws,
                                       int count, const std::vector<ProposedRun>& proposed);

}  // namespace uq
