#include "uq/posterior/posterior.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

#include "uq/infer/factor.hpp"
#include "uq/posterior/differences.hpp"
#include "uq/posterior/distinct.hpp"

namespace uq {
namespace {

constexpr Eigen::Index points_at_once = 32;  // predicted together

/// Writes the rows of a group at u into `points`, from row `first` on.
void place_rows(const RowGroup& group, const Eigen::VectorXd& u, Eigen::MatrixXd& points, Eigen::Index first) {
  for (Eigen::Index k = 0; k < group.base.cols(); ++k)
    for (Eigen::Index i = 0; i < group.base.rows(); ++i) points(first + i, k) = group.input(i, k, u);
  if (group.measurement.shifts() > 0) place_shifts(group.measurement, points, first, group.base.rows());
}

/// Whether all points ask the emulator at the same rows: they differ in unknowns that it does not see.
bool ask_the_same(const RowGroup& group, const Eigen::MatrixXd& points) {
  for (Eigen::Index s = 0; s < points.cols(); ++s)
    if ((points.col(s).array() != points(0, s)).any() && (group.unknown.array() == static_cast<int>(s)).any())
      return false;
  return true;
}

double log_normal(const Eigen::VectorXd& residual, const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  if (factor.info() != Eigen::Success) return nowhere;
  const Eigen::VectorXd whitened = factor.matrixL().solve(residual);
  const double log_root = factor.matrixLLT().diagonal().array().log().sum();
  const double rows = static_cast<double>(residual.size());
  return -0.5 * whitened.squaredNorm() - log_root - 0.5 * rows * std::log(2.0 * std::numbers::pi);
}

/// Log density of a group's numbers without what repeats say of their own scatter.
double log_row_density(const CaseModel& model, const RowGroup& group, const surrogate::Prediction& prediction,
                       const Eigen::VectorXd& u) {
  if (group.measurement.plain()) {
    Eigen::MatrixXd covariance = prediction.covariance;
    covariance.diagonal() += group.variance;
    return log_normal(group.observed - prediction.mean, covariance);
  }
  GroupLaw law = law_of(group.measurement, model.unknowns, group.variance, prediction, u);
  law.covariance.diagonal() += law.noise;
  return log_normal(group.observed - law.mean, law.covariance);
}

/// The laws of all groups' distinct rows at u.
std::vector<GroupLaw> laws_at(const CaseModel& full, const Eigen::VectorXd& u) {
  const CaseModel& model = distinct_rows(full);
  std::vector<GroupLaw> laws;
  for (const RowGroup& group : model.groups) laws.push_back(group_law(model, group, u));
  return laws;
}

/// Log density of all numbers together, where own errors are linked.
double log_linked_density(const CaseModel& model, const std::vector<GroupLaw>& laws, const Eigen::VectorXd& u) {
  const StackedPrediction stacked = stack(model, laws, u);
  return log_normal(observed(model) - stacked.mean, stacked.total());
}

}  // namespace

Eigen::Index rows_asked(const RowGroup& group) { return group.base.rows() * (1 + group.measurement.shifts()); }

Eigen::MatrixXd rows_at(const RowGroup& group, const Eigen::VectorXd& u) {
  Eigen::MatrixXd points(rows_asked(group), group.base.cols());
  place_rows(group, u, points, 0);
  return points;
}

double log_group_density(const CaseModel& model, const RowGroup& group, const surrogate::Prediction& prediction,
                         const Eigen::VectorXd& u) {
  double sum = log_row_density(model, group, prediction, u);
  for (const Repeats& repeats : group.repeats) sum += scatter_of(model, repeats, u).log_density;
  return sum;
}

GroupLaw group_law(const CaseModel& model, const RowGroup& group, const Eigen::VectorXd& u) {
  return law_of(group.measurement, model.unknowns, group.variance, group.emulator.predict(rows_at(group, u)), u);
}

StackedPrediction stack(const CaseModel& model, const std::vector<GroupLaw>& laws, const Eigen::VectorXd& u) {
  const Eigen::Index rows = model.row_count();
  std::vector<Eigen::Index> begins;
  StackedPrediction stacked{.mean = Eigen::VectorXd(rows),
                            .covariance = Eigen::MatrixXd::Zero(rows, rows),
                            .noise = Eigen::VectorXd(rows),
                            .linked_errors = model.linked_errors};
  Eigen::Index first = 0;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const RowGroup& group = model.groups[g];
    const Eigen::Index count = group.observed.size();
    begins.push_back(first);
    if (model.distinct) {
      stacked.mean.segment(first, count) = laws[g].mean(group.distinct_row);
      stacked.covariance.block(first, first, count, count) = laws[g].covariance(group.distinct_row, group.distinct_row);
    } else {
      stacked.mean.segment(first, count) = laws[g].mean;
      stacked.covariance.block(first, first, count, count) = laws[g].covariance;
    }
    stacked.noise.segment(first, count) = noise_of(group.measurement, model.unknowns, group.variance, u);
    first += count;
  }
  for (const LinkedSettings& link : model.linked_settings) {
    const Eigen::VectorXd& a = laws[link.first_group].settings[link.first_setting];
    const Eigen::VectorXd& b = laws[link.second_group].settings[link.second_setting];
    const Eigen::Index row = begins[link.first_group] + link.first_row;
    const Eigen::Index column = begins[link.second_group] + link.second_row;
    const Eigen::MatrixXd shared = (a * b.transpose()).cwiseProduct(link.same);
    stacked.covariance.block(row, column, a.size(), b.size()) += shared;
    stacked.covariance.block(column, row, b.size(), a.size()) += shared.transpose();
  }
  return stacked;
}

