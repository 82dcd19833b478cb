#include "uq/profile.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "uq/posterior.hpp"

namespace uq {
namespace {

/// Values at which unknown k is held: spread over the support, and denser over where the draws lie.
std::vector<double> held_values(const Box& box, int k, const Eigen::VectorXd& draws, double best,
                                const ProfileOptions& options) {
  const double low = box.lower[k], high = box.upper[k];
  std::vector<double> values = {best};
  auto spread = [&](double from, double to, int count) {
    for (int i = 0; i < count; ++i) values.push_back(from + (to - from) * i / (count - 1));
  };
  spread(low, high, options.even_points);
  const double mean = draws.mean();
  const double sd = std::sqrt((draws.array() - mean).square().mean());
  spread(std::max(low, mean - 3.5 * sd), std::min(high, mean + 3.5 * sd), options.near_points);
  std::sort(values.begin(), values.end());
  const double apart = 1e-6 * (high - low);
  values.erase(std::unique(values.begin(), values.end(), [&](double a, double b) { return b - a < apart; }),
               values.end());
  return values;
}

/// The most likely draw near u_k = value, or nothing when none is near.
std::optional<Eigen::VectorXd> draw_near(const Guides& guides, int k, double value, double width) {
  std::optional<Eigen::Index> chosen;
  for (Eigen::Index i = 0; i < guides.draws.rows(); ++i)
    if (std::abs(guides.draws(i, k) - value) < width &&
        (!chosen || guides.log_likelihood[i] > guides.log_likelihood[*chosen]))
      chosen = i;
  if (!chosen) return {};
  return Eigen::VectorXd(guides.draws.row(*chosen).transpose());
}

/// Of the data, and of what calibrated the nuisances.
Differentiable likelihood_of(const CaseModel& model) {
  return [&model](const Eigen::VectorXd& u) -> Evaluation {
    const Evaluation data = log_likelihood_gradient(model, u), certificates = log_certificates(model, u);
    const Eigen::VectorXd gradient = data.gradient + certificates.gradient;
    return {.value = data.value + certificates.value, .gradient = gradient};
  };
}

/// Where the deviance crosses the drop, and the maximiser there.
struct Crossing {
  double at = 0.0;
  Eigen::VectorXd maximiser;
};

/// Bisection between an inside and an outside value of unknown k.
Crossing find_crossing(const CaseModel& model, const Box& box, Held inside, Held outside, const Eigen::VectorXd& start,
                       double level) {
  Eigen::VectorXd warm = start;
  for (int i = 0; i < 14; ++i) {
    const double middle = 0.5 * (inside.value + outside.value);
    const Maximum found = maximise(likelihood_of(model), box, warm.transpose(), Held{inside.coordinate, middle});
    if (found.value >= level) {
      inside.value = middle;
      warm = found.x;
    } else {
      outside.value = middle;
    }
  }
  return {.at = 0.5 * (inside.value + outside.value), .maximiser = warm};
}

/// Another unknown that sits at the end of its range, if one does and the interval ends for that: were its range twice
/// as wide, the deviance there would fall by half of the drop, to first order. One without influence ends nothing.
std::optional<int> pinned(const CaseModel& model, const Box& box, int k, const Eigen::VectorXd& at, double drop) {
  const Eigen::VectorXd slope = likelihood_of(model)(at).gradient;
  for (int other = 0; other < model.dimension(); ++other) {
    if (other == k) continue;
    const double width = box.upper[other] - box.lower[other];
    if (2.0 * std::abs(slope[other]) * width < 0.5 * drop) continue;
    const bool low =
        at[other] - box.lower[other] < 1e-4 * width && !physical_low(model.slots[static_cast<std::size_t>(other)]);
    if (low || box.upper[other] - at[other] < 1e-4 * width) return other;
  }
  return {};
}

Profile sweep(const CaseModel& model, const Box& box, int k, const Guides& guides, const Maximum& best,
              const ProfileOptions& options) {
  const std::vector<double> values = held_values(box, k, guides.draws.col(k), best.x[k], options);
  const auto count = static_cast<Eigen::Index>(values.size());
  Profile profile{.unknown = k,
                  .u = Eigen::Map<const Eigen::VectorXd>(values.data(), count),
                  .deviance = Eigen::VectorXd(count),
                  .path = Eigen::MatrixXd(count, best.x.size()),
                  .low = {},
                  .high = {}};
  Eigen::VectorXd level(count);
  const auto centre = std::lower_bound(values.begin(), values.end(), best.x[k] - 1e-9) - values.begin();
  const double width = 0.02 * (box.upper[k] - box.lower[k]);
  auto solve = [&](Eigen::Index i, const Eigen::VectorXd& neighbour) {
    Eigen::MatrixXd starts = neighbour.transpose();
    if (const auto near = draw_near(guides, k, values[static_cast<std::size_t>(i)], width)) {
      starts.conservativeResize(2, Eigen::NoChange);
      starts.row(1) = near->transpose();
    }
    const Maximum found = maximise(likelihood_of(model), box, starts, Held{k, values[static_cast<std::size_t>(i)]});
    level[i] = found.value;
    profile.path.row(i) = found.x.transpose();
  };
  // Outward from the best fit, each start from its inner neighbour, then once inward from the ends where that is
  // better.
  const auto middle = static_cast<Eigen::Index>(std::min<std::ptrdiff_t>(centre, count - 1));
  solve(middle, best.x);
  for (Eigen::Index i = middle + 1; i < count; ++i) solve(i, profile.path.row(i - 1).transpose());
  for (Eigen::Index i = middle - 1; i >= 0; --i) solve(i, profile.path.row(i + 1).transpose());
  auto improve = [&](Eigen::Index i, Eigen::Index from) {
    const Eigen::VectorXd start = profile.path.row(from).transpose();
    Eigen::VectorXd moved = start;
    moved[k] = values[static_cast<std::size_t>(i)];
    if (log_likelihood(model, moved) + log_certificates(model, moved).value <= level[i]) return;
    const Maximum found =
        maximise(likelihood_of(model), box, start.transpose(), Held{k, values[static_cast<std::size_t>(i)]});
    if (found.value <= level[i]) return;
    level[i] = found.value;
    profile.path.row(i) = found.x.transpose();
  };
  for (Eigen::Index i = count - 2; i >= middle; --i) improve(i, i + 1);
  for (Eigen::Index i = 1; i <= middle; ++i) improve(i, i - 1);
  profile.deviance = level;  // turned into deviances once the largest likelihood of all is known
  return profile;
}

/// From log likelihoods to deviances, and the ends of the interval.
void finish(const CaseModel& model, const Box& box, Profile& profile, const Maximum& best, double drop) {
  const Eigen::VectorXd level = profile.deviance;
  profile.deviance = (2.0 * (best.value - level.array())).max(0.0);
  const Eigen::Index count = level.size();
  profile.deviance_at_low = profile.deviance[0];
  profile.deviance_at_high = profile.deviance[count - 1];
  Eigen::Index first = 0, last = count - 1;
  while (first < count && profile.deviance[first] > drop) ++first;
  while (last >= 0 && profile.deviance[last] > drop) --last;
  if (first == count) return;  // no point inside: the best fit itself is one, so this does not happen
  const double wanted = best.value - 0.5 * drop;
  const int k = profile.unknown;
  auto end = [&](Eigen::Index inside, Eigen::Index outside, std::optional<double>& at, std::optional<int>& by) {
    const Eigen::VectorXd start = profile.path.row(inside).transpose();
    const Crossing found = find_crossing(model, box, {k, profile.u[inside]}, {k, profile.u[outside]}, start, wanted);
    by = pinned(model, box, k, found.maximiser, drop);
    if (!by) at = found.at;
  };
  if (first > 0) end(first, first - 1, profile.low, profile.low_pinned);
  if (last < count - 1) end(last, last + 1, profile.high, profile.high_pinned);
}

}  // namespace

Maximum maximum_likelihood(const CaseModel& model, const Eigen::MatrixXd& starts) {
  return maximise(likelihood_of(model), {model.lower(), model.upper()}, starts);
}

Profiles profile_likelihood(const CaseModel& model, const Guides& guides, const ProfileOptions& options) {
  const Box box{model.lower(), model.upper()};
  // Starts: the most likely draws.
  std::vector<Eigen::Index> order(static_cast<std::size_t>(guides.draws.rows()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const std::size_t top = std::min<std::size_t>(4, order.size());
  std::partial_sort(
      order.begin(), order.begin() + static_cast<std::ptrdiff_t>(top), order.end(),
      [&](Eigen::Index a, Eigen::Index b) { return guides.log_likelihood[a] > guides.log_likelihood[b]; });
  Eigen::MatrixXd starts(static_cast<Eigen::Index>(top), model.dimension());
  for (std::size_t i = 0; i < top; ++i) starts.row(static_cast<Eigen::Index>(i)) = guides.draws.row(order[i]);

  Profiles found{.profiles = {}, .best = maximum_likelihood(model, starts)};
  for (int k = 0; k < model.dimension(); ++k) {
    if (!model.slots[static_cast<std::size_t>(k)].own) continue;
    Profile profile = sweep(model, box, k, guides, found.best, options);
    Eigen::Index highest = 0;
    if (profile.deviance.maxCoeff(&highest) > found.best.value) {
      found.best.value = profile.deviance[highest];
      found.best.x = profile.path.row(highest).transpose();
    }
    found.profiles.push_back(std::move(profile));
  }
  for (auto& profile : found.profiles) finish(model, box, profile, found.best, options.drop);
  return found;
}

bool physical_low(const Slot& slot) {
  const data::Parameter& parameter = slot.prior.parameter();
  return parameter.scale == data::Scale::linear && parameter.low == 0.0 && slot.prior.low() < 1e-12;
}

NoiseFree noise_free_extent(const CaseModel& model, const Profile& profile, const Eigen::VectorXd& best,
                            double variance_factor, double drop) {
  const Box box{model.lower(), model.upper()};
  const Eigen::VectorXd truth = predict(model, best).mean;
  // Twice the log likelihood of that truth, up to constants. What only widens the spread explains nothing, and stays.
  const double known = log_certificates(model, best).value;
  auto match = [&](const Eigen::VectorXd& u) {
    Eigen::VectorXd at = u;
    for (int s = 0; s < model.dimension(); ++s)
      if (model.slots[static_cast<std::size_t>(s)].nuisance == Acts::on_spread) at[s] = best[s];
    return -chi_squared(predict(model, at), truth, variance_factor) + 2.0 * (log_certificates(model, at).value - known);
  };
  const Differentiable function = with_differences(match, box);
  Eigen::Index nearest = 0;
  (profile.u.array() - best[profile.unknown]).abs().minCoeff(&nearest);
  NoiseFree found{.low = profile.u[nearest], .high = profile.u[nearest]};
  // Followed along the profile's path towards each bound, so that a curved ridge is not lost, until the means differ.
  for (const Eigen::Index step : {-1, 1}) {
    Eigen::VectorXd at = best;
    for (Eigen::Index i = nearest + step; i >= 0 && i < profile.u.size() && profile.deviance[i] <= drop; i += step) {
      Eigen::MatrixXd starts(2, at.size());
      starts << at.transpose(), profile.path.row(i);
      const Maximum closest = maximise(function, box, starts, Held{profile.unknown, profile.u[i]});
      if (-closest.value > drop) break;
      at = closest.x;
      (step < 0 ? found.low : found.high) = profile.u[i];
    }
  }
  double low = profile.u[nearest], high = low;
  for (Eigen::Index i = 0; i < profile.u.size(); ++i)
    if (profile.deviance[i] <= drop) {
      low = std::min(low, profile.u[i]);
      high = std::max(high, profile.u[i]);
    }
  found.share = high > low ? (found.high - found.low) / (high - low) : 0.0;
  return found;
}

}  // namespace uq
