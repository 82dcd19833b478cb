#include "uq/verdict/structure.hpp"

#include <algorithm>
#include <cmath>

#include "uq/infer/diagnostics.hpp"
#include "uq/posterior/posterior.hpp"

namespace uq {
namespace {

constexpr int steps_a_side = 3;
constexpr Eigen::Index many_rows = 300;  // beyond, the typical row stands for the comparison

/// The case without all that is uncertain of the data but the emulators and the noise.
CaseModel emulators_alone(const CaseModel& model) {
  CaseModel alone = distinct_rows(model);
  alone.linked_settings.clear();
  for (auto& group : alone.groups) {
    group.measurement.discrepancies.clear();
    for (auto& set : group.measurement.sets) {
      set.common_absolute = set.common_relative = 0.0;
      set.settings.clear();
    }
  }
  return alone;
}

/// The hull of the interval, u.
std::pair<double, double> hull(const Profile& profile) {
  return {profile.parts.front().low, profile.parts.back().high};
}

/// The point nearest to `best` in what is predicted, with unknown k held.
Eigen::VectorXd nearest_prediction(const CaseModel& model, const Yardstick& yardstick, const Eigen::VectorXd& best,
                                   Held held, const Eigen::MatrixXd& starts) {
  const Box box{model.lower(), model.upper()};
  const DistanceFrom distance(model, yardstick, best);
  const auto match = [&](const Eigen::VectorXd& u) {
    // Unknowns that only widen the spread explain nothing, and stay; what a certificate says of a nuisance counts.
    Eigen::VectorXd at = u;
    for (int s = 0; s < model.dimension(); ++s)
      if (model.unknowns[s].only_widens()) at[s] = best[s];
    const double size = distance(at);
    return -size * size + 2.0 * log_certificates(model, at).value;
  };
  return maximise(with_differences(match, box), box, starts, {held}).x;
}

}  // namespace

Structure find_structure(const CaseModel& model, const Profiles& all, const Profile& profile,
                         const VerdictThresholds& thresholds) {
  Structure found;
  if (profile.parts.empty()) return found;
  const int k = profile.unknown;
  const Eigen::VectorXd& best = all.best.x;
  const Yardstick yardstick = make_yardstick(model, best);
  const auto [low, high] = hull(profile);
  if (!(high > low)) return found;
  double reached_low = best[k], reached_high = best[k];
  Difference alone;  // where the parameter alone does most
  double kept = 0.0;
  for (const double end : {low, high}) {
    Eigen::VectorXd at = best;
    for (int step = 1; step <= steps_a_side; ++step) {
      const double t = best[k] + (end - best[k]) * step / steps_a_side;
      if (std::abs(t - best[k]) < 1e-6 * (high - low)) continue;
      Eigen::Index near = 0;
      (profile.u.array() - t).abs().minCoeff(&near);
      Eigen::MatrixXd starts(2, best.size());
      starts << at.transpose(), profile.path.row(near);
      at = nearest_prediction(model, yardstick, best, {k, t}, starts);
      Eigen::VectorXd moved = best;
      moved[k] = t;
      const Difference does = difference(model, yardstick, moved, best);
      const Difference left = difference(model, yardstick, at, best);
      if (left.told_apart(thresholds) && left.size > 1e-3 * does.size) break;
      if (does.size > alone.size) {
        alone = does;
        kept = left.size + 2.0 * left.doubt;
      }
      (end == low ? reached_low : reached_high) = t;
    }
  }
  found.span = (reached_high - reached_low) / (high - low);
  if (found.span < thresholds.structural_span) return found;
  // Where the parameter does nothing by itself (a response that has saturated) there is nothing to be confounded.
  if (!alone.told_apart(thresholds)) return found;
  found.structural = kept <= thresholds.same_share * alone.size;
  found.undecided = !found.structural;
  return found;
}

double surrogate_to_measurement(const CaseModel& full, const Eigen::VectorXd& u) {
  const CaseModel& model = distinct_rows(full);
  const Eigen::ArrayXd own = predict(emulators_alone(model), u).covariance.diagonal().array().max(0.0);
  const Eigen::ArrayXd other = predict(model, u).total().diagonal().array() - own;
  return quantile((own / other).sqrt(), 0.5);
}

}  // namespace uq