StackedPrediction predict(const CaseModel& model, const Eigen::VectorXd& u) {
  return stack(model, laws_at(model, u), u);
}

RowMoments moments(const CaseModel& model, const std::vector<GroupLaw>& laws, const Eigen::VectorXd& u) {
  RowMoments found{.mean = Eigen::VectorXd(model.row_count()), .variance = Eigen::VectorXd(model.row_count())};
  Eigen::Index first = 0;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const RowGroup& group = model.groups[g];
    const Eigen::VectorXd noise = noise_of(group.measurement, model.unknowns, group.variance, u);
    for (Eigen::Index i = 0; i < noise.size(); ++i) {
      const Eigen::Index at = model.distinct ? group.distinct_row[i] : i;
      found.mean[first + i] = laws[g].mean[at];
      found.variance[first + i] = laws[g].covariance(at, at) + noise[i];
    }
    first += noise.size();
  }
  return found;
}

RowMoments row_moments(const CaseModel& model, const Eigen::VectorXd& u) {
  return moments(model, laws_at(model, u), u);
}

std::vector<surrogate::Prediction> predictions(const RowGroup& group, const Eigen::MatrixXd& points) {
  std::vector<surrogate::Prediction> found;
  if (points.rows() > 1 && ask_the_same(group, points)) {
    const std::vector<surrogate::Prediction> one = predictions(group, points.topRows(1));
    found.assign(static_cast<std::size_t>(points.rows()), one.front());
    return found;
  }
  if (!group.emulator.predict_batch) {
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      found.push_back(group.emulator.predict(rows_at(group, points.row(i).transpose())));
    return found;
  }
  const Eigen::Index rows = rows_asked(group);
  Eigen::MatrixXd stacked(points.rows() * rows, group.base.cols());
  for (Eigen::Index i = 0; i < points.rows(); ++i) place_rows(group, points.row(i).transpose(), stacked, i * rows);
  return group.emulator.predict_batch(stacked, static_cast<int>(rows));
}

void for_each_law(const CaseModel& full, const Eigen::MatrixXd& points,
                  const std::function<void(Eigen::Index point, const std::vector<GroupLaw>& laws)>& use) {
  const CaseModel& model = distinct_rows(full);
  for (Eigen::Index from = 0; from < points.rows(); from += points_at_once) {
    const Eigen::MatrixXd part = points.middleRows(from, std::min(points_at_once, points.rows() - from));
    std::vector<std::vector<surrogate::Prediction>> found;
    for (const RowGroup& group : model.groups) found.push_back(predictions(group, part));
    for (Eigen::Index i = 0; i < part.rows(); ++i) {
      std::vector<GroupLaw> laws;
      for (std::size_t g = 0; g < model.groups.size(); ++g) {
        const RowGroup& group = model.groups[g];
        laws.push_back(law_of(group.measurement, model.unknowns, group.variance, found[g][i], part.row(i).transpose()));
      }
      use(from + i, laws);
    }
  }
}

double log_prior(const CaseModel& model, const Eigen::VectorXd& u) {
  double sum = 0.0;
  for (std::size_t s = 0; s < model.unknowns.size(); ++s) sum += model.unknowns[s].prior.log_density(u[s]);
  return sum;
}

Evaluation log_prior_gradient(const CaseModel& model, const Eigen::VectorXd& u) {
  Evaluation found{.value = log_prior(model, u), .gradient = Eigen::VectorXd(u.size())};
  for (std::size_t s = 0; s < model.unknowns.size(); ++s) found.gradient[s] = model.unknowns[s].prior.slope(u[s]);
  return found;
}

