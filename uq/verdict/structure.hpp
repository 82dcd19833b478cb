#pragma once
// The reason why an interval is as wide as it is, as far as the model's structure is that reason.
//
// Structure. Along the interval of unknown k the others are moved so that the predictions come as near as they can to
// those of the best fit u* (differences in data errors, influence.hpp):
//   kept(t) = min over the others of size(m(u_k = t, others) - m(u*)),    alone(t) = size(m(u* with u_k = t) - m(u*))
// The unknown is confounded by structure when, over most of its interval, what is kept cannot be told from nothing and,
// the surrogate's doubt counted in, is a small share of what it does alone. Then no better measurement of the same kind
// would close the interval, as far as the surrogate can see. Where the doubt is too large for that, it is undecided.
#include "uq/verdict/profile.hpp"

namespace uq {

struct Structure {
  double span = 0.0;  ///< share of the interval along which the predictions cannot be told apart
  bool structural = false;
  bool undecided = false;  ///< the surrogate is not sharp enough to tell
};
Structure find_structure(const CaseModel& model, const Profiles& all, const Profile& profile,
                         const VerdictThresholds& thresholds);

/// Sd of the emulators over that of all else that is uncertain of the data: median over rows.
double surrogate_to_measurement(const CaseModel& model, const Eigen::VectorXd& u);

}  // namespace uq
