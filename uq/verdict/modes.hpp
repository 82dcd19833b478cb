#pragma once
// Separate regions of a posterior. A parameter whose profile interval has several parts cuts the unknowns' space into
// slabs; the cells that these make, where draws lie, are the modes. Each has its share of the draws as weight, and a
// representative: the most likely point of the profiles' paths inside it.
//
// The measurement that would part the modes is found so: at each observed output, one control after the other is moved
// through its range, the others as observed. The largest difference of the modes' predictions is taken, in the
// measurement's standard errors, beyond what the surrogate's own error may bring about.
#include <Eigen/Dense>
#include <string>
#include <vector>

#include "data/study.hpp"
#include "uq/findings/thresholds.hpp"
#include "uq/verdict/profile.hpp"

namespace uq {

struct Mode {
  double weight = 0.0;
  Eigen::VectorXd mean, sd;  ///< mean and sd of the unknowns, u
  Eigen::VectorXd point;     ///< representative, u
};

/// The modes by falling weight; one where the posterior is in one piece. `draws`: rows in u.
std::vector<Mode> find_modes(const Profiles& all, const Eigen::MatrixXd& draws, const VerdictThresholds& thresholds);

/// Index of the part of a profile that a value belongs to: the nearest.
std::size_t part_of(const Profile& profile, double u);

/// Parts of profiles whose share of the posterior should be noticed and where no draw lies (by Laplace's approximation
/// at their best points), as "friction near 0.3"; empty where the draws are everywhere that they should be.
std::vector<std::string> unvisited(const CaseModel& model, const Profiles& all, const Eigen::MatrixXd& draws);

/// One sentence without its full stop; empty with fewer than two modes.
std::string parted_by(const data::Study& study, const CaseModel& model, const std::vector<Mode>& modes);

}  // namespace uq
