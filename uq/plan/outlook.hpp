#pragma once
// The law of planned readings. For draws of a posterior it is the law given the draw *and* the data. The surrogate's
// error, the meter's common errors and the discrepancy are the same in a reading to come as in the existing ones
// (uq/posterior/more_data.hpp), so that a setting read again teaches less than one read for the first time.
#include <Eigen/Dense>
#include <vector>

#include "uq/plan/extended_case.hpp"
#include "uq/plan/information.hpp"
#include "uq/posterior/more_data.hpp"

namespace uq::plan {

class Outlook {
 public:
  enum class Given { data, nothing };
  /// `draws`: rows in u.
  Outlook(const ExtendedCase& extended, const Eigen::MatrixXd& draws, Given given, int threads);

  /// The ensemble of readings of these rows (of the extended model), each read `readings` times and averaged. Values of
  /// the case's own parameters are in the study's units.
  Ensemble ensemble(const std::vector<Eigen::Index>& rows, double readings = 1.0) const;
  Eigen::Index draws() const { return values_.rows(); }
  const Eigen::MatrixXd& values() const { return values_; }
  /// The law of these rows' readings given one draw.
  ReadingLaw law(Eigen::Index draw, const std::vector<Eigen::Index>& rows) const;

 private:
  Eigen::MatrixXd values_;
  std::vector<ReadingLaw> laws_;
  std::vector<Eigen::Index> place_;  ///< place of a model's row among the planned ones; -1: measured
};

/// Draws from the priors: scrambled Sobol points; rows in u, and standard normal numbers of
/// `readings` readings (none where the sequence has too few dimensions).
struct PriorDraws {
  Eigen::MatrixXd u, noise;
};
PriorDraws prior_draws(const CaseModel& model, int count, int readings, std::uint64_t seed);

}  // namespace uq::plan
