#pragma once
// A case with more data than it was sampled with: rows that are planned, or that it has not used.
#include "data/study.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

/// Condenses a set: points measured again at the same controls become one, and of very many points some stand for all.
/// Where the case's readings have an unknown sd such points stay, as a mean would lose this sd.
void condense(data::ObservationSet& set, const data::CalibrationCase& wanted);

/// The case of a study that has more observations than the one it was sampled with. Its unknowns, with the laws of
/// those that were cut from another case, and the scale of its discrepancy are those of the sampled case.
CaseModel with_more_data(const data::Study& wider, const std::vector<Emulator>& emulators, std::size_t case_index,
                         const CaseModel& sampled);

/// A law of the rows `wanted` given the unknowns and the data in the rows `measured`, which share the surrogate's
/// error, the meter's common errors and the discrepancy with them. With S the covariance of all rows given u, noise
/// included,
///   wanted | u, y  ~  N( mean_w + S_wm S_mm^-1 (y - mean_m),  S_ww - S_wm S_mm^-1 S_mw ).
struct ReadingLaw {
  Eigen::VectorXd mean;                          ///< SI
  Eigen::MatrixXd shared;                        ///< SI^2, covariance that a reading made again shares
  Eigen::VectorXd noise;                         ///< SI^2, variance of each reading's own error
  std::vector<LinkedErrors> linked_errors = {};  ///< among the rows wanted

  /// The covariance of readings made once.
  Eigen::MatrixXd total() const {
    Eigen::MatrixXd sum = shared;
    add_own_errors(noise, linked_errors, sum);
    return sum;
  }
};

struct StackedPrediction;
/// The law of the rows `wanted`. `all`: the prediction at u. Without rows `measured`: the law without data.
ReadingLaw reading_law(const StackedPrediction& all, const Eigen::VectorXd& observed,
                       const std::vector<Eigen::Index>& wanted, const std::vector<Eigen::Index>& measured);

}  // namespace uq