double log_likelihood(const CaseModel& full, const Eigen::VectorXd& u) {
  const CaseModel& model = distinct_rows(full);
  if (model.joint()) return log_linked_density(model, laws_at(model, u), u);
  double sum = 0.0;
  for (const auto& group : model.groups)
    sum += log_group_density(model, group, group.emulator.predict(rows_at(group, u)), u);
  return sum;
}

Eigen::VectorXd log_likelihoods(const CaseModel& full, const Eigen::MatrixXd& points) {
  const CaseModel& model = distinct_rows(full);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(points.rows());
  if (model.joint()) {
    for_each_law(model, points, [&](Eigen::Index point, const std::vector<GroupLaw>& laws) {
      sums[point] = log_linked_density(model, laws, points.row(point).transpose());
    });
    return sums;
  }
  for (const auto& group : model.groups)
    for (Eigen::Index from = 0; from < points.rows(); from += points_at_once) {
      const Eigen::MatrixXd part = points.middleRows(from, std::min(points_at_once, points.rows() - from));
      const std::vector<surrogate::Prediction> found = predictions(group, part);
      for (Eigen::Index i = 0; i < part.rows(); ++i)
        sums[from + i] += log_group_density(model, group, found[i], part.row(i).transpose());
    }
  return sums;
}

Eigen::MatrixXd pointwise_log_likelihoods(const CaseModel& model, const Eigen::MatrixXd& points) {
  Eigen::MatrixXd values(points.rows(), model.row_count());
  const Eigen::ArrayXd y = observed(model).array();
  for_each_law(model, points, [&](Eigen::Index point, const std::vector<GroupLaw>& laws) {
    const RowMoments found = moments(model, laws, points.row(point).transpose());
    const Eigen::ArrayXd variance = found.variance.array(), residual = y - found.mean.array();
    values.row(point) = -0.5 * (residual.square() / variance + (2.0 * std::numbers::pi * variance).log()).transpose();
  });
  return values;
}

double chi_squared(const StackedPrediction& prediction, const Eigen::VectorXd& y, double noise_factor) {
  const Factor root = factor(prediction.total(noise_factor), "the data under the model");
  Eigen::VectorXd residual = y - prediction.mean;
  root.llt.matrixL().solveInPlace(residual);
  return residual.squaredNorm();
}

double chi_squared(const CaseModel& full, const std::vector<GroupLaw>& laws, const Eigen::VectorXd& u) {
  const CaseModel& model = distinct_rows(full);
  double sum = chi_squared(stack(model, laws, u), observed(model));
  for (const RowGroup& group : model.groups)
    for (const Repeats& repeats : group.repeats) sum += scatter_of(model, repeats, u).chi_squared;
  return sum;
}

double chi_squared(const CaseModel& model, const Eigen::VectorXd& u) {
  return chi_squared(model, laws_at(model, u), u);
}

Evaluation log_certificates(const CaseModel& model, const Eigen::VectorXd& u) {
  Evaluation sum{.value = 0.0, .gradient = Eigen::VectorXd::Zero(u.size())};
  for (std::size_t k = 0; k < model.unknowns.size(); ++k) {
    const Unknown& unknown = model.unknowns[k];
    const auto s = static_cast<Eigen::Index>(k);
    if (unknown.nuisance) {
      sum.value += unknown.prior.log_density(u[s]);
      sum.gradient[s] = unknown.prior.slope(u[s]);
    } else if (unknown.cut) {
      sum.value += unknown.cut->log_density(u[s]);
      sum.gradient[s] = unknown.cut->slope(u[s]);
    }
  }
  return sum;
}

Target posterior_target(const std::shared_ptr<const CaseModel>& model) {
  Target target{.dimension = model->dimension(), .lower = model->lower(), .upper = model->upper()};
  target.reference.draw = [model](data::RandomStream& random) {
    Eigen::VectorXd u(model->dimension());
    for (Eigen::Index s = 0; s < u.size(); ++s) u[s] = model->unknowns[s].prior.draw(random);
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
  // Central differences, of first order and one-sided at the support's ends, so that any emulator and any binding of
  // rows will do.
  Eigen::MatrixXd slopes(model.row_count(), u.size());
  for (Eigen::Index s = 0; s < u.size(); ++s) {
    const BothSides at = both_sides(model, u, s, 1e-4);
    slopes.col(s) = (row_moments(model, at.high).mean - row_moments(model, at.low).mean) / at.apart;
  }
  return slopes;
}

}  // namespace uq
