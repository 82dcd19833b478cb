#include "uq/posterior.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace uq {
namespace {

constexpr double nowhere = -std::numeric_limits<double>::infinity();

/// Writes the rows of a group at u into `points`, from row `first` on.
void place_rows(const RowGroup& group, const Eigen::VectorXd& u, Eigen::MatrixXd& points, Eigen::Index first) {
  for (Eigen::Index k = 0; k < group.base.cols(); ++k)
    for (Eigen::Index i = 0; i < group.base.rows(); ++i) {
      const int s = group.slot(i, k);
      points(first + i, k) = s < 0 ? group.base(i, k) : u[s];
    }
}

Eigen::MatrixXd rows_at(const RowGroup& group, const Eigen::VectorXd& u) {
  Eigen::MatrixXd points(group.base.rows(), group.base.cols());
  place_rows(group, u, points, 0);
  return points;
}

double log_normal_density(const RowGroup& group, const surrogate::Prediction& prediction) {
  Eigen::MatrixXd covariance = prediction.covariance;
  covariance.diagonal() += group.variance;
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  if (factor.info() != Eigen::Success) return nowhere;
  Eigen::VectorXd residual = group.observed - prediction.mean;
  factor.matrixL().solveInPlace(residual);
  const double log_root = factor.matrixLLT().diagonal().array().log().sum();
  const double rows = static_cast<double>(residual.size());
  return -0.5 * residual.squaredNorm() - log_root - 0.5 * rows * std::log(2.0 * std::numbers::pi);
}

/// Adds the gradient of one group's log density to `sum`.
void add_gradient(const RowGroup& group, const Eigen::VectorXd& u, Evaluation& sum) {
  if (!group.uniform || !group.emulator.predict_with_gradient) {
    // No derivative along a common shift: central differences.
    sum.value += log_normal_density(group, group.emulator.predict(rows_at(group, u)));
    constexpr double step = 1e-5;
    for (Eigen::Index s = 0; s < u.size(); ++s) {
      if (!(group.slot.array() == static_cast<int>(s)).any()) continue;
      Eigen::VectorXd shifted = u;
      shifted[s] = u[s] + step;
      const double up = log_normal_density(group, group.emulator.predict(rows_at(group, shifted)));
      shifted[s] = u[s] - step;
      const double down = log_normal_density(group, group.emulator.predict(rows_at(group, shifted)));
      sum.gradient[s] += (up - down) / (2.0 * step);
    }
    return;
  }
  std::vector<int> coordinates;
  std::vector<Eigen::Index> slots;
  for (std::size_t s = 0; s < group.coordinate.size(); ++s)
    if (group.coordinate[s]) {
      coordinates.push_back(*group.coordinate[s]);
      slots.push_back(static_cast<Eigen::Index>(s));
    }
  const surrogate::PredictionGradient found = group.emulator.predict_with_gradient(rows_at(group, u), coordinates);
  Eigen::MatrixXd covariance = found.value.covariance;
  covariance.diagonal() += group.variance;
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  if (factor.info() != Eigen::Success) {
    sum.value = nowhere;
    return;
  }
  const Eigen::Index rows = group.observed.size();
  const Eigen::VectorXd residual = group.observed - found.value.mean;
  const Eigen::VectorXd a = factor.solve(residual);
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(rows, rows));
  sum.value += -0.5 * residual.dot(a) - factor.matrixLLT().diagonal().array().log().sum() -
               0.5 * static_cast<double>(rows) * std::log(2.0 * std::numbers::pi);
  for (std::size_t k = 0; k < slots.size(); ++k) {
    const Eigen::MatrixXd& slope = found.covariance_gradient[k];
    sum.gradient[slots[k]] +=
        a.dot(found.mean_gradient[k]) + 0.5 * (a.dot(slope * a) - inverse.cwiseProduct(slope).sum());
  }
}

}  // namespace

StackedPrediction predict(const CaseModel& model, const Eigen::VectorXd& u) {
  const Eigen::Index rows = model.row_count();
  StackedPrediction stacked{.mean = Eigen::VectorXd(rows), .covariance = Eigen::MatrixXd::Zero(rows, rows)};
  Eigen::Index first = 0;
  for (const auto& group : model.groups) {
    const surrogate::Prediction part = group.emulator.predict(rows_at(group, u));
    const Eigen::Index count = part.mean.size();
    stacked.mean.segment(first, count) = part.mean;
    stacked.covariance.block(first, first, count, count) = part.covariance;
    first += count;
  }
  return stacked;
}

double log_prior(const CaseModel& model, const Eigen::VectorXd& u) {
  double sum = 0.0;
  for (std::size_t s = 0; s < model.slots.size(); ++s)
    sum += model.slots[s].prior.log_density(u[static_cast<Eigen::Index>(s)]);
  return sum;
}

