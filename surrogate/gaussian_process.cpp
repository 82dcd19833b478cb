#include "surrogate/gaussian_process.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "data/error.hpp"
#include "surrogate/dense.hpp"

namespace surrogate {
namespace {

using Eigen::Index;

/// Correlations, whitened correlations and mean-uncertainty of one part at the given points, left in the workspace:
/// correlations = s^2 c, slopes = s^2 f (if wanted), whitened = L^-1 k*, projected = E.
void cross(const Conditioned& part, const GaussianProcess& process, const Eigen::MatrixXd& points, bool with_slopes,
           PredictionWorkspace& workspace) {
  const std::vector<int>& active = process.data().active;
  const Index n = part.scaled_points.rows(), d = part.scaled_points.cols(), m = points.rows();
  workspace.points.resize(m, d);
  for (Index k = 0; k < d; ++k) workspace.points.col(k) = points.col(active[k]);
  const Index p = part.factorised.whitened_basis.cols();
  if (p > 0) workspace.basis = basis_matrix(process.mean(), workspace.points);
  for (Index k = 0; k < d; ++k) workspace.points.col(k) /= part.parameters.length_scales[k];

  workspace.squares.setZero(n, m);
  for (Index j = 0; j < m; ++j)
    for (Index k = 0; k < d; ++k)
      workspace.squares.col(j).array() += (part.scaled_points.col(k).array() - workspace.points(j, k)).square();
  workspace.correlations.resize(n, m);
  if (with_slopes) workspace.slopes.resize(n, m);
  correlate(process.kernel(), {{workspace.squares.data(), n * m},
                               {workspace.correlations.data(), n * m},
                               {with_slopes ? workspace.slopes.data() : nullptr, with_slopes ? n * m : 0}});
  workspace.correlations *= part.parameters.signal_variance;
  if (with_slopes) workspace.slopes *= part.parameters.signal_variance;

  workspace.whitened.resize(n, m);
  workspace.whitened.noalias() = part.factorised.inverse_factor.triangularView<Eigen::Lower>() * workspace.correlations;
  if (p > 0) {
    workspace.projected = workspace.basis.transpose();
    workspace.projected.noalias() -= part.factorised.whitened_basis.transpose() * workspace.whitened;
    workspace.projected = part.factorised.basis_factor * workspace.projected;
  } else {
    workspace.projected.resize(0, m);
  }
}

/// Mean and covariance of z of points first ... first + m - 1 of the workspace.
void latent(const Conditioned& part, const GaussianProcess& process, Index first, Index m,
            PredictionWorkspace& workspace, Prediction& result) {
  const Index p = workspace.projected.rows();
  result.mean.noalias() = workspace.correlations.middleCols(first, m).transpose() * part.factorised.residual_weights;
  if (p > 0) result.mean.noalias() += workspace.basis.middleRows(first, m) * part.factorised.mean_coefficients;

  result.covariance.resize(m, m);
  workspace.squares.resize(m, m);  // free by now
  workspace.squares.setZero();
  for (Index k = 0; k < workspace.points.cols(); ++k)
    for (Index j = 0; j < m; ++j)
      workspace.squares.col(j).array() +=
          (workspace.points.col(k).segment(first, m).array() - workspace.points(first + j, k)).square();
  correlate(process.kernel(), {{workspace.squares.data(), m * m}, {result.covariance.data(), m * m}, {nullptr, 0}});
  result.covariance *= part.parameters.signal_variance;
  result.covariance.noalias() -=
      workspace.whitened.middleCols(first, m).transpose() * workspace.whitened.middleCols(first, m);
  if (p > 0)
    result.covariance.noalias() +=
        workspace.projected.middleCols(first, m).transpose() * workspace.projected.middleCols(first, m);
  // Rounding may leave a variance at a training point of an exact code just below zero.
  result.covariance.diagonal() = result.covariance.diagonal().cwiseMax(0.0);
}

/// From z to y.
void rescale(const Standardised& data, Prediction& result) {
  result.mean = (data.shift + data.unit * result.mean.array()).matrix();
  result.covariance *= data.unit * data.unit;
  if (data.scale == OutputScale::linear) return;
  result.mean = (result.mean + 0.5 * result.covariance.diagonal()).array().exp();
  result.covariance = (result.mean * result.mean.transpose()).cwiseProduct(result.covariance.array().expm1().matrix());
}

/// From z to y, with the gradients.
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

/// Mean and covariance of a mixture, by moments about the first part's mean.
class Mixture {
 public:
  void add(double weight, const Prediction& part) {
    if (count_++ == 0) {
      origin_ = part.mean;
      shift_ = Eigen::VectorXd::Zero(part.mean.size());
      covariance_ = Eigen::MatrixXd::Zero(part.mean.size(), part.mean.size());
    }
    const Eigen::VectorXd delta = part.mean - origin_;
    shift_ += weight * delta;
    covariance_ += weight * (part.covariance + delta * delta.transpose());
  }
  Prediction result() const { return {origin_ + shift_, covariance_ - shift_ * shift_.transpose()}; }

