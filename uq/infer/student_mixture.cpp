#include "uq/infer/student_mixture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "data/log_gamma.hpp"
#include "uq/infer/factor.hpp"

namespace uq {
namespace {

constexpr int degrees_of_freedom = 8;
constexpr double inflation = 1.1;                               // s^2
constexpr double defensive_share = 0.1, defensive_scale = 2.0;  // of the weight; times the sd of all points

/// A Gaussian mixture while it is being fitted.
struct Gaussians {
  Eigen::VectorXd weights;
  std::vector<Eigen::VectorXd> means;
  std::vector<Eigen::MatrixXd> covariances;
  std::vector<Eigen::MatrixXd> factors;
  double mean_log_density = -std::numeric_limits<double>::infinity();
};

/// Squared length of L^-1 (x - mean) for each row x: forward substitution on all points at once, a column at a time.
Eigen::ArrayXd squared_distances(const Eigen::MatrixXd& points, const Eigen::VectorXd& mean,
                                 const Eigen::MatrixXd& factor) {
  const Eigen::Index dimension = points.cols();
  Eigen::ArrayXXd whitened(points.rows(), dimension);
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(points.rows());
  for (Eigen::Index a = 0; a < dimension; ++a) {
    whitened.col(a) = points.col(a).array() - mean[a];
    for (Eigen::Index b = 0; b < a; ++b) whitened.col(a) -= factor(a, b) * whitened.col(b);
    whitened.col(a) *= 1.0 / factor(a, a);
    sum += whitened.col(a).square();
  }
  return sum;
}

/// Log of each component's weighted Gaussian density at each point: points x components.
Eigen::ArrayXXd log_terms(const Gaussians& fit, const Eigen::MatrixXd& points) {
  Eigen::ArrayXXd terms(points.rows(), fit.weights.size());
  const double dimension = static_cast<double>(points.cols());
  for (Eigen::Index k = 0; k < fit.weights.size(); ++k) {
    const auto& factor = fit.factors[k];
    const double constant = std::log(std::max(fit.weights[k], 1e-300)) - factor.diagonal().array().log().sum() -
                            0.5 * dimension * std::log(2.0 * std::numbers::pi);
    terms.col(k) = constant - 0.5 * squared_distances(points, fit.means[k], factor);
  }
  return terms;
}

/// Largest of each row, a column at a time.
Eigen::ArrayXd largest_of_rows(const Eigen::ArrayXXd& terms) {
  Eigen::ArrayXd largest = terms.col(0);
  for (Eigen::Index k = 1; k < terms.cols(); ++k) largest = largest.max(terms.col(k));
  return largest;
}

/// Weighted mean and covariance with responsibilities `share`.
void refit_component(Gaussians& fit, std::size_t k, const Eigen::MatrixXd& points, const Eigen::ArrayXd& share,
                     const Eigen::MatrixXd& pooled) {
  const double total = share.sum();
  fit.weights[k] = total;
  if (total <= 0.0) return;
  const Eigen::Index dimension = points.cols();
  Eigen::ArrayXXd centred(points.rows(), dimension);
  for (Eigen::Index a = 0; a < dimension; ++a) {
    fit.means[k][a] = (points.col(a).array() * share).sum() / total;
    centred.col(a) = points.col(a).array() - fit.means[k][a];
  }
  for (Eigen::Index a = 0; a < dimension; ++a)
    for (Eigen::Index b = 0; b <= a; ++b)
      fit.covariances[k](a, b) = fit.covariances[k](b, a) =
          (share * centred.col(a) * centred.col(b)).sum() / total + 1e-6 * pooled(a, b);
  fit.factors[k] = factor_for_proposal(fit.covariances[k]);
}

/// Component centres apart from each other (k-means++): each point's weight goes to its nearest.
Eigen::ArrayXXd spread_out(const Eigen::MatrixXd& points, const Eigen::VectorXd& weights,
                           const Eigen::MatrixXd& pooled_factor, int count, data::RandomStream& random) {
  // Each new centre is drawn with probability proportional to its squared distance from the nearest one so far.
  const Eigen::Index n = points.rows();
  Eigen::VectorXd distance = Eigen::VectorXd::Ones(n);
  Eigen::ArrayXXd nearest(n, count);
  for (int k = 0; k < count; ++k) {
    const Eigen::VectorXd chance = distance.cwiseProduct(weights);
    double left = random.uniform() * chance.sum();
    Eigen::Index chosen = 0;
    for (; chosen + 1 < n && left > chance[chosen]; ++chosen) left -= chance[chosen];
    nearest.col(k) = squared_distances(points, points.row(chosen).transpose(), pooled_factor);
    distance = k == 0 ? Eigen::VectorXd(nearest.col(0)) : Eigen::VectorXd(distance.array().min(nearest.col(k)));
  }
  Eigen::ArrayXXd share = Eigen::ArrayXXd::Zero(n, count);
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::Index best = 0;
    nearest.row(i).minCoeff(&best);
    share(i, best) = weights[i];
  }
  return share;
}

/// Expectation maximisation from the responsibilities `share` (points x components, summing to the weights).
Gaussians fit_gaussians(const Eigen::MatrixXd& points, const Eigen::VectorXd& weights, const Eigen::MatrixXd& pooled,
                        Eigen::ArrayXXd share, const MixtureOptions& options) {
  const Eigen::Index count = share.cols();
  Gaussians fit{.weights = Eigen::VectorXd::Zero(count), .means = {}, .covariances = {}, .factors = {}};
  fit.means.assign(static_cast<std::size_t>(count), points.transpose() * weights);
  fit.covariances.assign(static_cast<std::size_t>(count), pooled);
  fit.factors.assign(static_cast<std::size_t>(count), factor_for_proposal(pooled));
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    for (Eigen::Index k = 0; k < count; ++k)
      refit_component(fit, static_cast<std::size_t>(k), points, share.col(k), pooled);
    share = log_terms(fit, points);
    const Eigen::ArrayXd largest = largest_of_rows(share);
    Eigen::ArrayXd sums = Eigen::ArrayXd::Zero(points.rows());
    for (Eigen::Index k = 0; k < count; ++k) {
      share.col(k) = (share.col(k) - largest).exp();
      sums += share.col(k);
    }
    const double mean_log_density = weights.dot((sums.log() + largest).matrix());
    sums = weights.array() / sums;
    for (Eigen::Index k = 0; k < count; ++k) share.col(k) *= sums;
    const bool settled = mean_log_density - fit.mean_log_density < options.tolerance;
    fit.mean_log_density = mean_log_density;
    if (settled) break;
  }
  return fit;
}

