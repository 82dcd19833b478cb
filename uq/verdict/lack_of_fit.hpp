#pragma once
// Lack of fit: whether the settings' means lie farther from the model than their readings lie from them.
//
// Where the errors' size is unknown a case always fits: the noise grows until it does. Readings that were repeated at a
// setting tell the noise by themselves, and the means must then lie as near to the model as that noise lets them. They
// do not where the model is off, or where the readings of one setting share an error (a filling, a calibration), which
// repetition does not lessen; every reading is then taken for more than it says.
//
// With s^2 the scatter of repeats about their means on nu degrees of freedom, r the residuals of the m means at the
// best fit and C their covariance with the noise s, the surrogate's error, and what the p known directions of the
// parameters can move,
//   F = r' C^-1 r / (m - p)
// has Fisher's law with (m - p, nu) degrees of freedom where the surrogate is exact (N. R. Draper and H. Smith, Applied
// Regression Analysis (1998), 2.1); with a surrogate's error its tail is shorter.
#include <Eigen/Dense>
#include <optional>

#include "uq/posterior/case_model.hpp"

namespace uq {

struct LackOfFit {
  double f = 0.0, p = 1.0;         ///< ratio, and the chance of one as large
  int settings = 0, readings = 0;  ///< readings: of these settings, all of them
};

/// Nothing where the errors' size is known, or fewer than two degrees of freedom are left on either side. `best`: the
/// best fit.
std::optional<LackOfFit> lack_of_fit(const CaseModel& model, const Eigen::VectorXd& best);

}  // namespace uq
