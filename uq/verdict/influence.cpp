#include "uq/verdict/influence.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "uq/posterior/posterior.hpp"
#include "uq/posterior/support.hpp"

namespace uq {
namespace {

constexpr Eigen::Index rows_looked_at = 24;  // of a group
constexpr Eigen::Index points_beside_best = 4;
/// Shares of a range, uneven, so that a periodic response is not met at one phase alone.
constexpr std::array<double, 7> shares = {0.0, 0.13, 0.31, 0.5, 0.69, 0.87, 1.0};

/// The emulator's inputs of the rows looked at.
Eigen::MatrixXd inputs_at(const RowGroup& group, const Yardstick::Group& looked, const Eigen::VectorXd& u) {
  Eigen::MatrixXd points(static_cast<Eigen::Index>(looked.rows.size()), group.base.cols());
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    for (Eigen::Index k = 0; k < points.cols(); ++k) points(i, k) = group.input(looked.rows[i], k, u);
  return points;
}

Eigen::VectorXd means_at(const RowGroup& group, const Yardstick::Group& looked, const Eigen::VectorXd& u) {
  if (looked.rows.empty()) return {};
  const Eigen::MatrixXd points = inputs_at(group, looked, u);
  return group.emulator.predict_mean ? group.emulator.predict_mean(points) : group.emulator.predict(points).mean;
}

bool acts_on_emulators(const CaseModel& model, int unknown) {
  return std::any_of(model.groups.begin(), model.groups.end(),
                     [&](const RowGroup& group) { return (group.unknown.array() == unknown).any(); });
}

/// What an unknown changes over its range, and what of that the surrogate leaves in doubt: sums over rows, levels of
/// the unknown and the points about which it moves, in squares of the data's errors.
class Effects {
 public:
  /// Counts the rows of a group in. `at`: their predictions, level below level.
  void add(const surrogate::Prediction& at, const Yardstick::Group& looked) {
    const auto n = static_cast<Eigen::Index>(looked.rows.size());
    for (Eigen::Index i = 0; i < n; ++i) {
      const double w = looked.weight[i] * looked.weight[i] * looked.stands_for;
      double mean = 0.0, own = 0.0, shared = 0.0;
      for (Eigen::Index t = 0; t < levels; ++t) {
        mean += at.mean[t * n + i] / static_cast<double>(levels);
        own += at.covariance(t * n + i, t * n + i);
        for (Eigen::Index s = 0; s < levels; ++s) shared += at.covariance(t * n + i, s * n + i);
      }
      const double left_open = std::max(own - shared / static_cast<double>(levels), 0.0);
      doubt_ += w * left_open;
      doubt_in_noise_ += looked.noise_weight[i] * looked.noise_weight[i] * looked.stands_for * left_open;
      const Eigen::Index last = (levels - 1) * n + i;
      ends_effect_ += w * std::pow(at.mean[last] - at.mean[i], 2);
      ends_doubt_ += w * std::max(at.covariance(i, i) + at.covariance(last, last) - 2.0 * at.covariance(i, last), 0.0);
      for (Eigen::Index t = 0; t < levels; ++t) {
        const double d = at.mean[t * n + i] - mean;
        effect_ += w * d * d;
        moved_[t] += w * std::pow(at.mean[t * n + i] - at.mean[i], 2);
      }
    }
  }
  /// Ends the sums about one point.
  void end_point() {
    deviance_ = std::max(deviance_, *std::max_element(moved_.begin(), moved_.end()));
    moved_ = {};
    ++points_;
  }
  Influence judged(const VerdictThresholds& thresholds) const {
    Influence influence{.deviance = deviance_, .doubt = doubt_in_noise_ / static_cast<double>(points_ * shares.size())};
    // Runs at a few levels may leave all between these in doubt, and yet tell the ends of the range apart.
    const double least = thresholds.told_apart_sd * thresholds.told_apart_sd;
    influence.shown = effect_ > least * doubt_ || ends_effect_ > least * ends_doubt_;
    influence.some = influence.shown && influence.deviance >= thresholds.silent_deviance;
    const double lowered = influence.deviance * thresholds.errors_lowered * thresholds.errors_lowered;
    influence.hidden = influence.shown && !influence.some && lowered >= thresholds.profile_drop;
    return influence;
  }

