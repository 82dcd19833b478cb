#pragma once
// What stands between an emulator's prediction and the numbers that a meter shows. With m, C the emulator's mean and
// covariance at the rows of a group, and f_i the product of the rig's scale and the meter's gain at row i:
//   mean_i  = f_i m_i + o_i                                                o_i the sum of its offsets
//   cov_ij  = f_i f_j C_ij + common_ij + setting_ij + discrepancy_ij       a repeated measurement shares it
//   noise_i = k^2 s_i^2, or s^2                                            each number's own
//   common       c^2 + r^2 f_i m_i f_j m_j within an observation set: an error of its meter, absolute c, relative r;
//                that of a meter which several sets name is an unknown gain and offset (uq/posterior/set_unknowns.hpp)
//   setting      t_i t_j, t_i = f_i (m(x_i + e_i) - m(x_i - e_i)) / 2: a control known to a standard error e enters
//                to first order, by the slope over +- one e. It is common to the rows of a set at one value of the
//                control (a fill, repeats at a speed), or to all rows of the set; elsewhere it is zero. Outputs
//                read at one setting share its error: t_i t_j between their groups, too (CaseModel::linked_settings)
//   discrepancy  a^2 q^2 M(d_ij / L) within a case: M. C. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63:425 (2001); Matern
//                5/2, d the distance of the controls in their ranges, q the root mean square of the measured values
// o, k, s, a, L and the factors of f may be unknowns with priors. The discrepancy itself is integrated out; it is
// independent between outputs and materials.
#include <Eigen/Dense>
#include <vector>

#include "surrogate/gaussian_process.hpp"
#include "uq/posterior/unknown.hpp"

namespace uq {

/// A control's error in one observation set.
struct SettingShift {
  std::size_t control = 0;  ///< index into Study::controls
  int column = 0;           ///< column of the emulator's inputs
  Eigen::VectorXd error;    ///< per row of the set, in unit-cube lengths
  Eigen::VectorXd level;    ///< level of each row; rows of one level share the error
};

/// A matrix that is 1 where a row's level equals a column's level, 0 elsewhere.
Eigen::MatrixXd same_level(const Eigen::VectorXd& rows, const Eigen::VectorXd& columns);

/// Rows of one observation set in a group.
struct ReadSet {
  Eigen::Index first = 0, count = 0;
  double factor = 1.0;           ///< fixed part of the scale
  std::vector<int> factors;      ///< unknowns that multiply: scale, gains
  std::vector<int> offsets;      ///< unknowns that add
  int noise = -1;                ///< unknown of the noise; -1: the stated standard errors hold
  bool noise_is_sd = false;      ///< the unknown replaces the standard errors, else multiplies them
  double common_absolute = 0.0;  ///< SI
  double common_relative = 0.0;
  std::vector<SettingShift> settings;
};

/// The discrepancy process of one case in a group.
struct DiscrepancyRows {
  Eigen::Index first = 0, count = 0;
  int sd = -1, length = -1;  ///< unknowns
  double magnitude = 1.0;    ///< q, SI
  Eigen::MatrixXd controls;  ///< rows x controls, in their ranges
};

/// The measurement of a group. It is empty where the numbers are the emulator's output with independent errors.
struct Measurement {
  std::vector<ReadSet> sets;
  std::vector<DiscrepancyRows> discrepancies;
  bool plain() const { return sets.empty() && discrepancies.empty(); }
  /// How many copies of the rows, beside the rows themselves, the emulator is asked at: two per uncertain control.
  int shifts() const;
};

/// Writes the shifted copies below the `rows` rows that stand at `first` in `points`.
void place_shifts(const Measurement& measurement, Eigen::MatrixXd& points, Eigen::Index first, Eigen::Index rows);

struct GroupLaw {
  Eigen::VectorXd mean;        ///< SI
  Eigen::MatrixXd covariance;  ///< SI^2, without the noise
  Eigen::VectorXd noise;       ///< SI^2, variances
  /// SI, effect of one standard error of a control on the rows of a set: for each set and each of its uncertain
  /// controls, in this order.
  std::vector<Eigen::VectorXd> settings = {};
};

/// What the meter makes of the prediction at one row: reading = factor * m + offset.
struct Meter {
  double factor = 1.0;
  double offset = 0.0;  ///< SI
};
Meter meter_at(const Measurement& measurement, const std::vector<Unknown>& unknowns, const Eigen::VectorXd& u,
               Eigen::Index row);

/// Variance of each number's own error.
Eigen::VectorXd noise_of(const Measurement& measurement, const std::vector<Unknown>& unknowns,
                         const Eigen::VectorXd& variance, const Eigen::VectorXd& u);

/// The law of a group's numbers. `variance`: of the stated standard errors, one per row; `prediction`: at the rows and
/// their shifted copies.
GroupLaw law_of(const Measurement& measurement, const std::vector<Unknown>& unknowns, const Eigen::VectorXd& variance,
                const surrogate::Prediction& prediction, const Eigen::VectorXd& u);

/// Derivatives with respect to u of mean and of covariance, noise included.
struct LawGradient {
  std::vector<int> along;  ///< indices of the unknowns
  std::vector<Eigen::VectorXd> mean;
  std::vector<Eigen::MatrixXd> covariance;
};

/// The law's derivatives. `along_and_u`: indices of the unknowns along which `prediction` has derivatives, in its
/// order, and their values; the nuisances are added.
LawGradient law_gradient(const Measurement& measurement, const std::vector<Unknown>& unknowns,
                         const Eigen::VectorXd& variance, const surrogate::PredictionGradient& prediction,
                         const std::pair<std::vector<int>, Eigen::VectorXd>& along_and_u);

/// Matern 5/2 correlation at distances over lengths.
Eigen::MatrixXd discrepancy_correlation(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double length);

}  // namespace uq
