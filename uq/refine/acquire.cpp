#include "uq/refine/acquire.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "surrogate/design.hpp"
#include "surrogate/log_sum.hpp"
#include "uq/posterior/posterior.hpp"

namespace uq {
namespace {

using Eigen::Index;
using surrogate::log_sum;

/// log(exp(a) + exp(b)).
double log_add(double a, double b) {
  const double high = std::max(a, b);
  return std::isfinite(high) ? high + std::log1p(std::exp(std::min(a, b) - high)) : high;
}

/// The emulator's inputs of a group's rows at u, without the shifted copies.
Eigen::MatrixXd unshifted_rows(const RowGroup& group, const Eigen::VectorXd& u) {
  Eigen::MatrixXd points(group.base.rows(), group.base.cols());
  for (Index k = 0; k < points.cols(); ++k)
    for (Index i = 0; i < points.rows(); ++i) points(i, k) = group.input(i, k, u);
  return points;
}

/// Half the log determinant, from a Cholesky factor.
double log_root(const Eigen::LLT<Eigen::MatrixXd>& factor) { return factor.matrixLLT().diagonal().array().log().sum(); }

/// Logs of (E p)^2 and of E p^2 of one group, the prior left out; minus infinity where a covariance is not definite.
struct Squares {
  double of_mean = nowhere, mean = nowhere;
};

Squares squares_of(const Eigen::VectorXd& residual, const Eigen::MatrixXd& total, const Eigen::MatrixXd& error) {
  const Eigen::LLT<Eigen::MatrixXd> whole(total), alone(error), half(total - 0.5 * error);
  if (whole.info() != Eigen::Success || alone.info() != Eigen::Success || half.info() != Eigen::Success) return {};
  const double rows = static_cast<double>(residual.size());
  const double two_pi = std::log(2.0 * std::numbers::pi), four_pi = std::log(4.0 * std::numbers::pi);
  return {.of_mean = -residual.dot(whole.solve(residual)) - 2.0 * log_root(whole) - rows * two_pi,
          .mean = -0.5 * residual.dot(half.solve(residual)) - log_root(half) - log_root(alone) -
                  0.5 * rows * (two_pi + four_pi)};
}

/// Covariance of the emulator's values at `rows` with those at `runs`, and among the runs.
struct Cross {
  Eigen::MatrixXd with_runs, between;
  Eigen::VectorXd mean;  ///< mean of the runs
};

Cross cross_covariance(const Emulator& emulator, const Eigen::MatrixXd& rows, const Eigen::MatrixXd& runs) {
  constexpr Index block = 256;  // rows asked together with the runs
  Cross cross{.with_runs = Eigen::MatrixXd(rows.rows(), runs.rows()), .between = {}, .mean = {}};
  for (Index first = 0; first < rows.rows(); first += block) {
    const Index count = std::min(block, rows.rows() - first);
    Eigen::MatrixXd points(count + runs.rows(), rows.cols());
    points << rows.middleRows(first, count), runs;
    const surrogate::Prediction found = emulator.predict(points);
    cross.with_runs.middleRows(first, count) = found.covariance.topRightCorner(count, runs.rows());
    if (first > 0) continue;
    cross.between = found.covariance.bottomRightCorner(runs.rows(), runs.rows());
    cross.mean = found.mean.tail(runs.rows());
  }
  return cross;
}

}  // namespace

Eigen::MatrixXd emulator_points(const Emulator& emulator, const std::vector<RunPoint>& points) {
  Eigen::MatrixXd inputs(static_cast<Index>(points.size()), static_cast<Index>(emulator.inputs.size()));
  for (std::size_t k = 0; k < emulator.inputs.size(); ++k)
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto index = static_cast<Index>(emulator.inputs[k].index);
      inputs(static_cast<Index>(i), static_cast<Index>(k)) =
          emulator.inputs[k].kind == InputKind::parameter ? points[i].parameters[index] : points[i].controls[index];
    }
  return inputs;
}

