#include "surrogate/two_level.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "data/error.hpp"
#include "surrogate/mixture.hpp"
#include "surrogate/two_level_likelihood.hpp"

namespace surrogate {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd discrepancy_correlations(const GaussianProcess& low, const MatrixXd& a, const MatrixXd& b,
                                  double length_factor) {
  const VectorXd lengths = length_factor * low.hyper_parameters().length_scales.cwiseMin(longest_discrepancy);
  MatrixXd square = MatrixXd::Zero(a.rows(), b.rows()), value(a.rows(), b.rows());
  for (Index j = 0; j < b.rows(); ++j)
    for (Index k = 0; k < a.cols(); ++k) square.col(j).array() += ((a.col(k).array() - b(j, k)) / lengths[k]).square();
  correlate(low.kernel(), {{square.data(), square.size()}, {value.data(), value.size()}, {nullptr, 0}});
  return value;
}

HighFit fit_high(const GaussianProcess& low, const Prediction& low_at_high, const TrainingSet& high, MeanBasis mean,
                 const TwoLevelParameters& p) {
  const Index n = high.y.size();
  const MatrixXd basis = MatrixXd::Ones(n, basis_size(mean, 0));
  MatrixXd covariance =
      p.rho * p.rho * low_at_high.covariance +
      p.discrepancy_sd * p.discrepancy_sd * discrepancy_correlations(low, high.x, high.x, p.length_factor);
  covariance.diagonal() += high.noise_variance;
  covariance.diagonal().array() += p.nugget_sd * p.nugget_sd;
  HighFit result;
  const double size = covariance.diagonal().mean();
  Eigen::LLT<MatrixXd> factor(covariance);
  for (double more = 1e-12; factor.info() != Eigen::Success && more < 1e-5; more *= 30.0) {
    result.jitter += more;
    covariance.diagonal().array() += more * size;
    factor.compute(covariance);
  }
  if (factor.info() != Eigen::Success) return result;
  result.factor = factor.matrixL();
  const VectorXd residual = high.y - p.rho * low_at_high.mean;
  VectorXd whitened = result.factor.triangularView<Eigen::Lower>().solve(residual);
  result.whitened_basis = result.factor.triangularView<Eigen::Lower>().solve(basis);
  double log_determinant = 2.0 * result.factor.diagonal().array().log().sum();
  result.coefficients.resize(basis.cols());
  result.basis_factor.resize(basis.cols(), basis.cols());
  if (basis.cols() == 1) {
    const double square = result.whitened_basis.squaredNorm();
    result.basis_factor(0, 0) = 1.0 / std::sqrt(square);
    result.coefficients[0] = result.whitened_basis.col(0).dot(whitened) / square;
    whitened -= result.whitened_basis.col(0) * result.coefficients[0];
    log_determinant += std::log(square);
  }
  result.weights = result.factor.transpose().triangularView<Eigen::Upper>().solve(whitened);
  result.log_likelihood = -0.5 * whitened.squaredNorm() - 0.5 * log_determinant -
                          0.5 * static_cast<double>(n - basis.cols()) * std::log(2.0 * std::numbers::pi);
  result.ok = std::isfinite(result.log_likelihood);
  return result;
}

TwoLevelProcess::TwoLevelProcess(GaussianProcess low, HighLevel high) : low_(std::move(low)), high_(std::move(high)) {
  const Prediction low_at_high = low_.predict(high_.runs.x);
  for (const TwoLevelParameters& setting : high_.settings) {
    HighFit fitted = fit_high(low_, low_at_high, high_.runs, high_.discrepancy_mean, setting);
    if (!fitted.ok)
      throw data::InputError(
          data::ExitStatus::bad_data,
          {"two-level surrogate", "the covariance of the high-level runs cannot be factorised even with jitter",
           "give the runs their standard errors"});
    high_.diagnostics.jitter = std::max(high_.diagnostics.jitter, fitted.jitter);
    parts_.push_back({std::move(fitted.factor), std::move(fitted.whitened_basis), std::move(fitted.basis_factor),
                      std::move(fitted.weights), std::move(fitted.coefficients)});
  }
}

double TwoLevelProcess::mean_rho() const {
  double sum = 0.0;
  for (const TwoLevelParameters& setting : high_.settings) sum += setting.weight * setting.rho;
  return sum;
}

/// From the low level's joint prediction at the high runs and, below them, the points.
Prediction TwoLevelProcess::at_high(const Prediction& low, const MatrixXd& points) const {
  const Index n = high_.runs.y.size(), m = points.rows();
  Mixture mixture;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const TwoLevelParameters& p = high_.settings[i];
    const Part& part = parts_[i];
    const double rho2 = p.rho * p.rho, s2 = p.discrepancy_sd * p.discrepancy_sd;
    const MatrixXd cross = rho2 * low.covariance.topRightCorner(n, m) +
                           s2 * discrepancy_correlations(low_, high_.runs.x, points, p.length_factor);
    const MatrixXd whitened = part.factor.triangularView<Eigen::Lower>().solve(cross);
    Prediction result;
    result.mean = p.rho * low.mean.tail(m) + cross.transpose() * part.weights;
    result.covariance = rho2 * low.covariance.bottomRightCorner(m, m) +
                        s2 * discrepancy_correlations(low_, points, points, p.length_factor) -
                        whitened.transpose() * whitened;
    if (part.coefficients.size() == 1) {
      result.mean.array() += part.coefficients[0];
      const MatrixXd unknown = part.basis_factor * (MatrixXd::Ones(1, m) - part.whitened_basis.transpose() * whitened);
      result.covariance += unknown.transpose() * unknown;
    }
    result.covariance.diagonal() = result.covariance.diagonal().cwiseMax(0.0);
    if (parts_.size() == 1) return result;
    mixture.add(p.weight, result);
  }
  return mixture.result();
}

Prediction TwoLevelProcess::predict(const MatrixXd& points) const {
  MatrixXd both(high_.runs.x.rows() + points.rows(), points.cols());
  both << high_.runs.x, points;
  return at_high(low_.predict(both), points);
}

std::vector<Prediction> TwoLevelProcess::predict_batch(const MatrixXd& points, int group) const {
  const Index n = high_.runs.x.rows(), groups = points.rows() / group;
  MatrixXd both(groups * (n + group), points.cols());
  for (Index g = 0; g < groups; ++g)
    both.middleRows(g * (n + group), n + group) << high_.runs.x, points.middleRows(g * group, group);
  std::vector<Prediction> results = low_.predict_batch(both, static_cast<int>(n) + group);
  for (Index g = 0; g < groups; ++g) results[g] = at_high(results[g], points.middleRows(g * group, group));
  return results;
}

PredictionGradient TwoLevelProcess::predict_with_gradient(const MatrixXd& points,
                                                          std::span<const int> coordinates) const {
  constexpr double step = 1e-4;
  PredictionGradient result;
  result.value = predict(points);
  for (const int k : coordinates) {
    MatrixXd up = points, down = points;
    up.col(k).array() += step;
    down.col(k).array() -= step;
    const Prediction above = predict(up), below = predict(down);
    result.mean_gradient.push_back((above.mean - below.mean) / (2.0 * step));
    result.covariance_gradient.push_back((above.covariance - below.covariance) / (2.0 * step));
  }
  return result;
}

}  // namespace surrogate
