#pragma once
// A case with more data than it was sampled with: rows that are planned, or that it has not used.
#include "data/study.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

/// Points measured again at the same controls become one, and of very many some stand for all. Where the case's readings
/// have an unknown sd, a mean would not keep it: such points stay.
void condense(data::ObservationSet& set, const data::CalibrationCase& wanted);

/// The case of a study that has more observations than the one it was sampled with. Its unknowns, with the laws of those
/// that were cut from another case, and the scale of its discrepancy are those of the sampled case.
CaseModel with_more_data(const data::Study& wider, const std::vector<Emulator>& emulators, std::size_t case_index,
                         const CaseModel& sampled);

/// A law of the rows `wanted` given the unknowns and the data in the rows `measured`, which share the surrogate's error,
/// the meter's common errors and the discrepancy with them. With S the covariance of all rows given u, noise included,
///   wanted | u, y  ~  N( mean_w + S_wm S_mm^-1 (y - mean_m),  S_ww - S_wm S_mm^-1 S_mw ).
struct ReadingLaw {
  Eigen::VectorXd mean;                          ///< SI
  Eigen::MatrixXd shared;                        ///< SI^2, what a reading made again shares
  Eigen::VectorXd noise;                         ///< SI^2, variances of each reading's own
  std::vector<LinkedErrors> linked_errors = {};  ///< among the rows wanted

  /// Of readings made once.
  Eigen::MatrixXd total() const {
    Eigen::MatrixXd sum = shared;
    add_own_errors(noise, linked_errors, sum);
    return sum;
  }
};

struct StackedPrediction;
/// `all`: the prediction at u. None of `measured`: the law without data.
ReadingLaw reading_law(const StackedPrediction& all, const Eigen::VectorXd& observed,
                       const std::vector<Eigen::Index>& wanted, const std::vector<Eigen::Index>& measured);

}  // namespace uq
