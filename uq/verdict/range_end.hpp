#pragma once
// What an unknown's value owes to the end of another unknown's range.
//
// At the most likely point an unknown may sit at the end of its range while the likelihood still rises outwards. The
// others are then estimated with it held there. Where the range was chosen by the user, and is no bound of nature,
// their values and errors hold for that choice only.
// To second order the most likely point beyond the end is u* + F^-1 g. g is the gradient at u*, of that unknown alone.
// F = J' S^-1 J is the information in the data, with 1/sd^2 of each prior. Unknowns that sit at other ends stay there.
// Where the prior of the unknown at the end is no more than its range, that range is what is in question: its own width
// says nothing of what lies beyond. 1/sd^2 is then that of two widths, which keeps an unknown that the data hardly feel
// from being moved by hundreds of them.
#include <Eigen/Dense>
#include <vector>

#include "uq/posterior/case_model.hpp"

namespace uq {

enum class End { inside, low, high };
/// The end of the range at which a value sits, to 1e-4 of the range: optimisers come no closer.
End end_of(double value, double low, double high);

/// An unknown at the end of its range, and what a longer range would change.
struct RangeEnd {
  int unknown = 0;
  Eigen::VectorXd shift;  ///< of every unknown, in units of its own error while this one is held; 0 of those held
};

/// `best`: the most likely point, u. Ends at which nature stops a parameter (physical_low) are not among them.
std::vector<RangeEnd> range_ends(const CaseModel& model, const Eigen::VectorXd& best);

}  // namespace uq
