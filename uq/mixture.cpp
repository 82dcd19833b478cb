#include "uq/mixture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace uq {
namespace {

constexpr int degrees_of_freedom = 8;
constexpr double inflation = 1.1;  // s^2

/// A Gaussian mixture while it is being fitted.
struct Gaussians {
  Eigen::VectorXd weights;
  std::vector<Eigen::VectorXd> means;
  std::vector<Eigen::MatrixXd> covariances;
  std::vector<Eigen::MatrixXd> factors;
  double mean_log_density = -std::numeric_limits<double>::infinity();
};

/// Cholesky factor, with a ridge that grows until there is one.
Eigen::MatrixXd factor_of(Eigen::MatrixXd covariance) {
  const Eigen::VectorXd diagonal = covariance.diagonal().cwiseMax(1e-300);
  for (double ridge = 1e-10; ridge < 1.0; ridge *= 10.0) {
    const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
    if (llt.info() == Eigen::Success && llt.matrixLLT().diagonal().minCoeff() > 0.0) return llt.matrixL();
    covariance.diagonal() += ridge * diagonal;
  }
  return diagonal.cwiseSqrt().asDiagonal();
}

/// Log of each component's weighted Gaussian density at each point: points x components.
Eigen::MatrixXd log_terms(const Gaussians& fit, const Eigen::MatrixXd& points) {
  Eigen::MatrixXd terms(points.rows(), fit.weights.size());
  const double dimension = static_cast<double>(points.cols());
  for (Eigen::Index k = 0; k < fit.weights.size(); ++k) {
    const auto& factor = fit.factors[static_cast<std::size_t>(k)];
    Eigen::MatrixXd whitened = (points.rowwise() - fit.means[static_cast<std::size_t>(k)].transpose()).transpose();
    factor.triangularView<Eigen::Lower>().solveInPlace(whitened);
    const double constant = std::log(std::max(fit.weights[k], 1e-300)) - factor.diagonal().array().log().sum() -
                            0.5 * dimension * std::log(2.0 * std::numbers::pi);
    terms.col(k) = constant - 0.5 * whitened.colwise().squaredNorm().transpose().array();
  }
  return terms;
}

/// Weighted mean and covariance with responsibilities `share`.
void refit_component(Gaussians& fit, std::size_t k, const Eigen::MatrixXd& points, const Eigen::VectorXd& share,
                     const Eigen::MatrixXd& pooled) {
  const double total = share.sum();
  fit.weights[static_cast<Eigen::Index>(k)] = total;
  if (total <= 0.0) return;
  fit.means[k] = points.transpose() * share / total;
  const Eigen::MatrixXd centred = points.rowwise() - fit.means[k].transpose();
  fit.covariances[k] =
      centred.transpose() * (centred.array().colwise() * share.array()).matrix() / total + 1e-6 * pooled;
  fit.factors[k] = factor_of(fit.covariances[k]);
}

/// Component centres apart from each other (k-means++), then expectation maximisation.
Gaussians maximise(const Eigen::MatrixXd& points, const Eigen::VectorXd& weights, const Eigen::MatrixXd& pooled,
                   int count, data::RandomStream& random, const MixtureOptions& options) {
  const Eigen::Index n = points.rows();
  const Eigen::MatrixXd pooled_factor = factor_of(pooled);
  Eigen::MatrixXd whitened = points.transpose();
  pooled_factor.triangularView<Eigen::Lower>().solveInPlace(whitened);

  // Each new centre is drawn with probability proportional to its squared distance from the nearest one so far.
  Eigen::VectorXd distance = Eigen::VectorXd::Ones(n);
  Eigen::MatrixXd share = Eigen::MatrixXd::Zero(n, count);
  Eigen::MatrixXd nearest = Eigen::MatrixXd::Zero(n, count);
  for (int k = 0; k < count; ++k) {
    const Eigen::VectorXd chance = distance.cwiseProduct(weights);
    double left = random.uniform() * chance.sum();
    Eigen::Index chosen = 0;
    for (; chosen + 1 < n && left > chance[chosen]; ++chosen) left -= chance[chosen];
    nearest.col(k) = (whitened.colwise() - whitened.col(chosen)).colwise().squaredNorm().transpose();
    distance = k == 0 ? Eigen::VectorXd(nearest.col(0)) : Eigen::VectorXd(distance.cwiseMin(nearest.col(k)));
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::Index best = 0;
    nearest.row(i).minCoeff(&best);
    share(i, best) = weights[i];
  }

  Gaussians fit{.weights = Eigen::VectorXd::Zero(count), .means = {}, .covariances = {}, .factors = {}};
  fit.means.assign(static_cast<std::size_t>(count), points.transpose() * weights);
  fit.covariances.assign(static_cast<std::size_t>(count), pooled);
  fit.factors.assign(static_cast<std::size_t>(count), pooled_factor);
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    for (int k = 0; k < count; ++k) refit_component(fit, static_cast<std::size_t>(k), points, share.col(k), pooled);
    const Eigen::MatrixXd terms = log_terms(fit, points);
    const Eigen::VectorXd largest = terms.rowwise().maxCoeff();
    const Eigen::MatrixXd ratio = (terms.colwise() - largest).array().exp();
    const Eigen::VectorXd sums = ratio.rowwise().sum();
    const double mean_log_density = weights.dot((sums.array().log() + largest.array()).matrix());
    share = ratio.array().colwise() * (weights.array() / sums.array());
    const bool settled = mean_log_density - fit.mean_log_density < options.tolerance;
    fit.mean_log_density = mean_log_density;
    if (settled) break;
  }
  return fit;
}

}  // namespace

