#pragma once
// The case extended by the planned readings: its model gets further rows beside those of its data.
#include <Eigen/Core>
#include <vector>

#include "data/study.hpp"
#include "uq/plan/candidates.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq::plan {

/// The case's model with one more row per point and output of the candidates.
struct ExtendedCase {
  CaseModel model;
  std::vector<Eigen::Index> measured;              ///< rows of the data, pooled and thinned where there are many
  std::vector<std::vector<Eigen::Index>> planned;  ///< rows of each candidate
  Eigen::VectorXd absolute, relative;              ///< errors of each row's reading; 0 for measured rows
  /// Readings of a planned row whose noise is an unknown sd, or whose stated error replaces the unknown sd; 0
  /// elsewhere.
  Eigen::VectorXd sd_unknown, sd_replaced;
  Eigen::VectorXd reference;  ///< SI, mean at which the model's variances of planned rows were taken

  /// The rows' noise variances where their means are `mean`: an error in per cent is a share of the reading itself.
  Eigen::VectorXd noise_at(const Eigen::VectorXd& mean, const Eigen::VectorXd& noise) const;
};

/// Extends a case. `sampled`: the case as it was sampled. The planned rows' variances are those of a reading at `u`.
ExtendedCase extend(const data::Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
                    const CaseModel& sampled, const std::vector<Candidate>& candidates, const Eigen::VectorXd& u);

}  // namespace uq::plan