Evaluation log_prior_gradient(const CaseModel& model, const Eigen::VectorXd& u) {
  Evaluation found{.value = log_prior(model, u), .gradient = Eigen::VectorXd(u.size())};
  for (std::size_t s = 0; s < model.slots.size(); ++s)
    found.gradient[static_cast<Eigen::Index>(s)] = model.slots[s].prior.slope(u[static_cast<Eigen::Index>(s)]);
  return found;
}

double log_likelihood(const CaseModel& model, const Eigen::VectorXd& u) {
  double sum = 0.0;
  for (const auto& group : model.groups) sum += log_normal_density(group, group.emulator.predict(rows_at(group, u)));
  return sum;
}

Evaluation log_likelihood_gradient(const CaseModel& model, const Eigen::VectorXd& u) {
  Evaluation sum{.value = 0.0, .gradient = Eigen::VectorXd::Zero(u.size())};
  for (const auto& group : model.groups) add_gradient(group, u, sum);
  return sum;
}

Eigen::VectorXd log_likelihoods(const CaseModel& model, const Eigen::MatrixXd& points) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(points.rows());
  for (const auto& group : model.groups) {
    const Eigen::Index rows = group.base.rows();
    if (!group.emulator.predict_batch) {
      for (Eigen::Index i = 0; i < points.rows(); ++i)
        sums[i] += log_normal_density(group, group.emulator.predict(rows_at(group, points.row(i).transpose())));
      continue;
    }
    constexpr Eigen::Index block = 32;
    for (Eigen::Index from = 0; from < points.rows(); from += block) {
      const Eigen::Index count = std::min(block, points.rows() - from);
      Eigen::MatrixXd stacked(count * rows, group.base.cols());
      for (Eigen::Index i = 0; i < count; ++i) place_rows(group, points.row(from + i).transpose(), stacked, i * rows);
      const std::vector<surrogate::Prediction> found = group.emulator.predict_batch(stacked, static_cast<int>(rows));
      for (Eigen::Index i = 0; i < count; ++i)
        sums[from + i] += log_normal_density(group, found[static_cast<std::size_t>(i)]);
    }
  }
  return sums;
}

Eigen::VectorXd pointwise_log_likelihood(const CaseModel& model, const Eigen::VectorXd& u) {
  const StackedPrediction prediction = predict(model, u);
  const Eigen::ArrayXd variance = (prediction.covariance.diagonal() + observed_variance(model)).array();
  const Eigen::ArrayXd residual = (observed(model) - prediction.mean).array();
  return -0.5 * (residual.square() / variance + (2.0 * std::numbers::pi * variance).log());
}

double chi_squared(const StackedPrediction& prediction, const Eigen::VectorXd& variance, const Eigen::VectorXd& y) {
  Eigen::MatrixXd covariance = prediction.covariance;
  covariance.diagonal() += variance;
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  Eigen::VectorXd residual = y - prediction.mean;
  factor.matrixL().solveInPlace(residual);
  return residual.squaredNorm();
}

Target posterior_target(std::shared_ptr<const CaseModel> model) {
  Target target{.dimension = model->dimension(), .lower = model->lower(), .upper = model->upper()};
  target.reference.draw = [model](data::RandomStream& random) {
    Eigen::VectorXd u(model->dimension());
    for (Eigen::Index s = 0; s < u.size(); ++s) u[s] = model->slots[static_cast<std::size_t>(s)].prior.draw(random);
    return u;
  };
  target.reference.log_density = [model](const Eigen::VectorXd& u) { return log_prior(*model, u); };
  target.log_density = [model](const Eigen::VectorXd& u) -> double {
    return log_prior(*model, u) + log_likelihood(*model, u);
  };
  target.log_density_gradient = [model](const Eigen::VectorXd& u) -> Evaluation {
    const Evaluation prior = log_prior_gradient(*model, u), likelihood = log_likelihood_gradient(*model, u);
    const Eigen::VectorXd gradient = prior.gradient + likelihood.gradient;
    return {.value = prior.value + likelihood.value, .gradient = gradient};
  };
  target.log_densities = [model](const Eigen::MatrixXd& points) -> Eigen::VectorXd {
    Eigen::VectorXd sums = log_likelihoods(*model, points);
    for (Eigen::Index i = 0; i < points.rows(); ++i) sums[i] += log_prior(*model, points.row(i).transpose());
    return sums;
  };
  return target;
}

Eigen::MatrixXd sensitivity(const CaseModel& model, const Eigen::VectorXd& u) {
  // Differences of second order, one-sided at the support's ends, so that any emulator and any binding of rows will do.
  Eigen::MatrixXd slopes(model.row_count(), u.size());
  const Eigen::VectorXd lower = model.lower(), upper = model.upper();
  for (Eigen::Index s = 0; s < u.size(); ++s) {
    const double step = 1e-4 * (upper[s] - lower[s]);
    Eigen::VectorXd high = u, low = u;
    high[s] = std::min(u[s] + step, upper[s]);
    low[s] = std::max(u[s] - step, lower[s]);
    slopes.col(s) = (predict(model, high).mean - predict(model, low).mean) / (high[s] - low[s]);
  }
  return slopes;
}

}  // namespace uq
