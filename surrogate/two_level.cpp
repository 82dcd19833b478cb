#include "surrogate/two_level.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "data/error.hpp"
#include "surrogate/dense.hpp"
#include "surrogate/mixture.hpp"
#include "surrogate/prediction.hpp"
#include "surrogate/two_level_likelihood.hpp"

namespace surrogate {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd discrepancy_lengths(const GaussianProcess& low) {
  return low.hyper_parameters().length_scales.cwiseMin(longest_discrepancy);
}

MatrixXd scaled_points(const MatrixXd& points, const VectorXd& lengths) {
  return points.array().rowwise() / lengths.transpose().array();
}

void discrepancy_correlations(Kernel kernel, const MatrixXd& squares, double length_factor, MatrixXd& scratch,
                              MatrixXd& value) {
  scratch = squares / (length_factor * length_factor);
  value.resize(squares.rows(), squares.cols());
  correlate(kernel, {{scratch.data(), scratch.size()}, {value.data(), value.size()}, {nullptr, 0}});
}

HighProblem high_problem(const GaussianProcess& low, const TrainingSet& high, MeanBasis mean) {
  HighProblem problem{low.kernel(), high, mean, low.predict(high.x), {}};
  const MatrixXd scaled = scaled_points(high.x, discrepancy_lengths(low));
  square_distances(scaled, scaled, problem.squares);
  return problem;
}

HighFit fit_high(const HighProblem& problem, const TwoLevelParameters& p) {
  const TrainingSet& high = problem.runs;
  const Prediction& low_at_high = problem.low_at_high;
  const Index n = high.y.size();
  const MatrixXd basis = MatrixXd::Ones(n, basis_size(problem.mean, 0));
  MatrixXd scratch, covariance;
  discrepancy_correlations(problem.kernel, problem.squares, p.length_factor, scratch, covariance);
  covariance = p.rho * p.rho * low_at_high.covariance + p.discrepancy_sd * p.discrepancy_sd * covariance;
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
  result.whitened_basis = basis;
  if (basis.cols() > 0) result.factor.triangularView<Eigen::Lower>().solveInPlace(result.whitened_basis);
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

TwoLevelProcess::TwoLevelProcess(GaussianProcess low, HighLevel high)
    : low_(std::move(low)),
      high_(std::move(high)),
      low_at_high_(low_, high_.runs.x),
      lengths_(discrepancy_lengths(low_)),
      scaled_runs_(scaled_points(high_.runs.x, lengths_)) {
  const HighProblem problem = high_problem(low_, high_.runs, high_.discrepancy_mean);
  for (const TwoLevelParameters& setting : high_.settings) {
    HighFit fitted = fit_high(problem, setting);
    if (!fitted.ok)
      throw data::InputError(
          data::ExitStatus::bad_data,
          {"two-level surrogate", "the covariance of the high-level runs cannot be factorised even with jitter",
           "give the runs their standard errors"});
    high_.diagnostics.jitter = std::max(high_.diagnostics.jitter, fitted.jitter);
    invert_lower_in_place(fitted.factor);
    parts_.push_back({std::move(fitted.factor), std::move(fitted.whitened_basis), std::move(fitted.basis_factor),
                      std::move(fitted.weights), std::move(fitted.coefficients)});
  }
}

double TwoLevelProcess::mean_rho() const {
  double sum = 0.0;
  for (const TwoLevelParameters& setting : high_.settings) sum += setting.weight * setting.rho;
  return sum;
}

struct TwoLevelProcess::Workspace {
  PredictionWorkspace of_low;
  JointPrediction low;
  MatrixXd squares, squares_within, correlations, correlations_within, scratch, whitened, unknown;
  Prediction part;
};

void TwoLevelProcess::predict_block(const MatrixXd& points, int group, Workspace& w,
                                    std::span<Prediction> results) const {
  const Index all = points.rows();
  low_at_high_.predict(points, group, w.of_low, w.low);
  const MatrixXd scaled = scaled_points(points, lengths_);
  square_distances(scaled_runs_, scaled, w.squares);
  w.squares_within.resize(group, all);
  for (Index first = 0; first < all; first += group) {
    const auto own = scaled.middleRows(first, group);
    square_distances(own, own, w.scratch);
    w.squares_within.middleCols(first, group) = w.scratch;
  }
  std::vector<MixedPrediction> mixtures(results.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const TwoLevelParameters& p = high_.settings[i];
    const Part& part = parts_[i];
    const double rho2 = p.rho * p.rho, s2 = p.discrepancy_sd * p.discrepancy_sd;
    discrepancy_correlations(low_.kernel(), w.squares, p.length_factor, w.scratch, w.correlations);
    discrepancy_correlations(low_.kernel(), w.squares_within, p.length_factor, w.scratch, w.correlations_within);
    w.correlations = rho2 * w.low.cross + s2 * w.correlations;
    w.correlations_within = rho2 * w.low.covariance + s2 * w.correlations_within;
    multiply_lower(part.inverse_factor, w.correlations, w.whitened);
    const bool with_mean = part.coefficients.size() == 1;
    if (with_mean) {
      w.unknown.setOnes(1, all);
      w.unknown.noalias() -= part.whitened_basis.transpose() * w.whitened;
      w.unknown *= part.basis_factor(0, 0);
    }
    for (std::size_t g = 0; g < results.size(); ++g) {
      const Index first = static_cast<Index>(g) * group;
      const auto whitened = w.whitened.middleCols(first, group);
      w.part.mean = p.rho * w.low.mean.segment(first, group);
      w.part.mean.noalias() += w.correlations.middleCols(first, group).transpose() * part.weights;
      w.part.covariance = w.correlations_within.middleCols(first, group);
      w.part.covariance.noalias() -= whitened.transpose() * whitened;
      if (with_mean) {
        const auto unknown = w.unknown.middleCols(first, group);
        w.part.mean.array() += part.coefficients[0];
        w.part.covariance.noalias() += unknown.transpose() * unknown;
      }
      w.part.covariance.diagonal() = w.part.covariance.diagonal().cwiseMax(0.0);
      mixtures[g].add(p.weight, w.part);
    }
  }
  for (std::size_t g = 0; g < results.size(); ++g) results[g] = mixtures[g].result();
}

Prediction TwoLevelProcess::predict(const MatrixXd& points) const {
  if (points.rows() == 0) return {VectorXd(0), MatrixXd(0, 0)};
  return predict_batch(points, static_cast<int>(points.rows())).front();
}

std::vector<Prediction> TwoLevelProcess::predict_batch(const MatrixXd& points, int group) const {
  check_groups(points, group);
  const Index groups = points.rows() / group, block = groups_at_once(group);
  std::vector<Prediction> results(static_cast<std::size_t>(groups));
  Workspace workspace;
  for (Index first = 0; first < groups; first += block) {
    const Index count = std::min(block, groups - first);
    predict_block(points.middleRows(first * group, count * group), group, workspace,
                  std::span(results).subspan(first, count));
  }
  return results;
}

PredictionGradient TwoLevelProcess::predict_with_gradient(const MatrixXd& points,
                                                          std::span<const int> coordinates) const {
  constexpr double step = 1e-4;
  const Index m = points.rows();
  // The points themselves, then for each coordinate the points moved up and down.
  MatrixXd moved = points.replicate(1 + 2 * static_cast<Index>(coordinates.size()), 1);
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const Index up = (1 + 2 * static_cast<Index>(k)) * m;
    moved.col(coordinates[k]).segment(up, m).array() += step;
    moved.col(coordinates[k]).segment(up + m, m).array() -= step;
  }
  std::vector<Prediction> found = predict_batch(moved, static_cast<int>(m));
  PredictionGradient result;
  result.value = std::move(found[0]);
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const Prediction &above = found[1 + 2 * k], &below = found[2 + 2 * k];
    result.mean_gradient.push_back((above.mean - below.mean) / (2.0 * step));
    result.covariance_gradient.push_back((above.covariance - below.covariance) / (2.0 * step));
  }
  return result;
}

}  // namespace surrogate
