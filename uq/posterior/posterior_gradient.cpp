// The log likelihood with its gradient (posterior.hpp).
#include <cmath>
#include <iterator>
#include <numbers>

#include "uq/posterior/differences.hpp"
#include "uq/posterior/distinct.hpp"
#include "uq/posterior/posterior.hpp"

namespace uq {
namespace {

constexpr double step = 1e-5;  // of central differences, a share of the support's width

/// The law of a group's numbers and its slopes along the unknowns that move it.
struct GroupSlopes {
  GroupLaw law;
  LawGradient slopes;
};

/// Slopes by central differences, for an emulator without a derivative along a common shift.
GroupSlopes differenced(const CaseModel& model, const RowGroup& group, const Eigen::VectorXd& u) {
  const auto total_at = [&](const Eigen::VectorXd& at) {
    GroupLaw law = group_law(model, group, at);
    law.covariance.diagonal() += law.noise;
    return law;
  };
  GroupSlopes found{.law = group_law(model, group, u), .slopes = {}};
  for (Eigen::Index s = 0; s < u.size(); ++s) {
    const bool nuisance = model.unknowns[s].nuisance.has_value();
    if (!nuisance && !(group.unknown.array() == static_cast<int>(s)).any()) continue;
    const BothSides at = both_sides(model, u, s, step);
    const GroupLaw above = total_at(at.high), below = total_at(at.low);
    found.slopes.along.push_back(static_cast<int>(s));
    found.slopes.mean.emplace_back((above.mean - below.mean) / at.apart);
    found.slopes.covariance.emplace_back((above.covariance - below.covariance) / at.apart);
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

/// The likelihood with central differences along all unknowns: what a setting's error does to two outputs changes with
/// the predictions' second derivatives, which no emulator gives.
Evaluation differenced_likelihood(const CaseModel& model, const Eigen::VectorXd& u) {
  Evaluation found{.value = log_likelihood(model, u), .gradient = Eigen::VectorXd(u.size())};
  for (Eigen::Index s = 0; s < u.size(); ++s) {
    const BothSides at = both_sides(model, u, s, step);
    found.gradient[s] = (log_likelihood(model, at.high) - log_likelihood(model, at.low)) / at.apart;
  }
  return found;
}

}  // namespace

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

}  // namespace uq