/// Responsibilities under a mixture that was fitted before (its tails as they are).
Eigen::ArrayXXd responsibilities(const Mixture& before, const Eigen::MatrixXd& points, const Eigen::VectorXd& weights) {
  Eigen::ArrayXXd share = before.log_terms(points).leftCols(before.fitted);
  const Eigen::ArrayXd largest = largest_of_rows(share);
  Eigen::ArrayXd sums = Eigen::ArrayXd::Zero(points.rows());
  for (Eigen::Index k = 0; k < share.cols(); ++k) {
    share.col(k) = (share.col(k) - largest).exp();
    sums += share.col(k);
  }
  for (Eigen::Index k = 0; k < share.cols(); ++k) share.col(k) *= weights.array() / sums;
  return share;
}

/// Divides the weights by their total, and sets the constants of the densities.
void weigh(Mixture& mixture, double total) {
  const double dimension = static_cast<double>(mixture.components.front().mean.size());
  const double constant = data::log_gamma(0.5 * (degrees_of_freedom + dimension)) -
                          data::log_gamma(0.5 * degrees_of_freedom) -
                          0.5 * dimension * std::log(degrees_of_freedom * std::numbers::pi);
  for (auto& component : mixture.components) {
    component.weight /= total;
    component.log_constant = std::log(component.weight) + constant - component.factor.diagonal().array().log().sum();
  }
}

}  // namespace

Eigen::ArrayXXd Mixture::log_terms(const Eigen::MatrixXd& points) const {
  const double exponent = -0.5 * (degrees_of_freedom + static_cast<double>(points.cols()));
  Eigen::ArrayXXd terms(points.rows(), static_cast<Eigen::Index>(components.size()));
  for (std::size_t k = 0; k < components.size(); ++k)
    terms.col(k) =
        components[k].log_constant +
        exponent *
            (1.0 + squared_distances(points, components[k].mean, components[k].factor) / degrees_of_freedom).log();
  return terms;
}

Eigen::VectorXd Mixture::log_densities(const Eigen::MatrixXd& points) const {
  Eigen::ArrayXXd terms = log_terms(points);
  const Eigen::ArrayXd largest = largest_of_rows(terms);
  Eigen::ArrayXd sums = Eigen::ArrayXd::Zero(points.rows());
  for (Eigen::Index k = 0; k < terms.cols(); ++k) sums += (terms.col(k) - largest).exp();
  return (largest + sums.log()).matrix();
}

