#include "surrogate/likelihood.hpp"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <numbers>

#include "surrogate/dense.hpp"

namespace surrogate {
namespace {

/// The generalised least-squares part that a factorisation gives: beta, a = P m, and log likelihood without E.
struct MeanFit {
  bool ok = false;
  Eigen::MatrixXd whitened_basis, basis_factor;
  Eigen::VectorXd coefficients, weights;
  double log_likelihood = 0.0;
};

MeanFit fit_mean(const Eigen::MatrixXd& inverse_factor, const Eigen::MatrixXd& basis, const Eigen::VectorXd& precision,
                 const Eigen::VectorXd& m) {
  const Eigen::Index n = m.size(), p = basis.cols();
  MeanFit fit;
  Eigen::VectorXd whitened = inverse_factor.triangularView<Eigen::Lower>() * m;
  double log_determinant = -2.0 * inverse_factor.diagonal().array().log().sum(), shrinkage = 0.0;
  Eigen::Index flat = p;
  if (p > 0) {
    fit.whitened_basis = inverse_factor.triangularView<Eigen::Lower>() * basis;
    fit.basis_factor = Eigen::MatrixXd::Zero(p, p);
    fit.basis_factor.selfadjointView<Eigen::Lower>().rankUpdate(fit.whitened_basis.transpose());
    fit.basis_factor.diagonal() += precision;
    if (!cholesky_in_place(fit.basis_factor)) return fit;
    log_determinant += 2.0 * fit.basis_factor.diagonal().array().log().sum();
    invert_lower_in_place(fit.basis_factor);
    fit.basis_factor.triangularView<Eigen::StrictlyUpper>().setZero();
    const Eigen::VectorXd projected = fit.basis_factor * (fit.whitened_basis.transpose() * whitened);
    fit.coefficients = fit.basis_factor.transpose() * projected;
    whitened -= fit.whitened_basis * fit.coefficients;
    shrinkage = fit.coefficients.cwiseAbs2().dot(precision);
    for (const double one : precision)
      if (one > 0.0) {
        log_determinant -= std::log(one);
        --flat;
      }
  } else {
    fit.whitened_basis.resize(n, 0);
    fit.basis_factor.resize(0, 0);
    fit.coefficients.resize(0);
  }
  fit.weights = inverse_factor.transpose().triangularView<Eigen::Upper>() * whitened;
  fit.log_likelihood = -0.5 * (whitened.squaredNorm() + shrinkage) - 0.5 * log_determinant -
                       0.5 * static_cast<double>(n - flat) * std::log(2.0 * std::numbers::pi);
  fit.ok = std::isfinite(fit.log_likelihood);
  return fit;
}

}  // namespace

Eigen::VectorXd to_logs(const ScaledParameters& parameters, bool nugget) {
  const Eigen::Index d = parameters.length_scales.size();
  Eigen::VectorXd u(d + (nugget ? 2 : 1));
  u.head(d) = parameters.length_scales.array().log();
  u[d] = std::log(parameters.signal_variance);
  if (nugget) u[d + 1] = std::log(parameters.nugget_variance);
  return u;
}

ScaledParameters from_logs(const Eigen::VectorXd& u, bool nugget) {
  const Eigen::Index d = u.size() - (nugget ? 2 : 1);
  return {u.head(d).array().exp(), std::exp(u[d]), nugget ? std::exp(u[d + 1]) : 0.0};
}

Likelihood::Likelihood(const Standardised& data, Kernel kernel, MeanBasis mean, bool nugget)
    : data_(data),
      kernel_(kernel),
      mean_(mean),
      nugget_(nugget),
      basis_(basis_matrix(mean, data.points)),
      precision_(basis_precision(mean, static_cast<int>(data.points.cols()))) {
  const Eigen::Index n = data_.points.rows();
  matrix_.resize(n, n);
  square_.resize(n);
}

/// Jitter that is tried, of the mean diagonal.
constexpr std::array jitters = {0.0, 1e-12, 3e-11, 9e-10, 2.7e-8, 8.1e-7};

/// K into matrix_ and its Cholesky factor over it; s^2 f into slope_ where wanted. Takes the least of `jitters` with
/// which the factorisation succeeds.
bool Likelihood::build(const ScaledParameters& parameters, const Eigen::VectorXd& variance, bool slopes) {
  const Eigen::Index n = data_.points.rows(), d = data_.points.cols();
  scaled_.noalias() = data_.points * parameters.length_scales.cwiseInverse().asDiagonal();
  if (slopes) slope_.resize(n, n);
  const double s2 = parameters.signal_variance;
  for (const double jitter : jitters) {
    jitter_ = jitter == 0.0 ? 0.0 : jitter * (s2 + variance.mean());
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::Index length = n - j;
      Eigen::Map<Eigen::ArrayXd> square(square_.data(), length);
      square.setZero();
      for (Eigen::Index k = 0; k < d; ++k) square += (scaled_.col(k).tail(length).array() - scaled_(j, k)).square();
      Eigen::Map<Eigen::ArrayXd> value(&matrix_(j, j), length);
      Eigen::Map<Eigen::ArrayXd> slope(slopes ? &slope_(j, j) : nullptr, slopes ? length : 0);
      correlate(kernel_, {square, value, slope});
      value *= s2;
      slope *= s2;
      value[0] = s2 + variance[j] + jitter_;
    }
    if (cholesky_in_place(matrix_)) return true;
  }
  return false;
}

