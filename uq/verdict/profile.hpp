#pragma once
// Profile likelihood: for one unknown k held at u_k,
//   deviance(u_k) = 2 (max over all u of log L - max over the other unknowns of log L),
// log L that of the data and of what calibrated the nuisances, their priors (posterior.hpp, log_certificates),
// by constrained optimisation (Raue et al., Bioinformatics 25:1923 (2009)). The 95 % interval is where it stays
// below deviance_95 (thresholds.hpp), or below more where the size of the errors is unknown (interval_drop.hpp). It may
// have several parts.
//
// A side of the interval is closed where the deviance crosses that drop. It is open where
//   - the support ends first: a bound is not a finding;
//   - another unknown has come to the end of its range, so that the ridge cannot go on (pinned): with that unknown held
//     where the data would have it, the deviance at the end would be at least twice as large;
//   - the unknown would move there if another could go beyond the end of its range (range_end.hpp);
//   - no run was made (runs_reach): the deviance there is the surrogate's prior, which nothing has tested;
//   - only ignorance speaks: up to the end of the range values are unlikely only since the surrogate knows less of them
//     (a gap among the runs, a corner). With S(u) the data's covariance and N(u) the same without the surrogate's part,
//     the deviance less the growth of log |S| / |N| from the best fit on stays below the drop there.
// An unknown without influence (influence.hpp) pins nothing, and nor does a bound at 0 that nature sets.
//
// A hill of the likelihood beyond the drop that holds a share of the posterior (mode_weight) is a part, too, with ends
// where the deviance has risen by the drop from its own least (hills.hpp).
// Between two parts the deviance has a barrier. Where an error of two of the surrogate's sds would take the barrier
// away, the hole is in doubt, and the interval goes through it. The maximisers form a path along the ridge, if there is
// one.
#include <Eigen/Dense>
#include <optional>
#include <vector>

#include "uq/findings/thresholds.hpp"
#include "uq/infer/optimise.hpp"
#include "uq/posterior/case_model.hpp"
#include "uq/verdict/influence.hpp"
#include "uq/verdict/range_end.hpp"

namespace uq {

struct ProfileOptions {
  int even_points = 17;  ///< spread over the support
  int near_points = 16;  ///< spread over where the draws lie
  VerdictThresholds thresholds = {};
};

/// One connected part of the interval, in u.
struct ProfilePart {
  double low = 0.0, high = 0.0;
  Eigen::Index best = 0;  ///< its point of least deviance
};

/// The barrier between two parts of the interval.
struct ProfileBarrier {
  double low = 0.0, high = 0.0;  ///< u
  double deviance = 0.0;         ///< largest in between
  bool in_doubt = false;         ///< the surrogate's error could bring it about
};

struct Profile {
  int unknown = 0;
  double drop = deviance_95;                          ///< deviance at the interval's ends
  Eigen::VectorXd u;                                  ///< held values, rising
  Eigen::VectorXd log_likelihood;                     ///< largest log likelihood at each
  Eigen::VectorXd deviance;                           ///< deviance from it, once the largest of all profiles is known
  Eigen::MatrixXd path;                               ///< points x unknowns: the maximiser at each
  std::optional<double> low, high;                    ///< ends of the interval, in u; none: open
  std::optional<int> low_pinned, high_pinned;         ///< unknown at the end of whose range an open side ends
  std::optional<double> runs_end_low, runs_end_high;  ///< u: where the runs end on an open side, short of the support
  bool low_unknown = false, high_unknown = false;     ///< an open side beyond which the surrogate knows too little
  std::optional<int> conditional_on;                  ///< unknown whose range's end decides the value, if one does
  std::vector<ProfilePart> parts;                     ///< rising; holes in doubt are filled
  std::vector<ProfileBarrier> barriers;               ///< all, those in doubt too
  bool closed() const { return low && high; }
  bool flat() const { return !low && !high; }
};

/// Largest likelihood over the box; `starts` from draws.
Maximum maximum_likelihood(const CaseModel& model, const Eigen::MatrixXd& starts);

/// Profiles of the case's own parameters. `draws` (rows in u) with their log likelihoods guide the search.
struct Profiles {
  std::vector<Profile> profiles;
  Maximum best;                      ///< largest likelihood of all that was seen
  Eigen::VectorXd drops;             ///< per unknown: deviance at the ends of its interval
  std::vector<Maximum> maxima;       ///< other places where the likelihood is largest, nearly as good
  std::vector<Influence> influence;  ///< per unknown
  std::vector<RangeEnd> ends;        ///< of unknowns whose range ends where the likelihood still rises
};
struct Guides {
  Eigen::MatrixXd draws;
  Eigen::VectorXd log_likelihood;
};
Profiles profile_likelihood(const CaseModel& model, const Guides& guides, const ProfileOptions& options = {});

/// log likelihood of the data and of what calibrated the nuisances.
Differentiable profiled(const CaseModel& model);

/// The largest value of `profiled` from each start, with coordinates held. A quasi-Newton search stalls on a thin
/// ridge, where a nuisance undoes what a parameter does: Gauss-Newton steps, which see the ridge in the data's slopes,
/// go on from there until they promise less than a thousandth.
Maximum maximise_profiled(const CaseModel& model, const Box& box, const Eigen::MatrixXd& starts,
                          const std::vector<Held>& held = {});

/// Turns log likelihoods along a path into deviances and the interval's parts and ends. `draws`: draws of the
/// posterior, rows in u.
void finish_profile(const CaseModel& model, const Profiles& all, const Eigen::MatrixXd& draws, Profile& profile,
                    const VerdictThresholds& thresholds);

/// The low end of an unknown's support is a bound that nature sets, not the user: a linear range that begins at 0.
bool physical_low(const Unknown& unknown);

}  // namespace uq