double Mixture::log_density(const Eigen::VectorXd& x) const { return log_densities(x.transpose())[0]; }

Eigen::VectorXd Mixture::draw(data::RandomStream& random) const {
  double left = random.uniform();
  std::size_t k = 0;
  for (; k + 1 < components.size() && left > components[k].weight; ++k) left -= components[k].weight;
  const auto& component = components[k];
  Eigen::VectorXd normal(component.mean.size());
  for (double& value : normal) value = random.normal();
  // Chi squared with nu = 8 degrees of freedom: -2 times the logarithm of a product of nu/2 = 4 uniforms.
  double product = 1.0;
  for (int i = 0; i < degrees_of_freedom / 2; ++i) product *= random.uniform();
  const double chi_squared = -2.0 * std::log(product);
  return component.mean + component.factor * normal * std::sqrt(degrees_of_freedom / chi_squared);
}

Mixture fit_mixture(const Eigen::MatrixXd& points, const Eigen::VectorXd& weights, data::RandomStream& random,
                    const MixtureOptions& options, const Mixture* before) {
  const Eigen::VectorXd normalised = weights / weights.sum();
  const double dimension = static_cast<double>(points.cols());
  const double effective = 1.0 / normalised.squaredNorm();
  const Eigen::VectorXd mean = points.transpose() * normalised;
  const Eigen::MatrixXd centred = points.rowwise() - mean.transpose();
  const Eigen::MatrixXd pooled = centred.transpose() * (centred.array().colwise() * normalised.array()).matrix();

  const auto numbers_of = [&](int count) {
    return count * (1.0 + dimension + 0.5 * dimension * (dimension + 1.0)) - 1.0;
  };
  const auto criterion_of = [&](const Gaussians& fit, int count) {
    return -2.0 * effective * fit.mean_log_density + numbers_of(count) * std::log(effective);
  };
  Gaussians best;
  double best_criterion = std::numeric_limits<double>::infinity();
  const int known = before ? before->fitted : 0;
  if (known > 0) {
    best = fit_gaussians(points, normalised, pooled, responsibilities(*before, points, normalised), options);
    best_criterion = criterion_of(best, known);
  }
  const Eigen::MatrixXd pooled_factor = factor_for_proposal(pooled);
  for (const int count : {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64}) {
    if (count <= known) continue;
    if (count > options.components_max || (count > 1 && effective < 4.0 * numbers_of(count))) break;
    const Gaussians fit = fit_gaussians(points, normalised, pooled,
                                        spread_out(points, normalised, pooled_factor, count, random), options);
    const double criterion = criterion_of(fit, count);
    const bool better = criterion < best_criterion;
    if (better) {
      best_criterion = criterion;
      best = fit;
    }
    if (known > 0 || (!better && count > 3)) break;
  }

  Mixture mixture;
  for (std::size_t k = 0; k < best.means.size(); ++k) {
    const double weight = best.weights[k];
    if (weight < 1e-6) continue;
    mixture.components.push_back(
        {.weight = weight, .mean = best.means[k], .factor = best.factors[k] * std::sqrt(inflation)});
  }
  double total = 0.0;
  for (const auto& component : mixture.components) total += component.weight;
  mixture.fitted = static_cast<int>(mixture.components.size());
  if (mixture.fitted > 1) {
    mixture.components.push_back({.weight = defensive_share / (1.0 - defensive_share) * total,
                                  .mean = mean,
                                  .factor = pooled_factor * defensive_scale});
    total /= 1.0 - defensive_share;
  }
  weigh(mixture, total);
  return mixture;
}

Mixture with_kept(Mixture mixture, const std::vector<MixtureComponent>& kept) {
  if (kept.empty()) return mixture;
  double share = 0.0;
  for (const auto& component : kept) share += component.weight;
  const double scale = std::min(1.0, 0.5 / share);
  for (auto& component : mixture.components) component.weight *= 1.0 - scale * share;
  for (const auto& component : kept) {
    mixture.components.push_back(component);
    mixture.components.back().weight *= scale;
  }
  weigh(mixture, 1.0);
  return mixture;
}

Mixture with_components(Mixture mixture, const std::vector<MixtureComponent>& added) {
  double share = 0.0;
  for (const auto& component : added) share += component.weight;
  for (auto& component : mixture.components) component.weight *= 1.0 - share;
  mixture.components.insert(mixture.components.begin() + mixture.fitted, added.begin(), added.end());
  mixture.fitted += static_cast<int>(added.size());
  weigh(mixture, 1.0);
  return mixture;
}

}  // namespace uq
