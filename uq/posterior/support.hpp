#pragma once
// Whether runs speak where the posterior lies. A surrogate always answers; beyond its runs the answer is its prior's.
//
// Asked at every draw u of the posterior and every observed setting of the controls: the points p at which the
// likelihood was computed. A point is not supported if
//   outside    an input lies beyond what the runs cover by more than a slack: `slack_gaps` mean spacings of the runs'
//              distinct values of that input, between `slack_least` and `slack_most` of its range
//   gap        an input lies in a gap between runs that is `gap_factor` times the mean of the other spacings, and at
//              least `gap_least` of its range; regular levels have no such gap
//   empty      in the plane of two inputs no run is nearer than `empty_factor` r,  r^2 = ln n / (pi n), beside half of
//              each input's mean spacing (between three regular levels and more there is no hole), and the point
//              lies outside of their convex hull or r-circles are empty about it; n distinct runs in the plane fill it
//              with holes of that size at most (the coupon collector's bound for n uniform points)
//   uncertain  the surrogate's variance is at least `uncertain` of what it would be without any runs
// A draw is not supported if that holds at half of the observed settings or more. The case is not supported if more
// than `share` of its draws are not.
//
// Runs to make next are chosen by farthest_runs.hpp; runs_around.hpp has the tests, support_words.hpp the sentence.
#include <Eigen/Dense>
#include <string>
#include <utility>
#include <vector>

#include "uq/findings/support_results.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

struct SupportThresholds {
  double share = 0.1;
  double slack_gaps = 3.0, slack_least = 0.03, slack_most = 0.1;
  double gap_factor = 5.0, gap_least = 0.15;
  double empty_factor = 1.5;
  double uncertain = 1.0 / 3.0;
  int draws = 300;     ///< draws that are looked at
  int next_runs = 12;  ///< runs that are proposed
};

/// `draws`: rows in u, of all unknowns.
SupportReport find_support(const data::Study& study, const CaseModel& model, const Eigen::MatrixXd& draws,
                           const SupportThresholds& thresholds = {});

/// Share of the draws, for each of these rows of the stacked model, at which the runs of its emulator do not support it;
/// 0 where an emulator is learnt from no runs. For readings beside those that a case was sampled with.
Eigen::VectorXd unsupported_at(const CaseModel& model, const std::vector<Eigen::Index>& rows,
                               const Eigen::MatrixXd& draws, const SupportThresholds& thresholds = {});

/// The part of an unknown's support that runs cover, in u. Within a slack of an end of the support they reach it.
struct RunsReach {
  double low = 0.0, high = 1.0;
};
/// The part that the runs of every emulator cover which depends on the unknown; the whole support where no emulator is
/// learnt from runs.
RunsReach runs_reach(const CaseModel& model, int unknown, const SupportThresholds& thresholds = {});

/// For each own parameter, why no verdict can rest on the surrogates there; empty text where one can.
std::vector<std::string> unsupported_parameters(const CaseModel& model, const SupportReport& support);

/// Why the surrogates that a case rests on carry no verdict; empty where they do.
std::string doubt_of(const CaseModel& model);

/// Name and value of each threshold, for the report.
std::vector<std::pair<std::string, std::string>> describe(const SupportThresholds& thresholds);

}  // namespace uq