Factorised Likelihood::factorise(const ScaledParameters& parameters) {
  Factorised result;
  result.pooled = pool(data_, parameters.nugget_variance);
  if (!build(parameters, result.pooled.variance, false)) return result;
  result.jitter = jitter_;
  result.inverse_factor = matrix_.triangularView<Eigen::Lower>();
  invert_lower_in_place(result.inverse_factor);
  complete(result);
  return result;
}

/// Fills all that follows from the inverse factor and the pooled data.
void Likelihood::complete(Factorised& result) const {
  MeanFit mean = fit_mean(result.inverse_factor, basis_, precision_, result.pooled.mean);
  result.ok = mean.ok;
  result.log_likelihood = mean.log_likelihood + result.pooled.log_likelihood;
  result.residual_weights = std::move(mean.weights);
  result.mean_coefficients = std::move(mean.coefficients);
  result.whitened_basis = std::move(mean.whitened_basis);
  result.basis_factor = std::move(mean.basis_factor);
}

LikelihoodGradient Likelihood::evaluate(const Eigen::VectorXd& u) {
  const ScaledParameters parameters = from_logs(u, nugget_);
  const Eigen::Index n = data_.points.rows(), d = data_.points.cols(), p = basis_.cols();
  LikelihoodGradient result;
  const Pooled pooled = pool(data_, parameters.nugget_variance);
  if (!build(parameters, pooled.variance, true)) return result;
  result.jitter = jitter_;
  invert_lower_in_place(matrix_);
  const MeanFit mean = fit_mean(matrix_, basis_, precision_, pooled.mean);
  if (!mean.ok) return result;
  result.value = mean.log_likelihood + pooled.log_likelihood;

  // P over matrix_ (lower): K^-1 - Q Q' with Q = K^-1 H R^-T.
  Eigen::MatrixXd q(n, p);
  if (p > 0)
    q.noalias() =
        matrix_.transpose().triangularView<Eigen::Upper>() * (mean.whitened_basis * mean.basis_factor.transpose());
  gram_in_place(matrix_);
  if (p > 0) matrix_.selfadjointView<Eigen::Lower>().rankUpdate(q, -1.0);

  // tangent(:, j) = K_j a - dm/du_j; half traces through W = a a' - P.
  const Eigen::VectorXd& a = mean.weights;
  const int count = Likelihood::parameters();
  Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(n, count);
  result.gradient = Eigen::VectorXd::Zero(count);
  Eigen::ArrayXd difference(n), weighted(n);
  for (Eigen::Index j = 0; j + 1 < n; ++j) {
    const Eigen::Index length = n - j - 1;
    const auto below = Eigen::seqN(j + 1, length);
    weighted.head(length) = a[j] * a(below).array() - matrix_.col(j)(below).array();
    for (Eigen::Index k = 0; k < d; ++k) {
      // (x_k - x'_k)^2 / l_k^2 s^2 f = dK/d(log l_k)
      difference.head(length) = (scaled_.col(k)(below).array() - scaled_(j, k)).square() * slope_.col(j)(below).array();
      result.gradient[k] += (difference.head(length) * weighted.head(length)).sum();
      tangent.col(k)(below).array() += difference.head(length) * a[j];
      tangent(j, k) += (difference.head(length) * a(below).array()).sum();
    }
  }
  // log s^2: s^2 C = K - diag(v), K a = m - H beta, tr(P K) = n - p + tr((R R')^-1 B^-1).
  const Eigen::VectorXd diagonal = pooled.variance.array() + jitter_;
  tangent.col(d) = pooled.mean - diagonal.cwiseProduct(a);
  if (p > 0) tangent.col(d) -= basis_ * mean.coefficients;
  const double spread = p > 0 ? mean.basis_factor.colwise().squaredNorm().dot(precision_) : 0.0;
  result.gradient[d] =
      0.5 * (a.dot(tangent.col(d)) - static_cast<double>(n - p) - spread + matrix_.diagonal().dot(diagonal));
  if (nugget_) {
    const double g = parameters.nugget_variance;
    tangent.col(d + 1) = g * (pooled.variance_slope.cwiseProduct(a) - pooled.mean_slope);
    result.gradient[d + 1] = g * (0.5 * (a.cwiseAbs2() - matrix_.diagonal()).dot(pooled.variance_slope) -
                                  a.dot(pooled.mean_slope) + pooled.log_likelihood_slope);
  }
  Eigen::MatrixXd projected(n, count);
  projected.noalias() = matrix_.selfadjointView<Eigen::Lower>() * tangent;
  result.information.noalias() = 0.5 * tangent.transpose() * projected;
  result.ok = result.gradient.allFinite();
  return result;
}

}  // namespace surrogate