double Mixture::log_density(const Eigen::VectorXd& x) const {
  const double exponent = -0.5 * (degrees_of_freedom + static_cast<double>(x.size()));
  double largest = -std::numeric_limits<double>::infinity();
  std::array<double, 64> terms{};
  for (std::size_t k = 0; k < components.size(); ++k) {
    Eigen::VectorXd whitened = x - components[k].mean;
    components[k].factor.triangularView<Eigen::Lower>().solveInPlace(whitened);
    terms[k] = components[k].log_constant + exponent * std::log1p(whitened.squaredNorm() / degrees_of_freedom);
    largest = std::max(largest, terms[k]);
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < components.size(); ++k) sum += std::exp(terms[k] - largest);
  return largest + std::log(sum);
}

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
                    const MixtureOptions& options) {
  const Eigen::VectorXd normalised = weights / weights.sum();
  const double dimension = static_cast<double>(points.cols());
  const double effective = 1.0 / normalised.squaredNorm();
  const Eigen::VectorXd mean = points.transpose() * normalised;
  const Eigen::MatrixXd centred = points.rowwise() - mean.transpose();
  const Eigen::MatrixXd pooled = centred.transpose() * (centred.array().colwise() * normalised.array()).matrix();

  Gaussians best;
  double best_criterion = std::numeric_limits<double>::infinity();
  for (const int count : {1, 2, 3, 4, 6, 8, 12, 16, 24, 32}) {
    const double numbers = count * (1.0 + dimension + 0.5 * dimension * (dimension + 1.0)) - 1.0;
    if (count > options.components_max || (count > 1 && effective < 4.0 * numbers)) break;
    const Gaussians fit = maximise(points, normalised, pooled, count, random, options);
    const double criterion = -2.0 * effective * fit.mean_log_density + numbers * std::log(effective);
    if (criterion < best_criterion) {
      best_criterion = criterion;
      best = fit;
    } else if (count > 3) {
      break;
    }
  }

  Mixture mixture;
  for (std::size_t k = 0; k < best.means.size(); ++k) {
    const double weight = best.weights[static_cast<Eigen::Index>(k)];
    if (weight < 1e-6) continue;
    mixture.components.push_back(
        {.weight = weight, .mean = best.means[k], .factor = best.factors[k] * std::sqrt(inflation)});
  }
  double total = 0.0;
  for (const auto& component : mixture.components) total += component.weight;
  const double constant = std::lgamma(0.5 * (degrees_of_freedom + dimension)) - std::lgamma(0.5 * degrees_of_freedom) -
                          0.5 * dimension * std::log(degrees_of_freedom * std::numbers::pi);
  for (auto& component : mixture.components) {
    component.weight /= total;
    component.log_constant = std::log(component.weight) + constant - component.factor.diagonal().array().log().sum();
  }
  return mixture;
}

}  // namespace uq
