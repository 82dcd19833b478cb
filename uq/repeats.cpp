#include "uq/repeats.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "data/random.hpp"
#include "uq/posterior.hpp"
#include "uq/predictive.hpp"

namespace uq {
namespace {

constexpr double far = 40.0;  // deviance beyond which a path's point plays no part, whatever the noise
constexpr std::array words = {Verdict::identified, Verdict::weakly_identified, Verdict::several_values,
                              Verdict::not_identified};

/// The model about one point of a path.
struct LocalModel {
  double u = 0.0;
  double doubt = 0.0;  ///< of the surrogate, against the best fit, in data errors
  Eigen::VectorXd mean;
  Eigen::LLT<Eigen::MatrixXd> covariance;
  double log_determinant = 0.0;
  Eigen::MatrixXd slopes;            ///< whitened, of the unknowns that can move
  Eigen::LLT<Eigen::MatrixXd> bent;  ///< A' A + P

  double deviance(const Eigen::VectorXd& y) const {
    Eigen::VectorXd r = y - mean;
    covariance.matrixL().solveInPlace(r);
    double value = r.squaredNorm() + log_determinant;
    if (slopes.cols() > 0) {
      const Eigen::VectorXd pull = slopes.transpose() * r;
      value -= pull.dot(bent.solve(pull));
    }
    return value;
  }
};

/// Points of a path that may matter: near enough to the best or beside such a point, and the two ends.
std::vector<LocalModel> local_models(const CaseModel& model, const Profile& profile, const Eigen::VectorXd& best) {
  const Eigen::VectorXd lower = model.lower(), upper = model.upper();
  const Yardstick yardstick = make_yardstick(model, best);
  std::vector<LocalModel> found;
  const Eigen::Index last = profile.u.size() - 1;
  for (Eigen::Index i = 0; i <= last; ++i) {
    const Eigen::Index from = std::max<Eigen::Index>(i - 1, 0), count = std::min(i + 1, last) - from + 1;
    const bool end = i == 0 || i == last;
    if (!end && profile.deviance.segment(from, count).minCoeff() > far) continue;
    const Eigen::VectorXd u = profile.path.row(i).transpose();
    const StackedPrediction prediction = predict(model, u);
    LocalModel local{.u = profile.u[i],
                     .doubt = difference(model, yardstick, u, best).doubt,
                     .mean = prediction.mean,
                     .covariance = {},
                     .slopes = {},
                     .bent = {}};
    local.covariance.compute(prediction.total());
    if (local.covariance.info() != Eigen::Success) continue;
    local.log_determinant = 2.0 * local.covariance.matrixLLT().diagonal().array().log().sum();
    Eigen::MatrixXd slopes = sensitivity(model, u);
    local.covariance.matrixL().solveInPlace(slopes);
    std::vector<Eigen::Index> free;
    for (Eigen::Index s = 0; s < u.size(); ++s) {
      const double slack = 1e-4 * (upper[s] - lower[s]);
      if (s != profile.unknown && u[s] - lower[s] > slack && upper[s] - u[s] > slack) free.push_back(s);
    }
    local.slopes.resize(slopes.rows(), static_cast<Eigen::Index>(free.size()));
    Eigen::MatrixXd precision = Eigen::MatrixXd::Zero(local.slopes.cols(), local.slopes.cols());
    for (std::size_t k = 0; k < free.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      local.slopes.col(column) = slopes.col(free[k]);
      precision(column, column) = 1.0 / std::pow(model.slots[static_cast<std::size_t>(free[k])].prior.sd(), 2);
    }
    local.bent.compute(local.slopes.transpose() * local.slopes + precision);
    if (local.slopes.cols() > 0 && local.bent.info() != Eigen::Success) continue;
    found.push_back(std::move(local));
  }
  return found;
}

/// Variance of u under exp(-deviance / 2), the deviance between points along straight lines; parts apart when asked.
double variance_of(const std::vector<LocalModel>& points, const Eigen::VectorXd& deviance,
                   const std::vector<std::size_t>& part, bool within) {
  constexpr int cells = 12;
  const std::size_t parts = part.empty() ? 1 : *std::max_element(part.begin(), part.end()) + 1;
  std::vector<std::array<double, 3>> sums(within ? parts : 1, {0.0, 0.0, 0.0});
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double width = points[i + 1].u - points[i].u;
    for (int c = 0; c < cells; ++c) {
      const double share = (c + 0.5) / cells;
      const double mass = std::exp(-0.5 * (deviance[k] + share * (deviance[k + 1] - deviance[k]))) * width / cells;
      const double u = points[i].u + share * width;
      auto& sum = sums[within ? part[share < 0.5 ? i : i + 1] : 0];
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

/// Parts of the interval on the points: their number, and for each point the part nearest to it.
struct Parts {
  int count = 0;
  std::vector<std::size_t> of;
};
Parts parts_of(const std::vector<LocalModel>& points, const Eigen::VectorXd& deviance, double drop) {
  Parts found{.count = 0, .of = std::vector<std::size_t>(points.size(), 0)};
  bool real = true;  // what lies between here and the last point inside is more than the surrogate's doubt
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double value = deviance[static_cast<Eigen::Index>(i)];
    if (value <= drop) {
      if (real) ++found.count;
      real = false;
    } else if (std::sqrt(value) - std::sqrt(drop) >= 2.0 * points[i].doubt) {
      real = true;
    }
    found.of[i] = static_cast<std::size_t>(std::max(found.count - 1, 0));
  }
  return found;
}

WordFacts facts_of(const FoundFacts& found, const std::vector<LocalModel>& points, const Eigen::VectorXd& deviance,
                   std::pair<double, double> variances, double drop) {
  const Profile& profile = *found.profile;
  WordFacts facts = found.facts;
  const Parts parts = parts_of(points, deviance, drop);
  facts.parts = parts.count;
  facts.open_low = profile.low_pinned || deviance[0] <= drop;
  facts.open_high = profile.high_pinned || deviance[deviance.size() - 1] <= drop;
  const auto scaled = [&](double contraction, bool within, double before) {
    const double now = variance_of(points, deviance, parts.of, within);
    return before > 0.0 ? 1.0 - (1.0 - contraction) * now / before : contraction;
  };
  facts.contraction = scaled(found.facts.contraction, false, variances.first);
  facts.contraction_within = scaled(found.facts.contraction_within, true, variances.second);
  return facts;
}

}  // namespace

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
  const Eigen::VectorXd y = observed(model);

  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!found[k].facts.influences) {
      all[k] = {{to_text(Verdict::not_identified), 1.0}};
      continue;
    }
    const std::vector<LocalModel> points = local_models(model, *found[k].profile, best);
    if (points.size() < 3) continue;
    const auto deviances = [&](const Eigen::VectorXd& data) {
      Eigen::VectorXd deviance(static_cast<Eigen::Index>(points.size()));
      for (std::size_t i = 0; i < points.size(); ++i) deviance[static_cast<Eigen::Index>(i)] = points[i].deviance(data);
      deviance.array() -= deviance.minCoeff();
      return deviance;
    };
    const Eigen::VectorXd before = deviances(y);
    const Parts parts = parts_of(points, before, thresholds.profile_drop);
    const std::pair variances{variance_of(points, before, parts.of, false),
                              variance_of(points, before, parts.of, true)};
    std::array<int, words.size()> counts = {};
    for (Eigen::Index b = 0; b < repeats.rows(); ++b) {
      const WordFacts facts =
          facts_of(found[k], points, deviances(repeats.row(b).transpose()), variances, thresholds.profile_drop);
      const Verdict word = word_of(facts, thresholds);
      for (std::size_t w = 0; w < words.size(); ++w) counts[w] += words[w] == word ? 1 : 0;
    }
    for (std::size_t w = 0; w < words.size(); ++w)
      if (counts[w] > 0) all[k].push_back({to_text(words[w]), counts[w] / static_cast<double>(repeats.rows())});
    std::stable_sort(all[k].begin(), all[k].end(),
                     [](const auto& a, const auto& b) { return a.probability > b.probability; });
  }
  return all;
}

}  // namespace uq
