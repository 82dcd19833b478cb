// Predictions with their derivatives to a common shift of all points.
#include <algorithm>
#include <cmath>

#include "surrogate/dense.hpp"
#include "surrogate/gaps.hpp"
#include "surrogate/mixture.hpp"
#include "surrogate/prediction.hpp"

namespace surrogate {
namespace {

using Eigen::Index;

/// Takes a prediction of z, with its gradients, to one of y.
void rescale(const Standardised& data, PredictionGradient& result) {
  const double unit = data.unit;
  for (Eigen::VectorXd& gradient : result.mean_gradient) gradient *= unit;
  for (Eigen::MatrixXd& gradient : result.covariance_gradient) gradient *= unit * unit;
  if (data.scale == OutputScale::linear) {
    rescale(data, result.value);
    return;
  }
  const Eigen::MatrixXd log_covariance = unit * unit * result.value.covariance;
  rescale(data, result.value);
  const Eigen::VectorXd& mean = result.value.mean;
  for (std::size_t k = 0; k < result.mean_gradient.size(); ++k) {
    // Relative slopes of the means, then d[mean_i mean_j (exp(C_ij) - 1)].
    const Eigen::VectorXd relative = result.mean_gradient[k] + 0.5 * result.covariance_gradient[k].diagonal();
    result.mean_gradient[k] = mean.cwiseProduct(relative);
    Eigen::MatrixXd& slope = result.covariance_gradient[k];
    slope = ((mean * mean.transpose()).array() * log_covariance.array().exp() * slope.array()).matrix();
    for (Index j = 0; j < mean.size(); ++j)
      slope.col(j).array() += result.value.covariance.col(j).array() * (relative.array() + relative[j]);
  }
}

}  // namespace

PredictionGradient GaussianProcess::predict_with_gradient(const Eigen::MatrixXd& points,
                                                          std::span<const int> coordinates) const {
  PredictionWorkspace workspace;
  PredictionGradient result;
  predict_with_gradient(points, coordinates, workspace, result);
  return result;
}

void GaussianProcess::predict_with_gradient(const Eigen::MatrixXd& points, std::span<const int> coordinates,
                                            PredictionWorkspace& workspace, PredictionGradient& result) const {
  check_points(points, dimension());
  const Index m = points.rows();
  const std::size_t wanted = coordinates.size();
  const bool single = averaged().size() == 1;
  PredictionGradient& target = single ? result : workspace.gradient_part;

  Eigen::VectorXd origin, shift;  // mixture of the gradients, as in MixedPrediction
  std::vector<Eigen::VectorXd> first_gradient(wanted), shift_gradient(wanted);
  std::vector<Eigen::MatrixXd> spread_gradient(wanted);
  MixedPrediction mixture;

  for (const Conditioned& part : averaged()) {
    cross(part, *this, points, Slopes::yes, workspace);
    latent(part, *this, {0, m}, workspace, target.value);
    const Index n = part.scaled_points.rows(), p = workspace.projected.rows();

    // A common shift leaves k** as it is, so with B = K^-1 k* + K^-1 H R^-T E
    //   d cov = -(dk*' B) + dh*' R^-T E, plus its transpose;   d mean = dk*' a + dh*' beta.
    Eigen::MatrixXd& right = workspace.moved;  // free until the slopes
    right = workspace.whitened;
    Eigen::MatrixXd basis_part;
    if (p > 0) {
      basis_part.noalias() = part.factorised.basis_factor.transpose() * workspace.projected;
      right.noalias() += part.factorised.whitened_basis * basis_part;
    }
    multiply_lower_transposed(part.factorised.inverse_factor, right, workspace.solved);

    target.mean_gradient.resize(wanted);
    target.covariance_gradient.resize(wanted);
    for (std::size_t c = 0; c < wanted; ++c) {
      const auto place = std::find(data_->active.begin(), data_->active.end(), coordinates[c]);
      target.mean_gradient[c].setZero(m);
      target.covariance_gradient[c].setZero(m, m);
      if (place == data_->active.end()) continue;  // an input that never varied has no influence
      const Index k = place - data_->active.begin();
      workspace.moved.resize(n, m);
      const double inverse_length = 1.0 / part.parameters.length_scales[k];
      for (Index j = 0; j < m; ++j)
        workspace.moved.col(j).array() = workspace.slopes.col(j).array() *
                                         (part.scaled_points.col(k).array() - workspace.points(j, k)) * inverse_length;
      target.mean_gradient[c].noalias() = workspace.moved.transpose() * part.factorised.residual_weights;
      workspace.squares.noalias() = -(workspace.moved.transpose() * workspace.solved);
      if (p > 0 && mean_ != MeanBasis::constant) {
        Eigen::MatrixXd unscaled = workspace.points * part.parameters.length_scales.asDiagonal();
        const Eigen::MatrixXd slope = basis_derivative(mean_, unscaled, static_cast<int>(k));
        target.mean_gradient[c].noalias() += slope * part.factorised.mean_coefficients;
        workspace.squares.noalias() += slope * basis_part;
      }
      target.covariance_gradient[c] = workspace.squares + workspace.squares.transpose();
      if (!data_->gaps.empty())
        add_gap_slopes(data_->gaps, workspace.points * part.parameters.length_scales.asDiagonal(), static_cast<int>(k),
                       target.covariance_gradient[c]);
    }
    rescale(*data_, target);
    if (single) return;

    mixture.add(part.weight, target.value);
    const bool is_first = origin.size() == 0;
    if (is_first) {
      origin = target.value.mean;
      shift = Eigen::VectorXd::Zero(m);
    }
    const Eigen::VectorXd delta = target.value.mean - origin;
    shift += part.weight * delta;
    for (std::size_t c = 0; c < wanted; ++c) {
      if (is_first) {
        first_gradient[c] = target.mean_gradient[c];
        shift_gradient[c] = Eigen::VectorXd::Zero(m);
        spread_gradient[c] = Eigen::MatrixXd::Zero(m, m);
      }
      const Eigen::VectorXd slope = target.mean_gradient[c] - first_gradient[c];
      shift_gradient[c] += part.weight * slope;
      spread_gradient[c] +=
          part.weight * (target.covariance_gradient[c] + slope * delta.transpose() + delta * slope.transpose());
    }
  }
  result.value = mixture.result();
  result.mean_gradient.resize(wanted);
  result.covariance_gradient.resize(wanted);
  for (std::size_t c = 0; c < wanted; ++c) {
    result.mean_gradient[c] = first_gradient[c] + shift_gradient[c];
    result.covariance_gradient[c] =
        spread_gradient[c] - shift_gradient[c] * shift.transpose() - shift * shift_gradient[c].transpose();
  }
}

}  // namespace surrogate
