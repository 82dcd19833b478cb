#include "uq/verdict/repeats.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "data/random.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/predictive.hpp"
#include "uq/verdict/hills.hpp"
#include "uq/verdict/range_end.hpp"

namespace uq {
namespace {

constexpr double least_log_prior = -200.0;  // below, as good as impossible
constexpr double far = 40.0;                // deviance beyond which a path's point plays no part, whatever the noise

}  // namespace

std::vector<PathPoint> path_points(const CaseModel& model, const CaseModel& judged, const Profile& profile,
                                   const Eigen::VectorXd& best, bool all) {
  const Eigen::VectorXd lower = model.lower(), upper = model.upper();
  const Yardstick yardstick = make_yardstick(judged, best);
  std::vector<PathPoint> found;
  const Eigen::Index last = profile.u.size() - 1;
  for (Eigen::Index i = 0; i <= last; ++i) {
    const Eigen::Index from = std::max<Eigen::Index>(i - 1, 0), count = std::min(i + 1, last) - from + 1;
    const bool end = i == 0 || i == last;
    if (!all && !end && profile.deviance.segment(from, count).minCoeff() > far) continue;
    const Eigen::VectorXd u = profile.path.row(i).transpose();
    const StackedPrediction prediction = predict(model, u);
    const ScaledPrior& prior = model.unknowns[profile.unknown].prior;
    PathPoint point{.u = profile.u[i],
                    .others = u,
                    .log_prior = std::max(prior.log_density(profile.u[i]), least_log_prior),
                    .doubt = difference(judged, yardstick, u, best).doubt,
                    .mean = prediction.mean,
                    .covariance = prediction.covariance,
                    .noise = prediction.noise,
                    .linked_errors = prediction.linked_errors,
                    .slopes = {},
                    .precision = {},
                    .pull_of_certificates = {}};
    const Eigen::MatrixXd slopes = sensitivity(model, u);
    std::vector<Eigen::Index> free;
    for (Eigen::Index s = 0; s < u.size(); ++s) {
      if (s == profile.unknown) continue;
      const End at = end_of(u[s], lower[s], upper[s]);
      if (at == End::inside) free.push_back(s);
      // A bound at 0 that nature sets ends nothing (uq/verdict/profile.hpp).
      if (s < model.own_count() && (at == End::high || (at == End::low && !physical_low(model.unknowns[s]))))
        point.at_end = static_cast<int>(s);
    }
    const Evaluation certificates = log_certificates(model, u);
    point.log_certificates = certificates.value;
    point.slopes.resize(slopes.rows(), static_cast<Eigen::Index>(free.size()));
    point.precision.resize(point.slopes.cols());
    point.pull_of_certificates.resize(point.slopes.cols());
    for (std::size_t k = 0; k < free.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      point.slopes.col(column) = slopes.col(free[k]);
      point.precision[column] = 1.0 / std::pow(model.unknowns[free[k]].prior.sd(), 2);
      point.pull_of_certificates[column] = certificates.gradient.size() > 0 ? certificates.gradient[free[k]] : 0.0;
    }
    found.push_back(std::move(point));
  }
  return found;
}

PathWords::PathWords(const std::vector<PathPoint>& points, const std::vector<Eigen::Index>& rows,
                     const Eigen::VectorXd& noise_share) {
  for (const PathPoint& point : points) {
    Local local{.u = point.u,
                .log_prior = point.log_prior,
                .doubt = point.doubt,
                .mean = point.mean(rows),
                .covariance = {},
                .slopes = {},
                .bent = {}};
    Eigen::MatrixXd covariance = point.covariance(rows, rows);
    add_own_errors(point.noise(rows).cwiseProduct(noise_share), linked_among(point.linked_errors, rows), covariance);
    local.covariance.compute(covariance);
    if (local.covariance.info() != Eigen::Success) continue;
    local.log_determinant = 2.0 * local.covariance.matrixLLT().diagonal().array().log().sum();
    local.log_certificates = point.log_certificates;
    local.pull_of_certificates = point.pull_of_certificates;
    local.slopes = point.slopes(rows, Eigen::all);
    if (local.slopes.cols() > 0) {  // else no other unknown bends with this one
      local.covariance.matrixL().solveInPlace(local.slopes);
      Eigen::MatrixXd precision = local.slopes.transpose() * local.slopes;
      precision.diagonal() += point.precision;
      local.bent.compute(precision);
      if (local.bent.info() != Eigen::Success) continue;
    }
    local.at_end = point.at_end;
    local.others = point.others;
    points_.push_back(std::move(local));
  }
}

std::pair<bool, bool> PathWords::ends_by_another(const Eigen::VectorXd& deviance, double drop) const {
  // The other comes to its end somewhere between the outermost point inside and the next one, where its course from the
  // points further in leads. It ends the interval where the deviance, going on as it does inside, has not reached the
  // drop there.
  const auto ended_between = [&](int inside, int outside, int further_in) {
    const Local &in = points_[inside], &out = points_[outside];
    const int other = out.at_end.value();
    double at = out.u, rise = -HUGE_VAL;  // where the other ends; of the root of the deviance with u, outwards
    if (further_in >= 0 && further_in < static_cast<int>(points_.size())) {
      const Local& before = points_[further_in];
      const double course = (in.others[other] - before.others[other]) / (in.u - before.u);
      const double left = out.others[other] - in.others[other];
      if (course * left * (out.u - in.u) > 0.0) at = in.u + left / course;
      rise = (std::sqrt(deviance[inside]) - std::sqrt(deviance[further_in])) / std::abs(in.u - before.u);
    }
    const double within = std::min(std::abs(at - in.u), std::abs(out.u - in.u));
    // The least deviance lies between: it rises outwards as inwards, and no faster than to the next point, where the
    // end bends it up.
    const double straight = (std::sqrt(deviance[outside]) - std::sqrt(deviance[inside])) / std::abs(out.u - in.u);
    if (rise <= 0.0) rise = std::min(straight, further_in < 0 ? straight : -rise);
    return std::sqrt(deviance[inside]) + rise * within < std::sqrt(drop);
  };
  const auto end_of = [&](int first, int last, int outwards) {
    for (int i = first; i != last; i -= outwards)
      if (deviance[i] <= drop)
        return i != first &&
               (points_[i].at_end || (points_[i + outwards].at_end && ended_between(i, i + outwards, i - outwards)));
    return false;
  };
  const int n = static_cast<int>(points_.size());
  return {end_of(0, n, -1), end_of(n - 1, -1, 1)};
}

Eigen::VectorXd PathWords::deviances(const Eigen::VectorXd& y) const {
  Eigen::VectorXd deviance(static_cast<Eigen::Index>(points_.size()));
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Local& point = points_[i];
    Eigen::VectorXd r = y - point.mean;
    point.covariance.matrixL().solveInPlace(r);
    double value = r.squaredNorm() + point.log_determinant - 2.0 * point.log_certificates;
    if (point.slopes.cols() > 0) {
      const Eigen::VectorXd pull = point.slopes.transpose() * r + point.pull_of_certificates;
      value -= pull.dot(point.bent.solve(pull));
    }
    deviance[i] = value;
  }
  deviance.array() -= deviance.minCoeff();
  return deviance;
}

