#include "uq/posterior/posterior.hpp"

#include <cassert>
#include <cmath>
#include <iterator>
#include <numbers>

#include "uq/infer/factor.hpp"
#include "uq/posterior/distinct.hpp"

namespace uq {
namespace {

constexpr Eigen::Index points_at_once = 32;  // predicted together

/// Writes the rows of a group at u into `points`, from row `first` on.
void place_rows(const RowGroup& group, const Eigen::VectorXd& u, Eigen::MatrixXd& points, Eigen::Index first) {
  for (Eigen::Index k = 0; k < group.base.cols(); ++k)
    for (Eigen::Index i = 0; i < group.base.rows(); ++i) {
      const int s = group.unknown(i, k);
      points(first + i, k) = s < 0 ? group.base(i, k) : u[s];
    }
  if (group.measurement.shifts() > 0) place_shifts(group.measurement, points, first, group.base.rows());
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

/// What the scatter of repeats about their means says (uq/posterior/distinct.hpp), with its slope along the noise's factor.
struct Scatter {
  double log_density = 0.0, chi_squared = 0.0, slope = 0.0;  // slope: to u of the factor's unknown
};
Scatter scatter_of(const CaseModel& model, const Repeats& repeats, const Eigen::VectorXd& u) {
  if (repeats.noise < 0)
    return {.log_density = repeats.log_constant - 0.5 * repeats.scatter, .chi_squared = repeats.scatter};
  const Unknown& unknown = model.unknowns[repeats.noise];
  const double k = unknown.value(u[repeats.noise]), chi = repeats.scatter / (k * k);
  return {.log_density = repeats.log_constant - 0.5 * chi - repeats.extra * std::log(k),
          .chi_squared = chi,
          .slope = (chi - repeats.extra) / k * unknown.slope(u[repeats.noise])};
}

/// The law of a group's numbers and its slopes along the unknowns that move it.
struct GroupSlopes {
  GroupLaw law;
  LawGradient slopes;
};

/// By central differences, for an emulator without a derivative along a common shift.
GroupSlopes differenced(const CaseModel& model, const RowGroup& group, const Eigen::VectorXd& u) {
  constexpr double step = 1e-5;
  const auto total_at = [&](const Eigen::VectorXd& at) {
    GroupLaw law = group_law(model, group, at);
    law.covariance.diagonal() += law.noise;
    return law;
  };
  GroupSlopes found{.law = group_law(model, group, u), .slopes = {}};
  for (Eigen::Index s = 0; s < u.size(); ++s) {
    const bool nuisance = model.unknowns[s].nuisance.has_value();
    if (!nuisance && !(group.unknown.array() == static_cast<int>(s)).any()) continue;
    Eigen::VectorXd up = u, down = u;
    up[s] += step;
    down[s] -= step;
    const GroupLaw above = total_at(up), below = total_at(down);
    found.slopes.along.push_back(static_cast<int>(s));
    found.slopes.mean.emplace_back((above.mean - below.mean) / (2.0 * step));
    found.slopes.covariance.emplace_back((above.covariance - below.covariance) / (2.0 * step));
  }
  return found;
}

GroupSlopes slopes_of(const CaseModel& model, const RowGroup& group, const Eigen::VectorXd& u) {
  if (!group.uniform || !group.emulator.predict_with_gradient) return differenced(model, group, u);
  std::vector<int> coordinates, unknowns;
  for (std::size_t s = 0; s < group.coordinate.size(); ++s)
    if (group.coordinate[s]) {
      coordinates.push_back(*group.coordinate[s]);
      unknowns.push_back(static_cast<int>(s));
    }
  const surrogate::PredictionGradient found = group.emulator.predict_with_gradient(rows_at(group, u), coordinates);
  return {law_of(group.measurement, model.unknowns, group.variance, found.value, u),
          law_gradient(group.measurement, model.unknowns, group.variance, found, {unknowns, u})};
}

/// log N(residual; 0, covariance), and its gradient along the unknowns that move mean and covariance.
void add_normal(const Eigen::VectorXd& residual, const Eigen::MatrixXd& covariance, const LawGradient& slopes,
                Evaluation& sum) {
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  if (factor.info() != Eigen::Success) {
    sum.value = nowhere;
    return;
  }
  const Eigen::Index rows = residual.size();
  const Eigen::VectorXd a = factor.solve(residual);
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(rows, rows));
  sum.value += -0.5 * residual.dot(a) - factor.matrixLLT().diagonal().array().log().sum() -
               0.5 * static_cast<double>(rows) * std::log(2.0 * std::numbers::pi);
  for (std::size_t k = 0; k < slopes.along.size(); ++k) {
    const Eigen::MatrixXd& slope = slopes.covariance[k];
    sum.gradient[slopes.along[k]] +=
        a.dot(slopes.mean[k]) + 0.5 * (a.dot(slope * a) - inverse.cwiseProduct(slope).sum());
  }
}

/// Adds one group's log density and its gradient.
void add_group(const CaseModel& model, const RowGroup& group, const Eigen::VectorXd& u, Evaluation& sum) {
  const GroupSlopes found = slopes_of(model, group, u);
  Eigen::MatrixXd covariance = found.law.covariance;
  covariance.diagonal() += found.law.noise;
  add_normal(group.observed - found.law.mean, covariance, found.slopes, sum);
}

/// Adds the log density of all numbers together, whose own errors are linked, and its gradient.
void add_linked(const CaseModel& model, const Eigen::VectorXd& u, Evaluation& sum) {
  const Eigen::Index rows = model.row_count();
  std::vector<GroupLaw> laws;
  LawGradient all;
  std::vector<Eigen::VectorXd> noise;  // slopes of the own errors' variances
  std::vector<std::ptrdiff_t> place(model.unknowns.size(), -1);
  Eigen::Index first = 0;
  for (const RowGroup& group : model.groups) {
    GroupSlopes found = slopes_of(model, group, u);
    const Eigen::Index count = group.observed.size();
    for (std::size_t k = 0; k < found.slopes.along.size(); ++k) {
      const int s = found.slopes.along[k];
      if (place[s] < 0) {
        place[s] = std::ssize(all.along);
        all.along.push_back(s);
        all.mean.emplace_back(Eigen::VectorXd::Zero(rows));
        all.covariance.emplace_back(Eigen::MatrixXd::Zero(rows, rows));
        noise.emplace_back(Eigen::VectorXd::Zero(rows));
      }
      all.mean[place[s]].segment(first, count) += found.slopes.mean[k];
      all.covariance[place[s]].block(first, first, count, count) += found.slopes.covariance[k];
    }
    for (const ReadSet& set : group.measurement.sets)
      if (set.noise >= 0) {
        // The variance goes with the square of the unknown's value.
        const Unknown& unknown = model.unknowns[set.noise];
        const double slope = 2.0 * unknown.slope(u[set.noise]) / unknown.value(u[set.noise]);
        noise[place[set.noise]].segment(first + set.first, set.count) =
            slope * found.law.noise.segment(set.first, set.count);
      }
    laws.push_back(std::move(found.law));
    first += count;
  }
  const StackedPrediction stacked = stack(model, laws, u);
  for (std::size_t k = 0; k < all.along.size(); ++k)
    for (const LinkedErrors& pair : model.linked_errors) {
      const Eigen::Index i = pair.first, j = pair.second;
      const double root = std::sqrt(stacked.noise[i] * stacked.noise[j]);
      if (!(root > 0.0)) continue;
      const double slope =
          0.5 * pair.correlation * (noise[k][i] * stacked.noise[j] + stacked.noise[i] * noise[k][j]) / root;
      all.covariance[k](i, j) += slope;
      all.covariance[k](j, i) += slope;
    }
  add_normal(observed(model) - stacked.mean, stacked.total(), all, sum);
}

/// The laws of all groups' distinct rows at u.
std::vector<GroupLaw> laws_at(const CaseModel& full, const Eigen::VectorXd& u) {
  const CaseModel& model = distinct_rows(full);
  std::vector<GroupLaw> laws;
  for (const RowGroup& group : model.groups) laws.push_back(group_law(model, group, u));
  return laws;
}

/// Of all numbers together, where own errors are linked.
double log_linked_density(const CaseModel& model, const std::vector<GroupLaw>& laws, const Eigen::VectorXd& u) {
  const StackedPrediction stacked = stack(model, laws, u);
  return log_normal(observed(model) - stacked.mean, stacked.total());
}

/// With central differences along all unknowns: what a setting's error does to two outputs changes with the predictions'
/// second derivatives, which no emulator gives.
Evaluation differenced_likelihood(const CaseModel& model, const Eigen::VectorXd& u) {
  constexpr double step = 1e-5;
  const auto at = [&](const Eigen::VectorXd& point) { return log_linked_density(model, laws_at(model, point), point); };
  Evaluation found{.value = at(u), .gradient = Eigen::VectorXd(u.size())};
  for (Eigen::Index s = 0; s < u.size(); ++s) {
    Eigen::VectorXd up = u, down = u;
    up[s] += step;
    down[s] -= step;
    found.gradient[s] = (at(up) - at(down)) / (2.0 * step);
  }
  return found;
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

Evaluation log_likelihood_gradient(const CaseModel& full, const Eigen::VectorXd& u) {
  const CaseModel& model = distinct_rows(full);
  Evaluation sum{.value = 0.0, .gradient = Eigen::VectorXd::Zero(u.size())};
  if (!model.linked_settings.empty()) return differenced_likelihood(model, u);
  if (!model.linked_errors.empty()) {
    add_linked(model, u, sum);
    return sum;
  }
  for (const auto& group : model.groups) {
    add_group(model, group, u, sum);
    for (const Repeats& repeats : group.repeats) {
      const Scatter scatter = scatter_of(model, repeats, u);
      sum.value += scatter.log_density;
      if (repeats.noise >= 0) sum.gradient[repeats.noise] += scatter.slope;
    }
  }
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
      const double z = (u[s] - unknown.cut->mean) / unknown.cut->sd;
      sum.value -= 0.5 * z * z;
      sum.gradient[s] = -z / unknown.cut->sd;
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
  const Eigen::VectorXd lower = model.lower(), upper = model.upper();
  for (Eigen::Index s = 0; s < u.size(); ++s) {
    const double step = 1e-4 * (upper[s] - lower[s]);
    Eigen::VectorXd high = u, low = u;
    high[s] = std::min(u[s] + step, upper[s]);
    low[s] = std::max(u[s] - step, lower[s]);
    slopes.col(s) = (row_moments(model, high).mean - row_moments(model, low).mean) / (high[s] - low[s]);
  }
  return slopes;
}

}  // namespace uq
