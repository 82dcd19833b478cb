#pragma once
// Profile likelihood: for one unknown k held at u_k,
//   deviance(u_k) = 2 (max over all u of log L - max over the other unknowns of log L),
// log L that of the data and of what calibrated the nuisances, their priors (posterior.hpp, log_certificates),
// by constrained optimisation (Raue et al., Bioinformatics 25:1923 (2009)). The 95 % interval is where it stays
// below 3.84 (chi squared, one degree of freedom). An end is closed when the deviance crosses before the support ends,
// open when the support's bound is met first: a bound is not a finding. Nor is an end that is there only because
// another unknown has come to the end of its range, so that the ridge cannot go on (pinned): that side is open, too,
// unless a wider range would hardly matter. A
// bound at 0 that nature sets does close. The maximisers form a path along the ridge, if there is one.
#include <Eigen/Dense>
#include <optional>

#include "uq/case_model.hpp"
#include "uq/optimise.hpp"

namespace uq {

struct ProfileOptions {
  int even_points = 17;    ///< spread over the support
  int near_points = 16;    ///< spread over where the draws lie
  double drop = 3.841459;  ///< deviance at the interval's ends
};

struct Profile {
  int unknown = 0;
  Eigen::VectorXd u;                                     ///< held values, rising
  Eigen::VectorXd deviance;                              ///< at each
  Eigen::MatrixXd path;                                  ///< points x unknowns: the maximiser at each
  std::optional<double> low, high;                       ///< ends of the interval, in u; none: open
  std::optional<int> low_pinned, high_pinned;            ///< unknown at the end of whose range an open side ends
  double deviance_at_low = 0.0, deviance_at_high = 0.0;  ///< at the support's bounds
  bool closed() const { return low && high; }
  bool flat() const { return !low && !high; }
};

/// Largest likelihood over the box; `starts` from draws.
Maximum maximum_likelihood(const CaseModel& model, const Eigen::MatrixXd& starts);

/// Profiles of the unknowns listed. `draws` (rows in u) with their log likelihoods guide the search; `best` is updated
/// when a profile finds a higher likelihood.
struct Profiles {
  std::vector<Profile> profiles;
  Maximum best;
};
struct Guides {
  Eigen::MatrixXd draws;
  Eigen::VectorXd log_likelihood;
};
Profiles profile_likelihood(const CaseModel& model, const Guides& guides, const ProfileOptions& options = {});

/// How far unknown k can go while the predicted means stay the same:
///   d(u) = (m(u) - m(u*))' (f D + C(u))^-1 (m(u) - m(u*)),   minimised over the other unknowns
/// stays below the drop, with the variance D of the noise cut by f (and the nuisances' priors counted in d). What still
/// spans most of the profile's interval cannot be closed by a better measurement of the same kind: the confounding is
/// structural, as far as the emulator's own error C lets one see.
struct NoiseFree {
  double low = 0.0, high = 0.0;  ///< u reached on each side
  double share = 0.0;            ///< of the profile's interval
};
NoiseFree noise_free_extent(const CaseModel& model, const Profile& profile, const Eigen::VectorXd& best,
                            double variance_factor, double drop);

/// The low end of an unknown's support is a bound that nature sets, not the user: a linear range that begins at 0.
bool physical_low(const Slot& slot);

}  // namespace uq
