// Leave-one-out in closed form (gaussian_process.hpp).
#include <algorithm>
#include <cmath>
#include <limits>

#include "surrogate/gaussian_process.hpp"

namespace surrogate {
namespace {

using Eigen::Index;

/// Copies of the diagonal of P = K^-1 - Q Q' that the leave-one-out formulas need.
Eigen::VectorXd precision_diagonal(const Factorised& factorised) {
  Eigen::VectorXd diagonal = factorised.inverse_factor.colwise().squaredNorm().transpose();
  if (factorised.whitened_basis.cols() > 0) {
    const Eigen::MatrixXd q = factorised.inverse_factor.transpose().triangularView<Eigen::Upper>() *
                              (factorised.whitened_basis * factorised.basis_factor.transpose());
    diagonal -= q.rowwise().squaredNorm();
  }
  return diagonal;
}

}  // namespace

LeaveOneOut GaussianProcess::leave_one_out() const {
  const Index n = data_->z.size();
  LeaveOneOut result{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n),
                     Eigen::VectorXd::Zero(n)};
  // Moments of z per run over the parts, then to y.
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(n), second = mean, noise = mean;
  for (const Conditioned& part : averaged()) {
    const Factorised& f = part.factorised;
    const Eigen::VectorXd precision = precision_diagonal(f);
    for (Index i = 0; i < n; ++i) {
      const int j = data_->point_of_run[i];
      const double predicted = f.pooled.mean[j] - f.residual_weights[j] / precision[j];
      const double latent_variance = std::max(0.0, 1.0 / precision[j] - f.pooled.variance[j] - f.jitter);
      mean[i] += part.weight * predicted;
      second[i] += part.weight * (latent_variance + predicted * predicted);
      noise[i] += part.weight * (part.parameters.nugget_variance + data_->noise[i]);
    }
  }
  const Eigen::VectorXd latent_variance = (second - mean.cwiseAbs2()).cwiseMax(0.0);
  result.standardised =
      (data_->z - mean).array() / (latent_variance + noise).array().max(std::numeric_limits<double>::min()).sqrt();
  const double unit2 = data_->unit * data_->unit;
  result.mean = (data_->shift + data_->unit * mean.array()).matrix();
  result.latent_variance = unit2 * latent_variance;
  result.variance = unit2 * (latent_variance + noise);
  if (data_->scale == OutputScale::log) {
    const Eigen::ArrayXd log_mean = result.mean.array();
    result.mean = (log_mean + 0.5 * result.latent_variance.array()).exp();
    const Eigen::ArrayXd noisy_mean = (log_mean + 0.5 * result.variance.array()).exp();
    result.latent_variance = result.mean.array().square() * result.latent_variance.array().expm1();
    result.variance = noisy_mean.square() * result.variance.array().expm1();
  }
  return result;
}

}  // namespace surrogate