/// Variance of u under prior x exp(-deviance / 2), both logarithms between points along straight lines; parts apart
/// when asked.
double PathWords::variance(const Eigen::VectorXd& deviance, const Parts& parts, bool within) const {
  constexpr int cells = 12;
  const auto count = static_cast<std::size_t>(std::max(parts.count, 1));
  double highest = least_log_prior;
  for (const Local& point : points_) highest = std::max(highest, point.log_prior);
  std::vector<std::array<double, 3>> sums(within ? count : 1, {0.0, 0.0, 0.0});
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double width = points_[i + 1].u - points_[i].u;
    for (int c = 0; c < cells; ++c) {
      const double share = (c + 0.5) / cells;
      const double prior = points_[i].log_prior + share * (points_[i + 1].log_prior - points_[i].log_prior) - highest;
      const double mass =
          std::exp(prior - 0.5 * (deviance[k] + share * (deviance[k + 1] - deviance[k]))) * width / cells;
      const double u = points_[i].u + share * width;
      auto& sum = sums[within ? parts.of[share < 0.5 ? i : i + 1] : 0];
      sum[0] += mass;
      sum[1] += mass * u;
      sum[2] += mass * u * u;
    }
  }
  double total = 0.0, spread = 0.0;
  for (const auto& sum : sums) {
    if (!(sum[0] > 0.0)) continue;
    total += sum[0];
    spread += std::max(sum[2] - sum[1] * sum[1] / sum[0], 0.0);
  }
  return total > 0.0 ? spread / total : 0.0;
}

