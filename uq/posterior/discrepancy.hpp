#pragma once
// What the discrepancy process of a case (uq/posterior/measurement.hpp) makes of the data. Given the unknowns u, its
// values d* at settings x* have a normal law (kriging of what the model leaves):
//   E d* = K*' S^-1 (y - mean),  cov d* = K** - K*' S^-1 K*
// S the covariance of the data, K* of d* and the data. Bands are over draws of u. The share is how much of the spread
// of the data about the model is put down to it: the mean over draws of sum_i K_ii / sum_i S_ii.
#include <Eigen/Dense>
#include <vector>

#include "data/study.hpp"
#include "uq/findings/prediction_results.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

/// The bands along the first control of each own observation set that has a discrepancy; none where the case has none.
std::vector<DiscrepancyBand> discrepancy_bands(const data::Study& study, const CaseModel& model,
                                               const Eigen::MatrixXd& draws, std::uint64_t seed);

}  // namespace uq
