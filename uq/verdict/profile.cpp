#include "uq/verdict/profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "uq/posterior/posterior.hpp"
#include "uq/verdict/interval_drop.hpp"

namespace uq {
namespace {

/// Where the draws of one unknown lie: apart from each other by two empty bins of 64.
struct Cluster {
  double mean = 0.0, sd = 0.0;
};
std::vector<Cluster> clusters(const Eigen::VectorXd& draws, double low, double high) {
  constexpr int bins = 64;
  constexpr double least_share = 0.005;
  std::vector<std::vector<double>> filled(bins);
  for (const double u : draws)
    filled[static_cast<std::size_t>(std::clamp(static_cast<int>(bins * (u - low) / (high - low)), 0, bins - 1))]
        .push_back(u);
  std::vector<Cluster> found;
  std::vector<double> members;
  const auto close = [&] {
    if (static_cast<double>(members.size()) >= std::max(3.0, least_share * static_cast<double>(draws.size()))) {
      // A copy is aligned; sums over a map would depend on where its memory happens to lie.
      const Eigen::ArrayXd values =
          Eigen::Map<const Eigen::ArrayXd>(members.data(), static_cast<Eigen::Index>(members.size()));
      found.push_back({values.mean(), std::sqrt((values - values.mean()).square().mean())});
    }
    members.clear();
  };
  int empty = 0;
  for (const auto& bin : filled) {
    empty = bin.empty() ? empty + 1 : 0;
    if (empty == 2) close();
    members.insert(members.end(), bin.begin(), bin.end());
  }
  close();
  return found;
}

/// Values at which unknown k is held: spread over the support, denser over where the draws lie, and the maxima.
std::vector<double> held_values(const Box& box, int k, const Eigen::VectorXd& draws, const Profiles& known,
                                const ProfileOptions& options) {
  const double low = box.lower[k], high = box.upper[k];
  std::vector<double> values = {known.best.x[k]};
  for (const Maximum& maximum : known.maxima) values.push_back(maximum.x[k]);
  auto spread = [&](double from, double to, int count) {
    for (int i = 0; i < count; ++i) values.push_back(from + (to - from) * i / (count - 1));
  };
  spread(low, high, options.even_points);
  const std::vector<Cluster> where = clusters(draws, low, high);
  const int each = std::max(7, options.near_points / std::max(1, static_cast<int>(where.size())));
  for (const Cluster& cluster : where)
    spread(std::max(low, cluster.mean - 3.5 * cluster.sd), std::min(high, cluster.mean + 3.5 * cluster.sd), each);
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

/// The most likely draws that are apart from each other, and a few points of a low-discrepancy sequence (Halton 1960)
/// over the box: where another maximum may be climbed from.
Eigen::MatrixXd spread_starts(const CaseModel& model, const Box& box, const Guides& guides) {
  constexpr double apart = 0.08;  // of the support
  constexpr std::size_t from_draws = 8;
  constexpr int many_rows = 200;  // each evaluation is dear
  constexpr std::array<int, 12> primes = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
  const Eigen::VectorXd width = box.upper - box.lower;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(guides.draws.rows()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return guides.log_likelihood[a] > guides.log_likelihood[b]; });
  std::vector<Eigen::VectorXd> chosen;
  for (const Eigen::Index i : order) {
    if (chosen.size() == from_draws) break;
    const Eigen::VectorXd u = guides.draws.row(i).transpose();
    const bool near = std::any_of(chosen.begin(), chosen.end(), [&](const Eigen::VectorXd& other) {
      return ((u - other).array() / width.array()).abs().maxCoeff() < apart;
    });
    if (!near) chosen.push_back(u);
  }
  const int from_box = model.row_count() > many_rows ? 0 : 12;
  for (int i = 1; i <= from_box; ++i) {
    Eigen::VectorXd u(width.size());
    for (Eigen::Index k = 0; k < u.size(); ++k) {
      const int base = primes[static_cast<std::size_t>(k) % primes.size()];
      double share = 0.0, step = 1.0;
      for (int n = i; n > 0; n /= base) share += (step /= base) * (n % base);
      u[k] = box.lower[k] + share * width[k];
    }
    chosen.push_back(u);
  }
  Eigen::MatrixXd starts(static_cast<Eigen::Index>(chosen.size()), width.size());
  for (std::size_t i = 0; i < chosen.size(); ++i) starts.row(i) = chosen[i].transpose();
  return starts;
}

/// Maxima climbed to from spread starts: the largest, and others within `within` of it in log likelihood.
void climb(const CaseModel& model, const Box& box, const Guides& guides, double within, Profiles& found) {
  constexpr double same = 1e-3;  // of the support
  std::vector<Maximum> all;
  const Eigen::MatrixXd starts = spread_starts(model, box, guides);
  for (Eigen::Index i = 0; i < starts.rows(); ++i) {
    Maximum one = maximise_profiled(model, box, starts.row(i), {});
    if (!std::isfinite(one.value)) continue;
    if (one.value > found.best.value || found.best.x.size() == 0) found.best = one;
    all.push_back(std::move(one));
  }
  const Eigen::ArrayXd width = (box.upper - box.lower).array();
  for (const Maximum& one : all) {
    if (one.value < found.best.value - within || found.maxima.size() >= 12) continue;
    const auto near = [&](const Maximum& other) { return ((one.x - other.x).array() / width).abs().maxCoeff() < same; };
    if (near(found.best) || std::any_of(found.maxima.begin(), found.maxima.end(), near)) continue;
    found.maxima.push_back(one);
  }
}

Profile sweep(const CaseModel& model, const Box& box, int k, const Guides& guides, const Profiles& known,
              const ProfileOptions& options) {
  const Maximum& best = known.best;
  const std::vector<double> values = held_values(box, k, guides.draws.col(k), known, options);
  const auto count = static_cast<Eigen::Index>(values.size());
  Profile profile{.unknown = k,
                  .drop = known.drops[k],
                  .u = Eigen::Map<const Eigen::VectorXd>(values.data(), count),
                  .log_likelihood = Eigen::VectorXd(count),
                  .deviance = {},
                  .path = Eigen::MatrixXd(count, best.x.size()),
                  .low = {},
                  .high = {}};
  Eigen::VectorXd& level = profile.log_likelihood;
  const auto centre = std::lower_bound(values.begin(), values.end(), best.x[k] - 1e-9) - values.begin();
  const double width = 0.02 * (box.upper[k] - box.lower[k]);
  auto solve = [&](Eigen::Index i, const Eigen::VectorXd& neighbour) {
    Eigen::MatrixXd starts = neighbour.transpose();
    if (const auto near = draw_near(guides, k, values[i], width)) {
      starts.conservativeResize(2, Eigen::NoChange);
      starts.row(1) = near->transpose();
    }
    for (const Maximum& other : known.maxima)
      if (std::abs(other.x[k] - values[i]) < width) {
        starts.conservativeResize(starts.rows() + 1, Eigen::NoChange);
        starts.row(starts.rows() - 1) = other.x.transpose();
      }
    const Maximum found = maximise_profiled(model, box, starts, {Held{k, values[i]}});
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
    moved[k] = values[i];
    if (log_likelihood(model, moved) + log_certificates(model, moved).value <= level[i]) return;
    const Maximum found = maximise_profiled(model, box, start.transpose(), {Held{k, values[i]}});
    if (found.value <= level[i]) return;
    level[i] = found.value;
    profile.path.row(i) = found.x.transpose();
  };
  for (Eigen::Index i = count - 2; i >= middle; --i) improve(i, i + 1);
  for (Eigen::Index i = 1; i <= middle; ++i) improve(i, i - 1);
  return profile;
}

}  // namespace

Differentiable profiled(const CaseModel& model) {
  return [&model](const Eigen::VectorXd& u) -> Evaluation {
    const Evaluation data = log_likelihood_gradient(model, u), certificates = log_certificates(model, u);
    const Eigen::VectorXd gradient = data.gradient + certificates.gradient;
    return {.value = data.value + certificates.value, .gradient = gradient};
  };
}

Maximum maximum_likelihood(const CaseModel& model, const Eigen::MatrixXd& starts) {
  return maximise_profiled(model, {model.lower(), model.upper()}, starts, {});
}

Profiles profile_likelihood(const CaseModel& model, const Guides& guides, const ProfileOptions& options) {
  const Box box{model.lower(), model.upper()};
  Profiles found;
  climb(model, box, guides, 0.5 * options.thresholds.profile_drop, found);
  found.drops = interval_drops(model, found.best.x, guides.draws, options.thresholds.profile_drop);
  found.influence = find_influence(model, found.best.x, guides.draws, options.thresholds);
  for (int k = 0; k < model.dimension(); ++k) {
    if (!model.unknowns[k].own) continue;
    Profile profile = sweep(model, box, k, guides, found, options);
    Eigen::Index highest = 0;
    if (profile.log_likelihood.maxCoeff(&highest) > found.best.value) {
      found.best.value = profile.log_likelihood[highest];
      found.best.x = profile.path.row(highest).transpose();
    }
    found.profiles.push_back(std::move(profile));
  }
  found.ends = range_ends(model, found.best.x);
  for (auto& profile : found.profiles) finish_profile(model, found, guides.draws, profile, options.thresholds);
  return found;
}

bool physical_low(const Unknown& unknown) {
  const data::Parameter& parameter = unknown.prior.parameter();
  return parameter.scale == data::Scale::linear && parameter.low == 0.0 && unknown.prior.low() < 1e-12;
}

}  // namespace uq