 private:
  int count_ = 0;
  Eigen::VectorXd origin_, shift_;
  Eigen::MatrixXd covariance_;
};

void check_points(const Eigen::MatrixXd& points, int dimension) {
  if (points.cols() != dimension)
    throw std::invalid_argument(
        fmt::format("points have {} coordinates, the process has {} inputs", points.cols(), dimension));
}

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

GaussianProcess::GaussianProcess(Kernel kernel, MeanBasis mean, bool nugget, Standardised data,
                                 std::vector<Conditioned> parts, FitDiagnostics diagnostics)
    : kernel_(kernel),
      mean_(mean),
      nugget_(nugget),
      data_(std::make_shared<const Standardised>(std::move(data))),
      parts_(std::make_shared<const std::vector<Conditioned>>(std::move(parts))),
      diagnostics_(std::make_shared<const FitDiagnostics>(std::move(diagnostics))) {}

Prediction GaussianProcess::predict(const Eigen::MatrixXd& points) const {
  PredictionWorkspace workspace;
  Prediction result;
  predict(points, workspace, result);
  return result;
}

void GaussianProcess::predict(const Eigen::MatrixXd& points, PredictionWorkspace& workspace, Prediction& result) const {
  check_points(points, dimension());
  if (parts_->size() == 1) {
    cross(parts_->front(), *this, points, false, workspace);
    latent(parts_->front(), *this, 0, points.rows(), workspace, result);
    rescale(*data_, result);
    return;
  }
  Mixture mixture;
  for (const Conditioned& part : *parts_) {
    cross(part, *this, points, false, workspace);
    latent(part, *this, 0, points.rows(), workspace, workspace.part);
    rescale(*data_, workspace.part);
    mixture.add(part.weight, workspace.part);
  }
  result = mixture.result();
}

std::vector<Prediction> GaussianProcess::predict_batch(const Eigen::MatrixXd& points, int group) const {
  check_points(points, dimension());
  if (group < 1 || points.rows() % group != 0)
    throw std::invalid_argument(fmt::format("{} points are not whole groups of {}", points.rows(), group));
  const Index groups = points.rows() / group;
  const Index block = std::max<Index>(1, 192 / group);  // groups per matrix product
  std::vector<Prediction> results(static_cast<std::size_t>(groups));
  PredictionWorkspace workspace;
  for (Index first = 0; first < groups; first += block) {
    const Index count = std::min(block, groups - first);
    const Eigen::MatrixXd rows = points.middleRows(first * group, count * group);
    std::vector<Mixture> mixtures(parts_->size() > 1 ? static_cast<std::size_t>(count) : 0);
    for (const Conditioned& part : *parts_) {
      cross(part, *this, rows, false, workspace);
      for (Index g = 0; g < count; ++g) {
        Prediction& result = mixtures.empty() ? results[first + g] : workspace.part;
        latent(part, *this, g * group, group, workspace, result);
        rescale(*data_, result);
        if (!mixtures.empty()) mixtures[g].add(part.weight, result);
      }
    }
    for (std::size_t g = 0; g < mixtures.size(); ++g) results[first + g] = mixtures[g].result();
  }
  return results;
}

MarginalPrediction GaussianProcess::predict_marginal(const Eigen::MatrixXd& points) const {
  check_points(points, dimension());
  constexpr Index block = 256;
  MarginalPrediction result{Eigen::VectorXd(points.rows()), Eigen::VectorXd(points.rows())};
  PredictionWorkspace workspace;
  for (Index first = 0; first < points.rows(); first += block) {
    const Index count = std::min(block, points.rows() - first);
    const Eigen::MatrixXd rows = points.middleRows(first, count);
    Eigen::VectorXd origin, shift = Eigen::VectorXd::Zero(count), spread = Eigen::VectorXd::Zero(count);
    for (const Conditioned& part : *parts_) {
      cross(part, *this, rows, false, workspace);
      Eigen::VectorXd mean = workspace.correlations.transpose() * part.factorised.residual_weights;
      if (workspace.projected.rows() > 0) mean += workspace.basis * part.factorised.mean_coefficients;
      Eigen::VectorXd variance = (part.parameters.signal_variance - workspace.whitened.colwise().squaredNorm().array() +
                                  workspace.projected.colwise().squaredNorm().array())
                                     .max(0.0)
                                     .transpose();
      mean = (data_->shift + data_->unit * mean.array()).matrix();
      variance *= data_->unit * data_->unit;
      if (data_->scale == OutputScale::log) {
        mean = (mean + 0.5 * variance).array().exp();
        variance = mean.array().square() * variance.array().expm1();
      }
      if (origin.size() == 0) origin = mean;
      shift += part.weight * (mean - origin);
      spread += part.weight * (variance + (mean - origin).cwiseAbs2());
    }
    result.mean.segment(first, count) = origin + shift;
    result.variance.segment(first, count) = spread - shift.cwiseAbs2();
  }
  return result;
}

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
  const bool single = parts_->size() == 1;
  PredictionGradient& target = single ? result : workspace.gradient_part;