ReferencePoints reference_points(const CaseModel& model, const Eigen::MatrixXd& draws, double log_evidence,
                                 const ReferenceOptions& options) {
  const Index unknowns = model.dimension();
  const Index from_draws = std::min<Index>(options.draws, draws.rows());
  const Index from_prior = options.prior;
  ReferencePoints reference{.u = Eigen::MatrixXd(from_draws + from_prior, unknowns), .log_weight = {}};
  // Draws evenly spaced along the chains, then the prior's points.
  for (Index i = 0; i < from_draws; ++i) reference.u.row(i) = draws.row(i * draws.rows() / from_draws);
  const Eigen::MatrixXd cube =
      surrogate::scrambled_sobol(static_cast<int>(from_prior), static_cast<int>(unknowns), options.seed);
  for (Index i = 0; i < from_prior; ++i)
    for (Index k = 0; k < unknowns; ++k)
      reference.u(from_draws + i, k) = model.unknowns[k].prior.inverse_cdf(cube(i, k));
  const Eigen::VectorXd log_likelihood = log_likelihoods(model, reference.u);
  if (!std::isfinite(log_evidence))
    log_evidence = log_sum(log_likelihood.tail(from_prior)) - std::log(static_cast<double>(from_prior));
  // The mixture's density, prior times (share of draws * likelihood / evidence + share of prior).
  const double all = static_cast<double>(from_draws + from_prior);
  const double share_of_draws = std::log(static_cast<double>(from_draws) / all),
               share_of_prior = std::log(static_cast<double>(from_prior) / all);
  reference.log_weight.resize(reference.u.rows());
  for (Index i = 0; i < reference.u.rows(); ++i)
    reference.log_weight[i] = -log_prior(model, reference.u.row(i).transpose()) -
                              log_add(share_of_draws + log_likelihood[i] - log_evidence, share_of_prior);
  return reference;
}

IntegratedVariance::IntegratedVariance(const CaseModel& model, const ReferencePoints& reference,
                                       const std::vector<RunPoint>& candidates, const std::vector<RunNoise>& noise)
    : candidates_(static_cast<int>(candidates.size())) {
  assert(noise.size() == model.groups.size());
  const CaseModel exact = without_surrogate_error(model);
  const Index points = reference.u.rows();
  log_square_ = reference.log_weight;
  Eigen::VectorXd log_mean_square = reference.log_weight;
  for (Index j = 0; j < points; ++j) {
    const double log_density = log_prior(model, reference.u.row(j).transpose());
    log_square_[j] += 2.0 * log_density;
    log_mean_square[j] += 2.0 * log_density;
  }
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const RowGroup& rows = model.groups[g];
    const Index count = rows.observed.size();
    Group group;
    group.residual.resize(count, points);
    Eigen::MatrixXd stacked(points * count, rows.base.cols());
    Eigen::VectorXd factor(points * count);
    for (Index j = 0; j < points; ++j) {
      const Eigen::VectorXd u = reference.u.row(j).transpose();
      const GroupLaw law = group_law(model, rows, u), law_exact = group_law(exact, exact.groups[g], u);
      Eigen::MatrixXd total = law.covariance, error = law_exact.covariance;
      total.diagonal() += law.noise;
      error.diagonal() += law.noise;
      group.residual.col(j) = rows.observed - law.mean;
      const Squares squares = squares_of(group.residual.col(j), total, error);
      log_square_[j] += squares.of_mean;
      log_mean_square[j] += squares.mean;
      group.less.push_back(total);
      group.more.push_back(std::move(total));
      stacked.middleRows(j * count, count) = unshifted_rows(rows, u);
      for (Index i = 0; i < count; ++i)
        factor[j * count + i] =
            rows.measurement.plain() ? 1.0 : meter_at(rows.measurement, model.unknowns, u, i).factor;
    }
    std::vector<RunPoint> members;
    for (std::size_t c = 0; c < candidates.size(); ++c)
      if (candidates[c].material == rows.emulator.material) {
        group.members.push_back(static_cast<int>(c));
        members.push_back(candidates[c]);
      }
    if (!members.empty()) {
      Cross cross = cross_covariance(rows.emulator, stacked, emulator_points(rows.emulator, members));
      group.cross = factor.asDiagonal() * cross.with_runs;
      group.between = std::move(cross.between);
      group.noise = (noise[g].absolute + noise[g].relative * cross.mean.array().square()).matrix();
    }
    groups_.push_back(std::move(group));
  }
  // A point where a covariance could not be factorised counts for nothing.
  for (Index j = 0; j < points; ++j)
    if (!std::isfinite(log_square_[j]) || !std::isfinite(log_mean_square[j]))
      log_square_[j] = log_mean_square[j] = nowhere;
  log_total_ = log_sum(log_mean_square);
}

