// The ends and parts of a profile interval (profile.hpp).
#include <algorithm>
#include <cmath>

#include "uq/posterior/posterior.hpp"
#include "uq/posterior/support.hpp"
#include "uq/verdict/hills.hpp"
#include "uq/verdict/profile.hpp"
#include "uq/verdict/range_end.hpp"

namespace uq {
namespace {

/// Where the deviance crosses the drop, and the maximiser there.
struct Crossing {
  double at = 0.0;
  Eigen::VectorXd maximiser;
};

/// A value of the unknown and the root of the deviance less that of the drop.
struct Side {
  double at = 0.0, excess = 0.0;
};

/// Between an inside and an outside value by false position on the root of the deviance, which is straight for a
/// parabola (Dowell & Jarratt 1971, the Illinois rule).
Crossing find_crossing(const CaseModel& model, const Box& box, const Profile& profile, Eigen::Index from,
                       Eigen::Index to, double best, double drop) {
  constexpr double close_enough = 1e-4;
  const int k = profile.unknown;
  const double root = std::sqrt(drop);
  Eigen::VectorXd warm = profile.path.row(from).transpose();
  Side inside{profile.u[from], std::sqrt(profile.deviance[from]) - root};
  Side outside{profile.u[to], std::sqrt(profile.deviance[to]) - root};
  if (outside.excess <= 0.0) return {.at = outside.at, .maximiser = profile.path.row(to).transpose()};
  int last = 0;
  for (int i = 0; i < 14; ++i) {
    const double share = std::clamp(inside.excess / (inside.excess - outside.excess), 0.02, 0.98);
    const double middle = inside.at + share * (outside.at - inside.at);
    const Maximum found = maximise_profiled(model, box, warm.transpose(), {Held{k, middle}});
    const double excess = std::sqrt(std::max(2.0 * (best - found.value), 0.0)) - root;
    if (excess <= 0.0) {
      inside = {middle, excess};
      warm = found.x;
      if (last < 0) outside.excess *= 0.5;
      last = -1;
    } else {
      outside = {middle, excess};
      if (last > 0) inside.excess *= 0.5;
      last = 1;
    }
    if (std::abs(excess) < close_enough || std::abs(outside.at - inside.at) < 1e-7 * (box.upper[k] - box.lower[k]))
      return {.at = middle, .maximiser = found.x};
  }
  return {.at = 0.5 * (inside.at + outside.at), .maximiser = warm};
}

/// Least deviance at u_k with `other` held, too.
double deviance_with_held(const CaseModel& model, const Box& box, Held held, Held other, const Eigen::VectorXd& start,
                          double best) {
  return 2.0 * (best - maximise_profiled(model, box, start.transpose(), {held, other}).value);
}

/// Another unknown that sits at the end of its range, if one does and the interval ends for that.
std::optional<int> pinned(const CaseModel& model, const Box& box, const Profiles& all, const Profile& profile,
                          const Crossing& end, const VerdictThresholds& thresholds) {
  for (int other = 0; other < model.dimension(); ++other) {
    if (other == profile.unknown || !all.influence[other].some) continue;
    const End at = end_of(end.maximiser[other], box.lower[other], box.upper[other]);
    if (at == End::inside || (at == End::low && physical_low(model.unknowns[other]))) continue;
    // The middle of where the path has it inside the interval.
    double least = box.upper[other], most = box.lower[other];
    for (Eigen::Index i = 0; i < profile.u.size(); ++i)
      if (profile.deviance[i] <= profile.drop) {
        least = std::min(least, profile.path(i, other));
        most = std::max(most, profile.path(i, other));
      }
    const Held k{profile.unknown, end.at};
    const double held = deviance_with_held(model, box, k, {other, 0.5 * (least + most)}, end.maximiser, all.best.value);
    if (held >= thresholds.pinned_drops * profile.drop) return other;
  }
  return {};
}

/// Opens the side to which the unknown would move if another could go beyond the end of its range.
void open_beyond(const Profiles& all, Profile& profile, const VerdictThresholds& thresholds) {
  const auto k = static_cast<Eigen::Index>(profile.unknown);
  for (const RangeEnd& end : all.ends) {
    if (end.unknown == profile.unknown || std::abs(end.shift[k]) < thresholds.range_shift) continue;
    const bool upwards = end.shift[k] > 0.0;
    (upwards ? profile.high : profile.low).reset();
    (upwards ? profile.high_pinned : profile.low_pinned) = end.unknown;
    profile.conditional_on = end.unknown;
  }
}

/// Opens the sides that end where no run was made.
void open_beyond_runs(const CaseModel& model, const std::vector<ProfilePart>& parts, Profile& profile) {
  const RunsReach reach = runs_reach(model, profile.unknown);
  const ScaledPrior& prior = model.unknowns[profile.unknown].prior;
  if (reach.low > prior.low() && parts.front().low < reach.low) {
    profile.low.reset();
    profile.runs_end_low = reach.low;
  }
  if (reach.high < prior.high() && parts.back().high > reach.high) {
    profile.high.reset();
    profile.runs_end_high = reach.high;
  }
}

/// Log |S| - log |N| at u, of the data's covariance with the surrogate's part and without it.
double ignorance(const CaseModel& model, const CaseModel& exact, const Eigen::VectorXd& u) {
  const Eigen::LLT<Eigen::MatrixXd> with(predict(model, u).total()), without(predict(exact, u).total());
  if (with.info() != Eigen::Success || without.info() != Eigen::Success) return 0.0;
  return 2.0 * (with.matrixLLT().diagonal().array().log().sum() - without.matrixLLT().diagonal().array().log().sum());
}

/// Opens the sides beyond which only the surrogate's ignorance speaks against every value. `inside`: the outermost
/// points of the interval.
void open_to_ignorance(const CaseModel& model, const Eigen::VectorXd& best,
                       std::pair<Eigen::Index, Eigen::Index> inside, Profile& profile) {
  const CaseModel exact = without_surrogate_error(model);
  const double at_best = ignorance(model, exact, best);
  const auto excluded = [&](Eigen::Index from, Eigen::Index to) {
    for (Eigen::Index i = from; i <= to; ++i) {
      if (profile.deviance[i] <= profile.drop) continue;
      const double grown = ignorance(model, exact, profile.path.row(i).transpose()) - at_best;
      if (profile.deviance[i] - std::max(grown, 0.0) > profile.drop) return true;
    }
    return false;
  };
  if (profile.low && !excluded(0, inside.first - 1)) {
    profile.low.reset();
    profile.low_unknown = true;
  }
  if (profile.high && !excluded(inside.second + 1, profile.u.size() - 1)) {
    profile.high.reset();
    profile.high_unknown = true;
  }
}

/// Whether an error of two of the surrogate's sds would take the barrier away: between its highest point and either of
/// the two parts.
bool in_doubt(const CaseModel& model, const Yardstick& yardstick, const Profile& profile, Eigen::Index peak,
              std::pair<Eigen::Index, Eigen::Index> wells, double drop) {
  const Eigen::VectorXd at_peak = profile.path.row(peak).transpose();
  const double needed = std::sqrt(profile.deviance[peak]) - std::sqrt(drop);
  for (const Eigen::Index well : {wells.first, wells.second}) {
    const Eigen::VectorXd at_well = profile.path.row(well).transpose();
    if (needed < 2.0 * difference(model, yardstick, at_peak, at_well).doubt) return true;
  }
  return false;
}

}  // namespace

namespace {

/// Points of a path in a row that belong to one part of the interval, and the deviance at its ends.
struct PointsInside {
  Eigen::Index first = 0, last = 0;
  double level = 0.0;
  bool minor = false;  ///< beyond the drop
};

/// Those below the drop.
std::vector<PointsInside> points_below(const Profile& profile) {
  std::vector<PointsInside> runs;
  for (Eigen::Index i = 0; i < profile.u.size(); ++i) {
    if (profile.deviance[i] > profile.drop) continue;
    if (runs.empty() || runs.back().last != i - 1) runs.push_back({i, i, profile.drop, false});
    runs.back().last = i;
  }
  return runs;
}

/// Whether a hill above the drop is a value of its own: it holds a share of the posterior, by the draws or by the
/// profile, and no error of the surrogate would join it to its neighbours.
bool is_minor_value(const CaseModel& model, const Yardstick& yardstick, const Profile& profile, const Hill& hill,
                    const Eigen::MatrixXd& draws, double least_mass) {
  const double least = profile.deviance[hill.best];
  if (least <= profile.drop) return false;
  const auto u = draws.col(profile.unknown).array();
  const auto inside = (u >= profile.u[hill.first] && u <= profile.u[hill.last]).count();
  const double share = draws.rows() > 0 ? static_cast<double>(inside) / static_cast<double>(draws.rows()) : 0.0;
  if (std::max(hill.mass, share) < least_mass) return false;
  const auto doubtful = [&](Eigen::Index peak) {
    const bool end = peak == 0 || peak == profile.u.size() - 1;
    return !end && in_doubt(model, yardstick, profile, peak, {hill.best, hill.best}, least);
  };
  return !doubtful(hill.first) && !doubtful(hill.last);
}

/// The parts of the interval from left to right. Each reaches as far as the deviance has risen by the drop from its own
/// least, at most to the peaks beside it: what is known of a value where it is the right one.
std::vector<PointsInside> points_inside(const CaseModel& model, const Yardstick& yardstick, const Profile& profile,
                                        const Eigen::MatrixXd& draws, double least_mass) {
  const ScaledPrior& prior = model.unknowns[profile.unknown].prior;
  Eigen::VectorXd log_prior(profile.u.size());
  for (Eigen::Index i = 0; i < log_prior.size(); ++i) log_prior[i] = std::max(prior.log_density(profile.u[i]), -200.0);
  const std::vector<Hill> hills = find_hills(profile.u, profile.deviance, log_prior);
  std::vector<PointsInside> runs = points_below(profile);
  for (const Hill& hill : hills)
    if (is_minor_value(model, yardstick, profile, hill, draws, least_mass))
      runs.push_back({hill.best, hill.best, profile.drop, true});
  std::sort(runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (PointsInside& run : runs) {
    run.level += profile.deviance.segment(run.first, run.last - run.first + 1).minCoeff();
    Eigen::Index low = run.first, high = run.last;  // peaks on either side
    for (const Hill& hill : hills)
      if (hill.best >= run.first && hill.best <= run.last) {
        low = std::min(low, hill.first);
        high = std::max(high, hill.last);
      }
    while (run.first - 1 > low && profile.deviance[run.first - 1] <= run.level) --run.first;
    while (run.last + 1 < high && profile.deviance[run.last + 1] <= run.level) ++run.last;
  }
  return runs;
}

}  // namespace

void finish_profile(const CaseModel& model, const Profiles& all, const Eigen::MatrixXd& draws, Profile& profile,
                    const VerdictThresholds& thresholds) {
  const Box box{model.lower(), model.upper()};
  const double drop = profile.drop;
  profile.deviance = (2.0 * (all.best.value - profile.log_likelihood.array())).max(0.0);
  const Eigen::Index count = profile.u.size();

  const Yardstick yardstick = make_yardstick(model, all.best.x);
  const std::vector<PointsInside> runs = points_inside(model, yardstick, profile, draws, thresholds.mode_weight);
  if (runs.empty()) return;  // the best fit itself is a point inside, so this does not happen

  // Their ends where the deviance crosses the drop.
  std::vector<ProfilePart> parts;
  Crossing first, last;
  for (const PointsInside& run : runs) {
    ProfilePart part{.low = profile.u[run.first], .high = profile.u[run.last], .best = run.first};
    for (Eigen::Index i = run.first; i <= run.last; ++i)
      if (profile.deviance[i] < profile.deviance[part.best]) part.best = i;
    if (run.first > 0) {
      const Crossing low = find_crossing(model, box, profile, run.first, run.first - 1, all.best.value, run.level);
      part.low = low.at;
      if (parts.empty()) first = low;
    }
    if (run.last < count - 1) {
      last = find_crossing(model, box, profile, run.last, run.last + 1, all.best.value, run.level);
      part.high = last.at;
    }
    parts.push_back(part);
  }
  if (runs.front().first > 0) {
    profile.low_pinned = pinned(model, box, all, profile, first, thresholds);
    if (!profile.low_pinned) profile.low = parts.front().low;
  }
  if (runs.back().last < count - 1) {
    profile.high_pinned = pinned(model, box, all, profile, last, thresholds);
    if (!profile.high_pinned) profile.high = parts.back().high;
  }

  open_beyond(all, profile, thresholds);
  open_beyond_runs(model, parts, profile);
  open_to_ignorance(model, all.best.x, {runs.front().first, runs.back().last}, profile);

  // Barriers between them.
  profile.parts = {parts.front()};
  for (std::size_t i = 1; i < parts.size(); ++i) {
    Eigen::Index peak = runs[i - 1].last + 1;
    for (Eigen::Index j = peak; j < runs[i].first; ++j)
      if (profile.deviance[j] > profile.deviance[peak]) peak = j;
    ProfileBarrier barrier{.low = parts[i - 1].high, .high = parts[i].low, .deviance = profile.deviance[peak]};
    barrier.in_doubt = !runs[i - 1].minor && !runs[i].minor &&
                       in_doubt(model, yardstick, profile, peak, {profile.parts.back().best, parts[i].best}, drop);
    profile.barriers.push_back(barrier);
    if (barrier.in_doubt) {
      ProfilePart& joined = profile.parts.back();
      joined.high = parts[i].high;
      if (profile.deviance[parts[i].best] < profile.deviance[joined.best]) joined.best = parts[i].best;
    } else {
      profile.parts.push_back(parts[i]);
    }
  }
}

}  // namespace uq
