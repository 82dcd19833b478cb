#include "uq/traded.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace uq {
namespace {

/// Value of own parameter k at u, in the study's unit.
double shown(const CaseModel& model, int k, double u) {
  const data::Parameter& parameter = model.slots[static_cast<std::size_t>(k)].prior.parameter();
  return parameter.unit.from_si(from_scaled(parameter, u));
}

double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::ArrayXd x = a.array() - a.mean(), y = b.array() - b.mean();
  return (x * y).sum() / std::sqrt(x.square().sum() * y.square().sum());
}

/// Direction (p, q) in which the two columns vary least, from a plain eigen-decomposition: total least squares.
Eigen::Vector2d least_varying(const Eigen::MatrixXd& points) {
  const Eigen::MatrixXd centred = points.rowwise() - points.colwise().mean();
  const Eigen::Matrix2d scatter = centred.transpose() * centred;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(scatter);
  return solver.eigenvectors().col(0);
}

/// "^0.9", nothing for 1.
std::string power(double exponent) {
  std::string text = fmt::format("{:.2f}", exponent);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "1" ? "" : "^" + text;
}

/// a * b^q, with the smaller exponent taken as one.
std::string power_text(const std::string& first, const std::string& second, double q) {
  const bool flip = std::abs(q) < 0.667;
  const double exponent = flip ? 1.0 / q : q;
  const std::string& plain = flip ? second : first;
  const std::string& raised = flip ? first : second;
  return fmt::format("{} {} {}{}", plain, q > 0.0 ? "*" : "/", raised, power(std::abs(exponent)));
}

/// The points of the profile paths where the deviance is at most `drop`.
Eigen::MatrixXd ridge_points(const std::vector<const Profile*>& profiles, double drop) {
  std::vector<Eigen::VectorXd> kept;
  for (const auto* profile : profiles)
    for (Eigen::Index i = 0; i < profile->u.size(); ++i)
      if (profile->deviance[i] <= drop) kept.emplace_back(profile->path.row(i).transpose());
  Eigen::MatrixXd points(static_cast<Eigen::Index>(kept.size()), kept.empty() ? 0 : kept.front().size());
  for (std::size_t i = 0; i < kept.size(); ++i) points.row(static_cast<Eigen::Index>(i)) = kept[i].transpose();
  return points;
}

}  // namespace

namespace {

/// A ridge whose rms distance from the best form is more than this share of its extent is bent.
constexpr double bent_share = 0.05;

Combination best_form(const std::string& first, const std::string& second, const Eigen::MatrixXd& points,
                      const Eigen::Vector2d& ranges) {
  // Linear, in scaled coordinates, then in the study's units.
  const Eigen::MatrixXd scaled = points.array().rowwise() / ranges.transpose().array();
  const Eigen::Vector2d normal = least_varying(scaled);
  const Eigen::MatrixXd centred = scaled.rowwise() - scaled.colwise().mean();
  Combination linear{.text = {},
                     .power_law = false,
                     .coefficient = 0.0,
                     .misfit = (centred * normal).norm() / std::sqrt(static_cast<double>(points.rows()))};
  linear.coefficient = normal[1] / ranges[1] / (normal[0] / ranges[0]);
  linear.text = fmt::format("{} {} {:.3g} * {}", first, linear.coefficient < 0.0 ? "-" : "+",
                            std::abs(linear.coefficient), second);

  // Power law, where the values are positive and clear of zero.
  std::vector<Eigen::Index> positive;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (points(i, 0) > 1e-3 * ranges[0] && points(i, 1) > 1e-3 * ranges[1]) positive.push_back(i);
  if (positive.size() < 5 || positive.size() < static_cast<std::size_t>(points.rows()) * 2 / 3) return linear;
  Eigen::MatrixXd logs(static_cast<Eigen::Index>(positive.size()), 2);
  for (std::size_t i = 0; i < positive.size(); ++i)
    logs.row(static_cast<Eigen::Index>(i)) = points.row(positive[i]).array().log();
  const Eigen::Vector2d exponents = least_varying(logs);
  if (std::abs(exponents[0]) < 1e-3 || std::abs(exponents[1]) < 1e-3) return linear;
  // Distance from the law in scaled coordinates, first order: constant of the law over its gradient there.
  double sum = 0.0;
  const double level = (logs * exponents).mean();
  for (Eigen::Index i = 0; i < logs.rows(); ++i) {
    const Eigen::Vector2d values = logs.row(i).transpose().array().exp();
    const Eigen::Vector2d gradient = (exponents.array() * ranges.array() / values.array()).matrix();
    sum += std::pow((logs.row(i).dot(exponents) - level) / gradient.norm(), 2);
  }
  Combination law{.text = {},
                  .power_law = true,
                  .coefficient = exponents[1] / exponents[0],
                  .misfit = std::sqrt(sum / static_cast<double>(logs.rows()))};
  law.text = power_text(first, second, law.coefficient);
  return law.misfit <= linear.misfit ? law : linear;
}

}  // namespace

/// The best form, or, where the ridge bends away from it, only that there is a relation.
Combination find_combination(const std::string& first, const std::string& second, const Eigen::MatrixXd& points,
                             const Eigen::Vector2d& ranges) {
  Combination best = best_form(first, second, points, ranges);
  const Eigen::MatrixXd scaled = points.array().rowwise() / ranges.transpose().array();
  const double extent = (scaled.colwise().maxCoeff() - scaled.colwise().minCoeff()).norm();
  if (best.misfit > bent_share * extent) {
    best.text = fmt::format("a curved relation of {} and {}", first, second);
    best.coefficient = std::numeric_limits<double>::quiet_NaN();
  }
  return best;
}

