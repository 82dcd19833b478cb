#include "uq/posterior/held.hpp"

#include <algorithm>
#include <cmath>

#include "uq/infer/factor.hpp"
#include "uq/posterior/distinct.hpp"
#include "uq/posterior/posterior.hpp"

namespace uq {
namespace {

/// A side's quadratic form in the surrogate's error of one group's rows.
struct Side {
  Eigen::MatrixXd rows;       ///< rows at which the emulator is asked
  Eigen::MatrixXd jacobian;   ///< slopes of the readings, one column per free unknown
  Eigen::MatrixXd precision;  ///< S^-1
  Eigen::VectorXd residual;   ///< y - mean
};

Side side_at(const CaseModel& exact, const RowGroup& group, const ComparedSide& at) {
  constexpr double step = 1e-3;  // unit cube
  const GroupLaw law = group_law(exact, group, at.best);
  Side side{.rows = rows_at(group, at.best).topRows(group.base.rows()),
            .jacobian = Eigen::MatrixXd(law.mean.size(), static_cast<Eigen::Index>(at.free.size())),
            .precision = {},
            .residual = group.observed - law.mean};
  for (std::size_t k = 0; k < at.free.size(); ++k) {
    Eigen::VectorXd up = at.best, down = at.best;
    up[at.free[k]] += step;
    down[at.free[k]] -= step;
    side.jacobian.col(k) = (group_law(exact, group, up).mean - group_law(exact, group, down).mean) / (2.0 * step);
  }
  Eigen::MatrixXd covariance = law.covariance;
  covariance.diagonal() += law.noise;
  const Factor root = factor(covariance, "the measurement at a compared point");
  side.precision = root.llt.solve(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
  return side;
}

/// M and M r of a side over all groups, rows in their order.
struct Form {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd linear;
  double square = 0.0;  ///< r' M r
};

/// The log of the mean of exp(form) over delta ~ N(0, C), without the constant that the two have in common.
double log_mean_of(const Form& form, const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd seen =
      Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()) + covariance * form.matrix;
  const Eigen::PartialPivLU<Eigen::MatrixXd> factors(seen);
  // r' (I + M C)^-1 M r = r' M r - (M r)' (I + C M)^-1 C (M r)
  const double square = form.square - form.linear.dot(factors.solve(covariance * form.linear));
  return -0.5 * square - 0.5 * factors.matrixLU().diagonal().array().abs().log().sum();
}

Form form_of(const std::vector<Side>& groups) {
  Eigen::Index rows = 0;
  for (const Side& one : groups) rows += one.residual.size();
  const Eigen::Index unknowns = groups.front().jacobian.cols();
  Form form{.matrix = Eigen::MatrixXd::Zero(rows, rows), .linear = {}};
  Eigen::MatrixXd weighted(rows, unknowns), information = Eigen::MatrixXd::Identity(unknowns, unknowns);
  Eigen::VectorXd residual(rows);
  Eigen::Index at = 0;
  for (const Side& one : groups) {
    const Eigen::Index n = one.residual.size();
    form.matrix.block(at, at, n, n) = one.precision;
    weighted.middleRows(at, n) = one.precision * one.jacobian;
    information += one.jacobian.transpose() * weighted.middleRows(at, n);
    residual.segment(at, n) = one.residual;
    at += n;
  }
  form.matrix -= weighted * information.llt().solve(weighted.transpose());
  form.linear = form.matrix * residual;
  form.square = residual.dot(form.linear);
  return form;
}

}  // namespace

std::vector<int> unknowns_left(int dimension, const std::vector<Held>& held) {
  std::vector<int> left;
  for (int k = 0; k < dimension; ++k)
    if (std::none_of(held.begin(), held.end(), [&](const Held& one) { return one.coordinate == k; })) left.push_back(k);
  return left;
}

Eigen::MatrixXd with_held(const Eigen::MatrixXd& rest, const std::vector<Held>& held) {
  const auto dimension = static_cast<int>(rest.cols() + static_cast<Eigen::Index>(held.size()));
  const std::vector<int> left = unknowns_left(dimension, held);
  Eigen::MatrixXd all(rest.rows(), dimension);
  for (std::size_t k = 0; k < left.size(); ++k) all.col(left[k]) = rest.col(k);
  for (const Held& one : held) all.col(one.coordinate).setConstant(one.value);
  return all;
}

Target held_target(const std::shared_ptr<const CaseModel>& model, const std::vector<Held>& held) {
  const std::vector<int> left = unknowns_left(model->dimension(), held);
  const auto prior_of = [model, left](Eigen::Index k) -> const ScaledPrior& {
    return model->unknowns[static_cast<std::size_t>(left[k])].prior;
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

SharperFactor sharper_factor(const CaseModel& full, const ComparedSide& first, const ComparedSide& second) {
  const CaseModel& model = distinct_rows(full);
  const CaseModel exact = without_surrogate_error(model);
  std::vector<Side> one, other;
  for (const RowGroup& group : exact.groups) {
    one.push_back(side_at(exact, group, first));
    other.push_back(side_at(exact, group, second));
  }
  const Form a = form_of(one), b = form_of(other);
  // C of the first side's rows, then of the second's.
  const Eigen::Index rows = a.linear.size();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(2 * rows, 2 * rows);
  Eigen::Index at = 0;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const Eigen::Index n = one[g].residual.size();
    Eigen::MatrixXd stacked(2 * n, one[g].rows.cols());
    stacked << one[g].rows, other[g].rows;
    const Eigen::MatrixXd joint = model.groups[g].emulator.predict(stacked).covariance;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        covariance.block(i * rows + at, j * rows + at, n, n) = joint.block(i * n, j * n, n, n);
    at += n;
  }
  Eigen::MatrixXd form = Eigen::MatrixXd::Zero(2 * rows, 2 * rows);  // A
  form.topLeftCorner(rows, rows) = -0.5 * a.matrix;
  form.bottomRightCorner(rows, rows) = 0.5 * b.matrix;
  Eigen::VectorXd slope(2 * rows);
  slope << a.linear, -b.linear;
  // The law of delta given the data: covariance (C^-1 + E)^-1, E the first side's form; mean this covariance times E r.
  Eigen::MatrixXd seen = Eigen::MatrixXd::Identity(2 * rows, 2 * rows);
  seen.leftCols(rows) += covariance.leftCols(rows) * a.matrix;
  const Eigen::MatrixXd left = seen.partialPivLu().solve(covariance);
  const Eigen::VectorXd mean = left.leftCols(rows) * a.linear;
  const Eigen::MatrixXd spread = form * left;
  const double of_mean_evidences =
      log_mean_of(a, covariance.topLeftCorner(rows, rows)) - log_mean_of(b, covariance.bottomRightCorner(rows, rows));
  const double of_form = mean.dot(form * mean) + spread.trace() + slope.dot(mean) - 0.5 * (a.square - b.square);
  slope += 2.0 * form * mean;
  const double variance = slope.dot(left * slope) + 2.0 * spread.cwiseProduct(spread.transpose()).sum();
  return {.shift = of_form - of_mean_evidences, .sd = std::sqrt(std::max(0.0, variance))};
}

}  // namespace uq
