#include "surrogate/prediction.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "surrogate/dense.hpp"
#include "surrogate/gaps.hpp"
#include "surrogate/mixture.hpp"

namespace surrogate {

using Eigen::Index;

namespace {

/// The first half of cross(): correlations with the runs, slopes and basis.
void correlate_with_runs(const Conditioned& part, const GaussianProcess& process, const Eigen::MatrixXd& points,
                         Slopes slopes, PredictionWorkspace& workspace) {
  const bool with_slopes = slopes == Slopes::yes;
  const std::vector<int>& active = process.data().active;
  const Index n = part.scaled_points.rows(), d = part.scaled_points.cols(), m = points.rows();
  workspace.points.resize(m, d);
  for (Index k = 0; k < d; ++k) workspace.points.col(k) = points.col(active[k]);
  if (part.factorised.whitened_basis.cols() > 0) workspace.basis = basis_matrix(process.mean(), workspace.points);
  for (Index k = 0; k < d; ++k) workspace.points.col(k) /= part.parameters.length_scales[k];

  square_distances(part.scaled_points, workspace.points, workspace.squares);
  workspace.correlations.resize(n, m);
  if (with_slopes) workspace.slopes.resize(n, m);
  correlate(process.kernel(), {{workspace.squares.data(), n * m},
                               {workspace.correlations.data(), n * m},
                               {with_slopes ? workspace.slopes.data() : nullptr, with_slopes ? n * m : 0}});
  workspace.correlations *= part.parameters.signal_variance;
  if (with_slopes) workspace.slopes *= part.parameters.signal_variance;
}

void latent_mean(const Conditioned& part, PointRange range, const PredictionWorkspace& workspace,
                 Eigen::VectorXd& mean) {
  const Index first = range.first, m = range.count;
  mean.noalias() = workspace.correlations.middleCols(first, m).transpose() * part.factorised.residual_weights;
  if (part.factorised.whitened_basis.cols() > 0)
    mean.noalias() += workspace.basis.middleRows(first, m) * part.factorised.mean_coefficients;
}

}  // namespace

void cross(const Conditioned& part, const GaussianProcess& process, const Eigen::MatrixXd& points, Slopes slopes,
           PredictionWorkspace& workspace) {
  correlate_with_runs(part, process, points, slopes, workspace);
  const Index p = part.factorised.whitened_basis.cols(), m = points.rows();
  multiply_lower(part.factorised.inverse_factor, workspace.correlations, workspace.whitened);
  if (p > 0) {
    workspace.projected = workspace.basis.transpose();
    workspace.projected.noalias() -= part.factorised.whitened_basis.transpose() * workspace.whitened;
    workspace.projected = part.factorised.basis_factor * workspace.projected;
  } else {
    workspace.projected.resize(0, m);
  }
}

void latent(const Conditioned& part, const GaussianProcess& process, PointRange range, PredictionWorkspace& workspace,
            Prediction& result) {
  const Index first = range.first, m = range.count;
  const Index p = workspace.projected.rows();
  latent_mean(part, range, workspace, result.mean);

  result.covariance.resize(m, m);
  const auto points = workspace.points.middleRows(first, m);
  square_distances(points, points, workspace.squares);  // free by now
  correlate(process.kernel(), {{workspace.squares.data(), m * m}, {result.covariance.data(), m * m}, {nullptr, 0}});
  result.covariance *= part.parameters.signal_variance;
  result.covariance.noalias() -=
      workspace.whitened.middleCols(first, m).transpose() * workspace.whitened.middleCols(first, m);
  if (p > 0)
    result.covariance.noalias() +=
        workspace.projected.middleCols(first, m).transpose() * workspace.projected.middleCols(first, m);
  // Rounding may leave a variance at a training point of an exact code just below zero.
  result.covariance.diagonal() = result.covariance.diagonal().cwiseMax(0.0);
  if (!process.data().gaps.empty())
    add_gaps(process.data().gaps, points * part.parameters.length_scales.asDiagonal(), result.covariance);
}

void rescale(const Standardised& data, Prediction& result) {
  result.mean = (data.shift + data.unit * result.mean.array()).matrix();
  result.covariance *= data.unit * data.unit;
  if (data.scale == OutputScale::linear) return;
  result.mean = (result.mean + 0.5 * result.covariance.diagonal()).array().exp();
  result.covariance = (result.mean * result.mean.transpose()).cwiseProduct(result.covariance.array().expm1().matrix());
}

void square_distances(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::Ref<const Eigen::MatrixXd>& b,
                      Eigen::MatrixXd& squares) {
  squares.setZero(a.rows(), b.rows());
  for (Index j = 0; j < b.rows(); ++j)
    for (Index k = 0; k < a.cols(); ++k) squares.col(j).array() += (a.col(k).array() - b(j, k)).square();
}

void check_points(const Eigen::MatrixXd& points, int dimension) {
  if (points.cols() != dimension)
    throw std::invalid_argument(
        fmt::format("points have {} coordinates, the process has {} inputs", points.cols(), dimension));
}

void check_groups(const Eigen::MatrixXd& points, int group) {
  if (group < 1 || points.rows() % group != 0)
    throw std::invalid_argument(fmt::format("{} points are not whole groups of {}", points.rows(), group));
}

Index groups_at_once(int group) { return std::max<Index>(1, 192 / group); }

Prediction GaussianProcess::predict(const Eigen::MatrixXd& points) const {
  PredictionWorkspace workspace;
  Prediction result;
  predict(points, workspace, result);
  return result;
}

void GaussianProcess::predict(const Eigen::MatrixXd& points, PredictionWorkspace& workspace, Prediction& result) const {
  check_points(points, dimension());
  if (averaged().size() == 1) {
    cross(averaged().front(), *this, points, Slopes::no, workspace);
    latent(averaged().front(), *this, {0, points.rows()}, workspace, result);
    rescale(*data_, result);
    return;
  }
  MixedPrediction mixture;
  for (const Conditioned& part : averaged()) {
    cross(part, *this, points, Slopes::no, workspace);
    latent(part, *this, {0, points.rows()}, workspace, workspace.part);
    rescale(*data_, workspace.part);
    mixture.add(part.weight, workspace.part);
  }
  result = mixture.result();
}

Eigen::VectorXd GaussianProcess::predict_mean(const Eigen::MatrixXd& points) const {
  check_points(points, dimension());
  if (data_->scale != OutputScale::linear) return predict(points).mean;
  PredictionWorkspace workspace;
  Eigen::VectorXd origin, shift, mean;
  for (const Conditioned& part : averaged()) {
    correlate_with_runs(part, *this, points, Slopes::no, workspace);
    latent_mean(part, {0, points.rows()}, workspace, mean);
    mean = (data_->shift + data_->unit * mean.array()).matrix();
    if (origin.size() == 0) {
      origin = mean;
      shift = Eigen::VectorXd::Zero(mean.size());
    }
    shift += part.weight * (mean - origin);  // as MixedPrediction sums
  }
  return origin + shift;
}

std::vector<Prediction> GaussianProcess::predict_batch(const Eigen::MatrixXd& points, int group) const {
  check_points(points, dimension());
  check_groups(points, group);
  const Index groups = points.rows() / group, block = groups_at_once(group);
  std::vector<Prediction> results(static_cast<std::size_t>(groups));
  PredictionWorkspace workspace;
  for (Index first = 0; first < groups; first += block) {
    const Index count = std::min(block, groups - first);
    const Eigen::MatrixXd rows = points.middleRows(first * group, count * group);
    std::vector<MixedPrediction> mixtures(averaged().size() > 1 ? static_cast<std::size_t>(count) : 0);
    for (const Conditioned& part : averaged()) {
      cross(part, *this, rows, Slopes::no, workspace);
      for (Index g = 0; g < count; ++g) {
        Prediction& result = mixtures.empty() ? results[first + g] : workspace.part;
        latent(part, *this, {g * group, group}, workspace, result);
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
    for (const Conditioned& part : averaged()) {
      cross(part, *this, rows, Slopes::no, workspace);
      Eigen::VectorXd mean = workspace.correlations.transpose() * part.factorised.residual_weights;
      if (workspace.projected.rows() > 0) mean += workspace.basis * part.factorised.mean_coefficients;
      Eigen::VectorXd variance = (part.parameters.signal_variance - workspace.whitened.colwise().squaredNorm().array() +
                                  workspace.projected.colwise().squaredNorm().array())
                                     .max(0.0)
                                     .transpose();
      if (!data_->gaps.empty())
        for (Index j = 0; j < count; ++j)
          variance[j] +=
              gap_variance(data_->gaps, workspace.points.row(j) * part.parameters.length_scales.asDiagonal());
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

}  // namespace surrogate