namespace {

/// Square root of the share of y's variance that lies between bins of x of equal numbers of draws: |correlation| for a
/// straight relation, and as large for a bent one (K. Pearson's correlation ratio, 1905).
double correlation_ratio(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  constexpr Eigen::Index bins = 20;
  const Eigen::Index n = x.size();
  if (n < 10 * bins) return 0.0;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return x[a] < x[b]; });
  const double mean = y.mean();
  double between = 0.0;
  for (Eigen::Index bin = 0; bin < bins; ++bin) {
    const Eigen::Index begin = bin * n / bins, end = (bin + 1) * n / bins;
    double sum = 0.0;
    for (Eigen::Index i = begin; i < end; ++i) sum += y[order[static_cast<std::size_t>(i)]] - mean;
    between += sum * sum / static_cast<double>(end - begin);
  }
  return std::sqrt(between / (y.array() - mean).square().sum());
}

}  // namespace

std::vector<TradedPair> find_traded_pairs(const CaseModel& model, const Eigen::MatrixXd& draws,
                                          const std::vector<Profile>& profiles, const std::vector<bool>& identified,
                                          const VerdictThresholds& thresholds) {
  std::vector<TradedPair> pairs;
  const int own = model.own_count();
  for (int a = 0; a < own; ++a)
    for (int b = a + 1; b < own; ++b) {
      if (identified[static_cast<std::size_t>(a)] && identified[static_cast<std::size_t>(b)]) continue;
      // Correlation, plain or of logarithms.
      Eigen::VectorXd first(draws.rows()), second(draws.rows());
      for (Eigen::Index i = 0; i < draws.rows(); ++i) {
        first[i] = shown(model, a, draws(i, a));
        second[i] = shown(model, b, draws(i, b));
      }
      double strongest = correlation(first, second);
      if (first.minCoeff() > 0.0 && second.minCoeff() > 0.0) {
        const double of_logs = correlation(first.array().log(), second.array().log());
        if (std::abs(of_logs) > std::abs(strongest)) strongest = of_logs;
      }
      const double bent = std::max(correlation_ratio(first, second), correlation_ratio(second, first));
      if (!(std::max(std::abs(strongest), bent) >= thresholds.traded_correlation)) continue;

      const std::vector<const Profile*> both = {&profiles[static_cast<std::size_t>(a)],
                                                &profiles[static_cast<std::size_t>(b)]};
      const Eigen::MatrixXd path = ridge_points(both, thresholds.profile_drop);
      if (path.rows() < 4) continue;
      Eigen::MatrixXd values(path.rows(), 2);
      for (Eigen::Index i = 0; i < path.rows(); ++i)
        values.row(i) << shown(model, a, path(i, a)), shown(model, b, path(i, b));
      const data::Parameter& pa = model.slots[static_cast<std::size_t>(a)].prior.parameter();
      const data::Parameter& pb = model.slots[static_cast<std::size_t>(b)].prior.parameter();
      const Eigen::Vector2d ranges(pa.unit.from_si(pa.high) - pa.unit.from_si(pa.low),
                                   pb.unit.from_si(pb.high) - pb.unit.from_si(pb.low));
      TradedPair pair{.first = pa.name,
                      .second = pb.name,
                      .combination = find_combination(pa.name, pb.name, values, ranges).text,
                      .correlation = strongest,
                      .equivalent = {},
                      .equivalent_u = {},
                      .curves = {}};

      // Equivalent points: five along the parameter whose interval spans more, nearly as good as the best.
      auto span = [&](const Profile& profile, double drop) {
        double low = 2.0, high = -1.0;
        for (Eigen::Index i = 0; i < profile.u.size(); ++i)
          if (profile.deviance[i] <= drop) {
            low = std::min(low, profile.u[i]);
            high = std::max(high, profile.u[i]);
          }
        return std::pair{low, high};
      };
      const double near_best = 1.0;
      const auto [a_low, a_high] = span(*both[0], near_best);
      const auto [b_low, b_high] = span(*both[1], near_best);
      const Profile& along = a_high - a_low >= b_high - b_low ? *both[0] : *both[1];
      const auto [low, high] = span(along, near_best);
      std::vector<Eigen::Index> chosen;
      for (int step = 0; step < 5; ++step) {
        const double wanted = low + (high - low) * step / 4.0;
        Eigen::Index nearest = 0;
        double distance = 2.0;
        for (Eigen::Index i = 0; i < along.u.size(); ++i)
          if (along.deviance[i] <= near_best && std::abs(along.u[i] - wanted) < distance) {
            distance = std::abs(along.u[i] - wanted);
            nearest = i;
          }
        // Where the ridge is broken, several wanted values have the same neighbour.
        const bool taken = std::any_of(chosen.begin(), chosen.end(), [&](Eigen::Index other) {
          return std::abs(along.u[other] - along.u[nearest]) < 0.1 * (high - low);
        });
        if (!taken) chosen.push_back(nearest);
      }
      for (const Eigen::Index i : chosen) {
        std::map<std::string, double> point;
        for (int k = 0; k < own; ++k)
          point[model.slots[static_cast<std::size_t>(k)].label] = shown(model, k, along.path(i, k));
        pair.equivalent.push_back(std::move(point));
        const Eigen::VectorXd u = along.path.row(i).transpose();
        pair.equivalent_u.emplace_back(u.begin(), u.end());
      }
      pairs.push_back(std::move(pair));
    }
  return pairs;
}

}  // namespace uq
