#include "uq/held.hpp"

#include <algorithm>
#include <cmath>

#include "uq/factor.hpp"
#include "uq/posterior.hpp"
#include "uq/predictive.hpp"

namespace uq {
namespace {

std::vector<int> unknowns_left(int dimension, const std::vector<Held>& held) {
  std::vector<int> left;
  for (int k = 0; k < dimension; ++k)
    if (std::none_of(held.begin(), held.end(), [&](const Held& one) { return one.coordinate == k; })) left.push_back(k);
  return left;
}

/// Log of the mean of exponentials of each column.
Eigen::VectorXd log_mean_exp(const Eigen::MatrixXd& values) {
  Eigen::VectorXd found(values.cols());
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    const double top = values.col(j).maxCoeff();
    found[j] = top + std::log((values.col(j).array() - top).exp().mean());
  }
  return found;
}

}  // namespace

Eigen::MatrixXd with_held(const Eigen::MatrixXd& rest, const std::vector<Held>& held) {
  const auto dimension = static_cast<int>(rest.cols() + static_cast<Eigen::Index>(held.size()));
  const std::vector<int> left = unknowns_left(dimension, held);
  Eigen::MatrixXd all(rest.rows(), dimension);
  for (std::size_t k = 0; k < left.size(); ++k) all.col(left[k]) = rest.col(static_cast<Eigen::Index>(k));
  for (const Held& one : held) all.col(one.coordinate).setConstant(one.value);
  return all;
}

Target held_target(std::shared_ptr<const CaseModel> model, const std::vector<Held>& held) {
  const std::vector<int> left = unknowns_left(model->dimension(), held);
  const auto prior_of = [model, left](Eigen::Index k) -> const ScaledPrior& {
    return model->slots[static_cast<std::size_t>(left[static_cast<std::size_t>(k)])].prior;
  };
  const auto log_prior = [prior_of](const Eigen::VectorXd& rest) {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < rest.size(); ++k) sum += prior_of(k).log_density(rest[k]);
    return sum;
  };
  Target target{
      .dimension = static_cast<int>(left.size()), .lower = model->lower()(left), .upper = model->upper()(left)};
  target.reference.draw = [prior_of, count = target.dimension](data::RandomStream& random) {
    Eigen::VectorXd rest(count);
    for (Eigen::Index k = 0; k < rest.size(); ++k) rest[k] = prior_of(k).draw(random);
    return rest;
  };
  target.reference.log_density = log_prior;
  target.log_densities = [model, held, log_prior](const Eigen::MatrixXd& points) -> Eigen::VectorXd {
    Eigen::VectorXd sums = log_likelihoods(*model, with_held(points, held));
    for (Eigen::Index i = 0; i < points.rows(); ++i) sums[i] += log_prior(points.row(i).transpose());
    return sums;
  };
  target.log_density = [model, held, log_prior](const Eigen::VectorXd& rest) -> double {
    return log_likelihood(*model, with_held(rest.transpose(), held).row(0).transpose()) + log_prior(rest);
  };
  return target;
}

double surrogate_part(const CaseModel& full, const Eigen::MatrixXd& first, const Eigen::MatrixXd& second,
                      std::uint64_t seed) {
  constexpr int functions = 200;
  constexpr Eigen::Index rows_max = 900;
  const CaseModel& model = distinct_rows(full);
  Eigen::Index largest = 1;
  for (const RowGroup& group : model.groups) largest = std::max(largest, rows_asked(group));
  const Eigen::Index each = std::clamp<Eigen::Index>(rows_max / (2 * largest), 4, 60);
  const Eigen::MatrixXd one = thinned(first, each), other = thinned(second, each);
  Eigen::MatrixXd points(one.rows() + other.rows(), first.cols());
  points << one, other;
  // log N(y | f_j(u_i)) - log L(u_i): points x functions, summed over the groups.
  Eigen::MatrixXd ratio = Eigen::MatrixXd::Zero(points.rows(), functions);
  data::RandomStream random(seed, data::Purpose::surrogate_part);
  for (const RowGroup& group : model.groups) {
    const Eigen::Index rows = rows_asked(group);
    Eigen::MatrixXd stacked(points.rows() * rows, group.base.cols());
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      stacked.middleRows(i * rows, rows) = rows_at(group, points.row(i).transpose());
    const surrogate::Prediction joint = group.emulator.predict(stacked);
    if (!(joint.covariance.diagonal().maxCoeff() > 0.0)) continue;
    const Factor root = factor(joint.covariance, "the surrogate at the posterior's draws");
    Eigen::MatrixXd normal(stacked.rows(), functions);
    for (double& value : normal.reshaped()) value = random.normal();
    Eigen::MatrixXd f = root.llt.matrixL() * normal;
    f.colwise() += joint.mean;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const Eigen::VectorXd u = points.row(i).transpose();
      const surrogate::Prediction here{.mean = joint.mean.segment(i * rows, rows),
                                       .covariance = joint.covariance.block(i * rows, i * rows, rows, rows)};
      const double level = log_group_density(model, group, here, u);
      for (Eigen::Index j = 0; j < functions; ++j)
        ratio(i, j) +=
            log_group_density(
                model, group,
                {.mean = f.col(j).segment(i * rows, rows), .covariance = Eigen::MatrixXd::Zero(rows, rows)}, u) -
            level;
    }
  }
  const Eigen::VectorXd difference =
      log_mean_exp(ratio.topRows(one.rows())) - log_mean_exp(ratio.bottomRows(other.rows()));
  return std::sqrt((difference.array() - difference.mean()).square().mean());
}

}  // namespace uq
