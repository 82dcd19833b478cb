#include "surrogate/noise_check.hpp"

#include <fmt/core.h>

#include <cmath>

namespace surrogate {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

NoiseCheck check_noise(const TrainingSet& training, const FitOptions& options, const GaussianProcess& process) {
  constexpr Index points_most = 1500;  // P is dense
  NoiseCheck check;
  const Standardised& data = process.data();
  const Conditioned& part = process.parts().front();
  const Factorised& f = part.factorised;
  if (!(data.noise.minCoeff() > 0.0) || data.points.rows() > points_most) return check;
  check.replicated = data.z.size() - data.points.rows() >= 5;
  check.scatter_ratio = std::sqrt(part.parameters.nugget_variance / data.noise.mean());
  if (options.nugget && check.scatter_ratio > 0.1) {
    FitOptions without = options;
    without.nugget = false;
    without.starts = 1;
    without.hyper_uncertainty = HyperUncertainty::plug_in;
    without.between_runs = BetweenRuns::trusted;
    without.first_start = to_logs(part.parameters, false);
    check.log_ratio = 2.0 * (process.log_marginal_likelihood() - fit(training, without).log_marginal_likelihood());
  }

  const Pooled stated = pool(data, 0.0);
  MatrixXd precision = MatrixXd::Zero(data.points.rows(), data.points.rows());
  precision.noalias() = f.inverse_factor.transpose() * f.inverse_factor;
  if (f.whitened_basis.cols() > 0) {
    const MatrixXd q = f.inverse_factor.transpose() * (f.whitened_basis * f.basis_factor.transpose());
    precision.noalias() -= q * q.transpose();
  }
  const double expected = precision.diagonal().dot(stated.variance);
  const double found = f.residual_weights.cwiseAbs2().dot(stated.variance);
  const VectorXd root = stated.variance.cwiseSqrt();
  const double variance = 2.0 * (root.asDiagonal() * precision * root.asDiagonal()).squaredNorm();
  check.residual_ratio = found / expected;
  check.noise_share = expected / static_cast<double>(data.points.rows());
  check.residual_z = (found - expected) / std::sqrt(variance);
  return check;
}

std::string noise_note(const NoiseCheck& check) {
  if (check.understated())
    return fmt::format(
        "the runs' errors are stated too small{}: they scatter by {:.1f} times their stated errors beyond "
        "these",
        check.replicated ? "" : ", or the output has structure that the runs are too few to resolve",
        check.scatter_ratio);
  if (check.overstated())
    return fmt::format(
        "the runs' errors are stated too large: the runs lie closer to the surrogate than that, by a factor of about "
        "{:.2f}",
        std::sqrt(check.residual_ratio));
  return {};
}

}  // namespace surrogate