 private:
  static constexpr auto levels = static_cast<Eigen::Index>(shares.size());
  double effect_ = 0.0, doubt_ = 0.0;             // about the mean of the levels
  double doubt_in_noise_ = 0.0;                   // in squares of the noise alone
  double ends_effect_ = 0.0, ends_doubt_ = 0.0;   // between the ends of the range
  double deviance_ = 0.0;                         // largest of the points
  std::array<double, shares.size()> moved_ = {};  // of each level beside the first, about the current point
  std::size_t points_ = 0;
};

/// The effects of an unknown that acts on emulators, moved through its range about each of the points.
Effects effects_of(const CaseModel& model, const Yardstick& yardstick, const std::vector<Eigen::VectorXd>& bases,
                   int k) {
  constexpr auto levels = static_cast<Eigen::Index>(shares.size());
  const RunsReach reach = runs_reach(model, k);  // beyond it the doubt would hide what the runs show
  Effects effects;
  for (const Eigen::VectorXd& base : bases) {
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
      const RowGroup& group = model.groups[g];
      const Yardstick::Group& looked = yardstick.groups[g];
      const auto n = static_cast<Eigen::Index>(looked.rows.size());
      if (n == 0 || !(group.unknown.array() == k).any()) continue;
      // All levels of the unknown, one below the other: about their own mean, so that what they share drops out.
      Eigen::MatrixXd points(levels * n, group.base.cols());
      for (Eigen::Index t = 0; t < levels; ++t) {
        Eigen::VectorXd u = base;
        u[k] = reach.low + shares[t] * (reach.high - reach.low);
        points.middleRows(t * n, n) = inputs_at(group, looked, u);
      }
      effects.add(group.emulator.predict(points), looked);
    }
    effects.end_point();
  }
  return effects;
}

}  // namespace

Yardstick make_yardstick(const CaseModel& model, const Eigen::VectorXd& best) {
  Yardstick yardstick;
  for (const RowGroup& group : model.groups) {
    Yardstick::Group looked;
    const Eigen::Index rows = group.base.rows(), count = std::min(rows, rows_looked_at);
    for (Eigen::Index i = 0; i < count; ++i) looked.rows.push_back(i * rows / count);
    looked.stands_for = count > 0 ? static_cast<double>(rows) / static_cast<double>(count) : 1.0;
    looked.weight.resize(count);
    looked.noise_weight.resize(count);
    if (count == 0) {
      yardstick.groups.push_back(std::move(looked));
      continue;
    }
    const GroupLaw law = group_law(model, group, best);
    const surrogate::Prediction known = group.emulator.predict(inputs_at(group, looked, best));
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index row = looked.rows[i];
      const double factor = meter_at(group.measurement, model.unknowns, best, row).factor;
      const double variance = law.noise[row] + factor * factor * std::max(known.covariance(i, i), 0.0);
      looked.weight[i] = variance > 0.0 ? factor / std::sqrt(variance) : 0.0;
      looked.noise_weight[i] = law.noise[row] > 0.0 ? factor / std::sqrt(law.noise[row]) : looked.weight[i];
    }
    yardstick.groups.push_back(std::move(looked));
  }
  return yardstick;
}

Difference difference(const CaseModel& model, const Yardstick& yardstick, const Eigen::VectorXd& u,
                      const Eigen::VectorXd& v) {
  double size = 0.0, doubt = 0.0;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Yardstick::Group& looked = yardstick.groups[g];
    const auto n = static_cast<Eigen::Index>(looked.rows.size());
    if (n == 0) continue;
    Eigen::MatrixXd points(2 * n, model.groups[g].base.cols());
    points << inputs_at(model.groups[g], looked, u), inputs_at(model.groups[g], looked, v);
    const surrogate::Prediction found = model.groups[g].emulator.predict(points);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double w = looked.weight[i] * looked.weight[i] * looked.stands_for;
      const double d = found.mean[i] - found.mean[n + i];
      size += w * d * d;
      doubt +=
          w * std::max(found.covariance(i, i) + found.covariance(n + i, n + i) - 2.0 * found.covariance(i, n + i), 0.0);
    }
  }
  return {.size = std::sqrt(size), .doubt = std::sqrt(doubt)};
}

DistanceFrom::DistanceFrom(const CaseModel& model, const Yardstick& yardstick, const Eigen::VectorXd& v)
    : model_(model), yardstick_(yardstick) {
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    means_.push_back(means_at(model.groups[g], yardstick.groups[g], v));
}

double DistanceFrom::operator()(const Eigen::VectorXd& u) const {
  double square = 0.0;
  for (std::size_t g = 0; g < model_.groups.size(); ++g) {
    const Yardstick::Group& looked = yardstick_.groups[g];
    const Eigen::VectorXd d = means_at(model_.groups[g], looked, u) - means_[g];
    square += looked.stands_for * looked.weight.cwiseProduct(d).squaredNorm();
  }
  return std::sqrt(square);
}

std::vector<Influence> find_influence(const CaseModel& model, const Eigen::VectorXd& best, const Eigen::MatrixXd& draws,
                                      const VerdictThresholds& thresholds) {
  const Yardstick yardstick = make_yardstick(model, best);
  std::vector<Eigen::VectorXd> bases = {best};
  const Eigen::Index count = std::min(points_beside_best, draws.rows());
  for (Eigen::Index i = 0; i < count; ++i)
    bases.emplace_back(draws.row((2 * i + 1) * draws.rows() / (2 * count)).transpose());

  std::vector<Influence> found;
  for (int k = 0; k < model.dimension(); ++k) {
    // A nuisance of the meter acts without the surrogate; a parameter that no emulator sees does nothing.
    const bool meter = model.unknowns[k].nuisance.has_value();
    found.push_back(acts_on_emulators(model, k) ? effects_of(model, yardstick, bases, k).judged(thresholds)
                                                : Influence{.shown = meter, .some = meter});
  }
  return found;
}

}  // namespace uq
