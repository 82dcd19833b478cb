#pragma once
// The model of a calibration case: its unknowns, and the rows of measurement that each emulator must explain.
//
// Linked cases. Where a case takes another's posterior as a parameter's prior, both share the parameter, and both sets
// of data are used: sampled jointly, the likelihood is the product over all linked cases and the unknowns are the union
// of theirs. It is Bayes' rule without approximation; the posterior of one case passed on as a density would forget
// what the cases' surrogates have in common. Rows of all linked cases that the same emulator predicts are stacked, so
// its errors, correlated between them, are counted once.
//
// Cut. A posterior taken with `cut` comes without its data: the unknown keeps the law that the other case gave it
// (uq/infer/cut.hpp).
//
// Nuisances of the measurement (uq/posterior/measurement.hpp) are unknowns like the parameters, with priors; the rig's
// scale is one unknown of all cases that need it.
#include <Eigen/Dense>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data/study.hpp"
#include "uq/emulate/emulator.hpp"
#include "uq/posterior/measurement.hpp"
#include "uq/posterior/unknown.hpp"

namespace uq {

/// The origin of one measured number.
struct RowOrigin {
  std::size_t set = 0, point = 0;  ///< indices into Study::observations and its points
  std::size_t output = 0;          ///< index into Study::outputs
};

/// The scatter of rows measured again at the same settings, which tells of their own errors
/// (uq/posterior/distinct.hpp).
struct Repeats {
  int noise = -1;             ///< unknown that their standard errors are multiplied by, -1: none
  int extra = 0;              ///< rows beyond one per setting
  double scatter = 0.0;       ///< chi squared about the settings' means, at a factor of one
  double log_constant = 0.0;  ///< constant of their log likelihood
};

/// The rows that one emulator predicts.
struct RowGroup {
  Emulator emulator;
  Eigen::MatrixXd base;      ///< rows x inputs, unit cube; entries of unknowns are overwritten
  Eigen::MatrixXi unknown;   ///< rows x inputs, index of the unknown or -1
  Eigen::VectorXd observed;  ///< SI
  Eigen::VectorXd variance;  ///< SI^2, variances of the stated standard errors
  std::vector<RowOrigin> origin;
  /// Per unknown, the input it sets in every row; nothing where it sets none. Meaningful when `uniform`.
  std::vector<std::optional<int>> coordinate;
  bool uniform = true;  ///< each unknown sets the same input in all rows, or none
  Measurement measurement = {};
  std::vector<Eigen::Index> distinct_row = {};  ///< of each row, place in the model of distinct rows; empty: itself
  std::vector<Repeats> repeats = {};            ///< in the model of distinct rows: the readings that were averaged

  /// Input k of the emulator in a row, unit cube: the unknown's value in u where one sets it.
  double input(Eigen::Index row, Eigen::Index k, const Eigen::VectorXd& u) const {
    const int s = unknown(row, k);
    return s < 0 ? base(row, k) : u[s];
  }
};

/// Two measured numbers whose own errors are correlated (observe.correlation).
struct LinkedErrors {
  Eigen::Index first = 0, second = 0;  ///< rows of all groups, stacked
  double correlation = 0.0;
};

/// A control's error that rows of two emulators share, since both were read at the same settings.
struct LinkedSettings {
  std::size_t first_group = 0, second_group = 0;
  std::size_t first_setting = 0, second_setting = 0;  ///< indices into GroupLaw::settings
  Eigen::Index first_row = 0, second_row = 0;         ///< first row of either set in its group
  Eigen::MatrixXd same;  ///< 1 where a row of the first shares the error with one of the second, else 0
};

/// Adds the covariance of the numbers' own errors, which have these variances and links.
void add_own_errors(const Eigen::VectorXd& variance, const std::vector<LinkedErrors>& linked,
                    Eigen::MatrixXd& covariance);

/// The linked pairs of which both rows are among `rows`, as places in `rows`.
std::vector<LinkedErrors> linked_among(const std::vector<LinkedErrors>& linked, const std::vector<Eigen::Index>& rows);

struct CaseModel {
  std::string name;
  std::vector<Unknown> unknowns;  ///< the case's own parameters first, in its order, then its nuisances
  std::vector<RowGroup> groups;
  std::vector<LinkedErrors> linked_errors = {};
  std::vector<LinkedSettings> linked_settings = {};
  std::vector<std::string> linked;                 ///< names of the other cases that are sampled with it
  std::vector<std::string> observed_sets;          ///< sets that the case itself observes
  std::shared_ptr<const CaseModel> distinct = {};  ///< with rows of equal settings as one; none where all differ

  /// Whether the emulators' numbers depend on each other, given the unknowns.
  bool joint() const { return !linked_errors.empty() || !linked_settings.empty(); }
  int dimension() const { return static_cast<int>(unknowns.size()); }
  int own_count() const;  ///< number of parameters free in the case itself
  int row_count() const;
  Eigen::VectorXd lower() const;
  Eigen::VectorXd upper() const;
};

/// Builds the model. Throws data::InputError (78 or 65) naming every contradiction: a cycle of posteriors, data that
/// would count twice, a free parameter that no run varies, a parameter neither free nor fixed, one fixed where no run
/// is, observations outside the runs.
CaseModel build_case(const data::Study& study, const std::vector<Emulator>& emulators, std::size_t case_index);

/// Fills `coordinate` and `uniform`; called by build_case, needed for groups made by hand.
void find_coordinates(RowGroup& group, int unknowns);

/// The model with other data: stacked values and variances in the order of the groups' rows.
CaseModel with_data(const CaseModel& model, const Eigen::VectorXd& observed, const Eigen::VectorXd& variance);

/// The model with its surrogates taken as exact at their means.
CaseModel without_surrogate_error(const CaseModel& model);

Eigen::VectorXd observed(const CaseModel& model);
Eigen::VectorXd observed_variance(const CaseModel& model);
std::vector<RowOrigin> origins(const CaseModel& model);

}  // namespace uq
