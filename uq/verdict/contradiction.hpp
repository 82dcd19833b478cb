#pragma once
// A check of the observation sets of a case that together fit nowhere: does each fit on its own? If each does, they
// contradict each other, and no better model of one of them would help. A set on its own is the case with the other
// sets' standard errors 10^4 times larger, at its largest likelihood, with the chi-squared tail of
// uq/posterior/predictive.hpp's best fit.
#include <Eigen/Dense>
#include <optional>
#include <string>
#include <vector>

#include "uq/findings/thresholds.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

struct SetFit {
  std::string name;         ///< of the observation set
  double best_fit_p = 1.0;  ///< p of the best fit to its rows alone
};

/// The fits, one per observation set, linked cases' sets too. None where there is only one set, or where an unknown
/// noise stands in place of the standard errors. `start`: the best fit to all.
std::vector<SetFit> fits_alone(const data::Study& study, const CaseModel& model, const Eigen::VectorXd& start);

/// The consequence for a case that does not fit: which sets fit on their own, and what to do. Empty without sets.
struct Contradiction {
  std::string finding, remedy;
};
Contradiction describe_contradiction(const std::vector<SetFit>& sets, double least_p);

/// A reading without which all others fit.
struct LoneReading {
  RowOrigin origin;
  double p_without = 0.0;  ///< chi-squared tail of the best fit to the others
};

/// The one reading that contradicts all others: without it they fit (thresholds.poor_fit_p), without any other the case
/// still does not (thresholds.best_fit_p). None where several would do, or where fewer than two degrees of freedom are
/// left. `start`: the best fit to all.
std::optional<LoneReading> lone_reading(const data::Study& study, const CaseModel& model, const Eigen::VectorXd& start,
                                        const VerdictThresholds& thresholds);

}  // namespace uq