std::vector<bool> PathWords::minor_hills(const Eigen::VectorXd& deviance, double drop, double least_mass) const {
  std::vector<bool> begins(points_.size(), false);
  Eigen::VectorXd u(deviance.size()), log_prior(deviance.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    u[i] = points_[i].u;
    log_prior[i] = points_[i].log_prior;
  }
  for (const Hill& hill : find_hills(u, deviance, log_prior)) {
    const double least = deviance[hill.best];
    if (least <= drop || hill.mass < least_mass) continue;
    const auto real = [&](Eigen::Index peak) {
      const bool end = peak == 0 || peak == u.size() - 1;
      return end || std::sqrt(deviance[peak]) - std::sqrt(least) >= 2.0 * points_[peak].doubt;
    };
    if (real(hill.first) && real(hill.last)) begins[hill.best] = true;
  }
  return begins;
}

PathWords::Parts PathWords::parts(const Eigen::VectorXd& deviance, double drop, double least_mass) const {
  Parts found{.count = 0, .of = std::vector<std::size_t>(points_.size(), 0)};
  const std::vector<bool> minor = minor_hills(deviance, drop, least_mass);
  bool real = true;  // what lies between here and the last point inside is more than the surrogate's doubt
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double value = deviance[i];
    if (minor[i]) {
      ++found.count;
    } else if (value <= drop) {
      if (real) ++found.count;
      real = false;
    } else if (std::sqrt(value) - std::sqrt(drop) >= 2.0 * points_[i].doubt) {
      real = true;
    }
    found.of[i] = static_cast<std::size_t>(std::max(found.count - 1, 0));
  }
  return found;
}

WordFacts PathWords::facts(const FoundFacts& found, const PathWords& before, const Eigen::VectorXd& found_deviance,
                           const Eigen::VectorXd& deviance, const VerdictThresholds& thresholds) const {
  const Profile& profile = *found.profile;
  const double drop = profile.drop;
  WordFacts facts = found.facts;
  const Parts now = parts(deviance, drop, thresholds.mode_weight),
              then = before.parts(found_deviance, drop, thresholds.mode_weight);
  facts.parts = now.count;
  facts.open_low = profile.low_pinned || profile.runs_end_low || profile.low_unknown || deviance[0] <= drop;
  facts.open_high =
      profile.high_pinned || profile.runs_end_high || profile.high_unknown || deviance[deviance.size() - 1] <= drop;
  const auto scaled = [&](double contraction, bool within) {
    const double was = before.variance(found_deviance, then, within);
    return was > 0.0 ? 1.0 - (1.0 - contraction) * variance(deviance, now, within) / was : contraction;
  };
  facts.contraction = scaled(found.facts.contraction, false);
  facts.contraction_within = scaled(found.facts.contraction_within, true);
  return facts;
}

std::vector<std::vector<WordProbability>> repeat_words(const CaseModel& model, const std::vector<FoundFacts>& found,
                                                       const Eigen::MatrixXd& draws, const Eigen::VectorXd& best,
                                                       const VerdictThresholds& thresholds,
                                                       const RepeatOptions& options) {
  std::vector<std::vector<WordProbability>> all(found.size());
  if (options.repeats < 1 || model.row_count() > options.rows_max || draws.rows() == 0) return all;
  const Eigen::LLT<Eigen::MatrixXd> spread(predict(model, best).total());
  if (spread.info() != Eigen::Success) return all;
  const Eigen::MatrixXd truths = thinned(draws, options.repeats);
  data::RandomStream random(options.seed, data::Purpose::repeated_data);
  Eigen::MatrixXd repeats(truths.rows(), model.row_count());
  for (Eigen::Index b = 0; b < truths.rows(); ++b) {
    Eigen::VectorXd z(repeats.cols());
    for (double& value : z) value = random.normal();
    repeats.row(b) = (predict(model, truths.row(b).transpose()).mean + spread.matrixL() * z).transpose();
  }
  const Eigen::VectorXd y = observed(model), ones = Eigen::VectorXd::Ones(y.size());
  std::vector<Eigen::Index> rows(static_cast<std::size_t>(y.size()));
  std::iota(rows.begin(), rows.end(), Eigen::Index{0});

  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!found[k].facts.influences) {
      all[k] = {{Verdict::not_identified, 1.0}};
      continue;
    }
    const PathWords words_of(path_points(model, model, *found[k].profile, best), rows, ones);
    if (!words_of.usable()) continue;
    const Eigen::VectorXd before = words_of.deviances(y);
    std::vector<Verdict> words;
    for (Eigen::Index b = 0; b < repeats.rows(); ++b) {
      const WordFacts facts =
          words_of.facts(found[k], words_of, before, words_of.deviances(repeats.row(b).transpose()), thresholds);
      words.push_back(word_of(facts, thresholds));
    }
    all[k] = probabilities_of(words);
  }
  return all;
}

}  // namespace uq