  Eigen::VectorXd origin, shift;  // mixture of the gradients, as in Mixture
  std::vector<Eigen::VectorXd> first_gradient(wanted), shift_gradient(wanted);
  std::vector<Eigen::MatrixXd> spread_gradient(wanted);
  Mixture mixture;

  for (const Conditioned& part : *parts_) {
    cross(part, *this, points, true, workspace);
    latent(part, *this, 0, m, workspace, target.value);
    const Index n = part.scaled_points.rows(), p = workspace.projected.rows();

    // A common shift leaves k** as it is, so with B = K^-1 k* + K^-1 H R^-T E
    //   d cov = -(dk*' B) + dh*' R^-T E, plus its transpose;   d mean = dk*' a + dh*' beta.
    workspace.solved = workspace.whitened;
    Eigen::MatrixXd basis_part;
    if (p > 0) {
      basis_part.noalias() = part.factorised.basis_factor.transpose() * workspace.projected;
      workspace.solved.noalias() += part.factorised.whitened_basis * basis_part;
    }
    workspace.solved = part.factorised.inverse_factor.transpose().triangularView<Eigen::Upper>() * workspace.solved;

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

LeaveOneOut GaussianProcess::leave_one_out() const {
  const Index n = data_->z.size();
  LeaveOneOut result{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n),
                     Eigen::VectorXd::Zero(n)};
  // Moments of z per run over the parts, then to y.
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(n), second = mean, noise = mean;
  for (const Conditioned& part : *parts_) {
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

double GaussianProcess::log_marginal_likelihood() const {
  // The flat prior on beta is flat in the units of y, so p of the n Jacobian factors cancel.
  const double p = static_cast<double>(parts_->front().factorised.whitened_basis.cols());
  return parts_->front().factorised.log_likelihood + data_->log_jacobian + p * std::log(data_->unit);
}

HyperParameters GaussianProcess::hyper_parameters() const {
  const Conditioned& part = parts_->front();
  HyperParameters result;
  result.length_scales = Eigen::VectorXd::Constant(dimension(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < data_->active.size(); ++k)
    result.length_scales[data_->active[k]] = part.parameters.length_scales[k];
  result.signal_sd = data_->unit * std::sqrt(part.parameters.signal_variance);
  result.nugget_sd = data_->unit * std::sqrt(part.parameters.nugget_variance);
  result.mean_coefficients = data_->unit * part.factorised.mean_coefficients;
  if (result.mean_coefficients.size() > 0) result.mean_coefficients[0] += data_->shift;
  return result;
}

std::vector<OutsideRange> GaussianProcess::outside_training_range(const Eigen::MatrixXd& points) const {
  check_points(points, dimension());
  constexpr double slack = 1e-9;  // unit-cube length: rounding of a scaled bound
  std::vector<OutsideRange> outside;
  for (Index i = 0; i < points.rows(); ++i)
    for (Index k = 0; k < points.cols(); ++k)
      if (points(i, k) < data_->low[k] - slack || points(i, k) > data_->high[k] + slack)
        outside.push_back({static_cast<int>(i), static_cast<int>(k), points(i, k), data_->low[k], data_->high[k]});
  return outside;
}

GaussianProcess condition(const TrainingSet& training, const ModelForm& form, const HyperParameters& hyper_parameters) {
  Standardised data = standardise(training, form.scale, centre_of(form.mean));
  Conditioned part;
  part.parameters.length_scales.resize(static_cast<Index>(data.active.size()));
  for (std::size_t k = 0; k < data.active.size(); ++k)
    part.parameters.length_scales[k] = hyper_parameters.length_scales[data.active[k]];
  const double signal = hyper_parameters.signal_sd / data.unit, nugget = hyper_parameters.nugget_sd / data.unit;
  part.parameters.signal_variance = signal * signal;
  part.parameters.nugget_variance = nugget * nugget;
  part.scaled_points = data.points * part.parameters.length_scales.cwiseInverse().asDiagonal();
  Likelihood likelihood(data, form.kernel, form.mean, nugget > 0.0);
  part.factorised = likelihood.factorise(part.parameters);
  if (!part.factorised.ok)
    throw data::InputError(data::ExitStatus::bad_data,
                           {"surrogate", "the covariance of the training runs cannot be factorised even with jitter",
                            "give the runs their standard errors, or use a process with a nugget"});
  FitDiagnostics diagnostics;
  diagnostics.converged = true;
  diagnostics.jitter = part.factorised.jitter;
  return {form.kernel, form.mean, nugget > 0.0, std::move(data), {std::move(part)}, std::move(diagnostics)};
}

}  // namespace surrogate
