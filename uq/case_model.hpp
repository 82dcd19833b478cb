#pragma once
// What a calibration case says, resolved: which unknowns there are, and which rows of measurement each emulator must
// explain.
//
// Linked cases. Where a case takes another's posterior as a parameter's prior, both share the parameter, and both sets
// of data are used: sampled jointly, the likelihood is the product over all linked cases and the unknowns are the union
// of theirs. It is Bayes' rule without approximation; the posterior of one case passed on as a density would forget
// what the cases' surrogates have in common. Rows of all linked cases that the same emulator predicts are stacked, so
// its errors, correlated between them, are counted once.
#include <Eigen/Dense>
#include <optional>
#include <string>
#include <vector>

#include "data/study.hpp"
#include "uq/emulator.hpp"
#include "uq/prior.hpp"

namespace uq {

/// One unknown of the joint posterior.
struct Slot {
  std::string label;  ///< the parameter's name, with the case's in front for another case's own parameter
  ScaledPrior prior;
  bool own = true;  ///< free in the case itself; else only in a linked one
};

/// Where one measured number comes from.
struct RowOrigin {
  std::size_t set = 0, point = 0;  ///< in Study::observations and its points
  std::size_t output = 0;          ///< in Study::outputs
};

/// The rows that one emulator predicts.
struct RowGroup {
  Emulator emulator;
  Eigen::MatrixXd base;      ///< rows x inputs, unit cube; entries of unknowns are overwritten
  Eigen::MatrixXi slot;      ///< rows x inputs, index of the unknown or -1
  Eigen::VectorXd observed;  ///< SI
  Eigen::VectorXd variance;  ///< SI^2, of the measurement
  std::vector<RowOrigin> origin;
  /// Per slot, the input it sets in every row; nothing where it sets none. Meaningful when `uniform`.
  std::vector<std::optional<int>> coordinate;
  bool uniform = true;  ///< each unknown sets the same input in all rows, or none
};

struct CaseModel {
  std::string name;
  std::vector<Slot> slots;  ///< the case's own first, in its order
  std::vector<RowGroup> groups;
  std::vector<std::string> linked;         ///< names of the other cases that are sampled with it
  std::vector<std::string> observed_sets;  ///< of the case itself

  int dimension() const { return static_cast<int>(slots.size()); }
  int own_count() const;
  int row_count() const;
  Eigen::VectorXd lower() const;
  Eigen::VectorXd upper() const;
};

/// Throws data::InputError (78 or 65) naming every contradiction: a cycle of posteriors, data that would count twice, a
/// free parameter that no run varies, a parameter neither free nor fixed, one fixed where no run is, observations
/// outside the runs.
CaseModel build_case(const data::Study& study, const std::vector<Emulator>& emulators, std::size_t case_index);

/// Fills `coordinate` and `uniform`; called by build_case, needed for groups made by hand.
void find_coordinates(RowGroup& group, int slots);

/// The same model for other data: stacked values and variances in the order of the groups' rows.
CaseModel with_data(const CaseModel& model, const Eigen::VectorXd& observed, const Eigen::VectorXd& variance);

Eigen::VectorXd observed(const CaseModel& model);
Eigen::VectorXd observed_variance(const CaseModel& model);
std::vector<RowOrigin> origins(const CaseModel& model);

}  // namespace uq