Eigen::MatrixXd IntegratedVariance::log_factors(const Group& group, const std::vector<int>& members) const {
  const Index count = group.residual.rows(), points = group.residual.cols();
  Eigen::MatrixXd logs = Eigen::MatrixXd::Zero(points, static_cast<Index>(members.size()));
  Eigen::VectorXd variance(static_cast<Index>(members.size()));
  for (std::size_t k = 0; k < members.size(); ++k)
    variance[k] = group.between(members[k], members[k]) + group.noise[members[k]];
  Eigen::MatrixXd b(count, static_cast<Index>(members.size()));
  for (Index j = 0; j < points; ++j) {
    if (!std::isfinite(log_square_[j])) continue;
    const Eigen::LLT<Eigen::MatrixXd> less(group.less[j]), more(group.more[j]);
    if (less.info() != Eigen::Success || more.info() != Eigen::Success) continue;
    for (std::size_t k = 0; k < members.size(); ++k) b.col(k) = group.cross.block(j * count, members[k], count, 1);
    const Eigen::MatrixXd low = less.matrixL().solve(b), high = more.matrixL().solve(b);
    const Eigen::VectorXd pull = high.transpose() * more.matrixL().solve(group.residual.col(j)).eval();
    for (Index k = 0; k < variance.size(); ++k) {
      if (!(variance[k] > 0.0)) continue;  // a run of which all is known
      const double q_less = std::min(low.col(k).squaredNorm() / variance[k], 1.0 - 1e-12),
                   q_more = high.col(k).squaredNorm() / variance[k];
      logs(j, k) =
          -0.5 * std::log1p(-q_less) - 0.5 * std::log1p(q_more) + pull[k] * pull[k] / variance[k] / (1.0 + q_more);
    }
  }
  return logs;
}

Eigen::VectorXd IntegratedVariance::reductions() const {
  Eigen::MatrixXd logs = Eigen::MatrixXd::Zero(log_square_.size(), candidates_);
  for (const Group& group : groups_) {
    if (group.members.empty()) continue;
    std::vector<int> all(group.members.size());
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<int>(k);
    const Eigen::MatrixXd found = log_factors(group, all);
    for (std::size_t k = 0; k < all.size(); ++k) logs.col(group.members[k]) += found.col(k);
  }
  Eigen::VectorXd reductions = Eigen::VectorXd::Zero(candidates_);
  for (Index j = 0; j < log_square_.size(); ++j) {
    if (!std::isfinite(log_square_[j])) continue;
    // (factor - 1) times the square; both in logs, since a factor can be as large as the square is small.
    const double square = std::exp(log_square_[j] - log_total_);
    for (Index c = 0; c < candidates_; ++c)
      reductions[c] += logs(j, c) < 1.0 ? square * std::expm1(logs(j, c))
                                        : std::exp(log_square_[j] - log_total_ + logs(j, c)) - square;
  }
  return reductions;
}

double IntegratedVariance::variance() const {
  return std::clamp(1.0 - std::exp(log_sum(log_square_) - log_total_), 0.0, 1.0);
}

void IntegratedVariance::add(int candidate) {
  for (Group& group : groups_) {
    const auto found = std::find(group.members.begin(), group.members.end(), candidate);
    if (found == group.members.end()) continue;
    const auto k = static_cast<Index>(found - group.members.begin());
    const double variance = group.between(k, k) + group.noise[k];
    if (!(variance > 0.0)) continue;
    const Eigen::VectorXd logs = log_factors(group, {static_cast<int>(k)}).col(0);
    const Index count = group.residual.rows();
    const Eigen::VectorXd b = group.cross.col(k);
    const Eigen::RowVectorXd c = group.between.row(k);
    for (Index j = 0; j < group.residual.cols(); ++j) {
      if (std::isfinite(log_square_[j])) log_square_[j] += logs[j];
      const Eigen::VectorXd part = b.segment(j * count, count);
      group.less[j] -= part * part.transpose() / variance;
      group.more[j] += part * part.transpose() / variance;
    }
    group.cross -= b * (c / variance);
    group.between -= c.transpose() * (c / variance);
  }
}

}  // namespace uq
