#include "uq/posterior/case_model.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "uq/posterior/distinct.hpp"

namespace uq {

int CaseModel::own_count() const {
  return static_cast<int>(
      std::count_if(unknowns.begin(), unknowns.end(), [](const Unknown& unknown) { return unknown.own; }));
}

int CaseModel::row_count() const {
  Eigen::Index rows = 0;
  for (const auto& group : groups) rows += group.observed.size();
  return static_cast<int>(rows);
}

Eigen::VectorXd CaseModel::lower() const {
  Eigen::VectorXd low(dimension());
  for (int s = 0; s < dimension(); ++s) low[s] = unknowns[s].prior.low();
  return low;
}

Eigen::VectorXd CaseModel::upper() const {
  Eigen::VectorXd high(dimension());
  for (int s = 0; s < dimension(); ++s) high[s] = unknowns[s].prior.high();
  return high;
}

void find_coordinates(RowGroup& group, int unknowns) {
  group.uniform = true;
  group.coordinate.assign(static_cast<std::size_t>(unknowns), std::nullopt);
  for (Eigen::Index k = 0; k < group.unknown.cols(); ++k) {
    if (group.unknown.rows() == 0) continue;
    const int s = group.unknown(0, k);
    if ((group.unknown.col(k).array() != s).any()) group.uniform = false;
    if (s < 0) continue;
    if (group.coordinate[s]) group.uniform = false;
    group.coordinate[s] = static_cast<int>(k);
  }
}

CaseModel with_data(const CaseModel& model, const Eigen::VectorXd& observed, const Eigen::VectorXd& variance) {
  CaseModel other = model;
  Eigen::Index first = 0;
  for (auto& group : other.groups) {
    const Eigen::Index rows = group.observed.size();
    group.observed = observed.segment(first, rows);
    group.variance = variance.segment(first, rows);
    first += rows;
  }
  assert(first == observed.size());
  if (model.distinct) pool_rows(other);
  return other;
}

void add_own_errors(const Eigen::VectorXd& variance, const std::vector<LinkedErrors>& linked,
                    Eigen::MatrixXd& covariance) {
  covariance.diagonal() += variance;
  for (const LinkedErrors& pair : linked) {
    const double value = pair.correlation * std::sqrt(variance[pair.first] * variance[pair.second]);
    covariance(pair.first, pair.second) += value;
    covariance(pair.second, pair.first) += value;
  }
}

std::vector<LinkedErrors> linked_among(const std::vector<LinkedErrors>& linked, const std::vector<Eigen::Index>& rows) {
  std::vector<LinkedErrors> found;
  for (const LinkedErrors& pair : linked) {
    const auto first = std::find(rows.begin(), rows.end(), pair.first);
    const auto second = std::find(rows.begin(), rows.end(), pair.second);
    if (first != rows.end() && second != rows.end())
      found.push_back({first - rows.begin(), second - rows.begin(), pair.correlation});
  }
  return found;
}

Eigen::VectorXd observed(const CaseModel& model) {
  Eigen::VectorXd all(model.row_count());
  Eigen::Index first = 0;
  for (const auto& group : model.groups) {
    all.segment(first, group.observed.size()) = group.observed;
    first += group.observed.size();
  }
  return all;
}

Eigen::VectorXd observed_variance(const CaseModel& model) {
  Eigen::VectorXd all(model.row_count());
  Eigen::Index first = 0;
  for (const auto& group : model.groups) {
    all.segment(first, group.variance.size()) = group.variance;
    first += group.variance.size();
  }
  return all;
}

std::vector<RowOrigin> origins(const CaseModel& model) {
  std::vector<RowOrigin> all;
  for (const auto& group : model.groups) all.insert(all.end(), group.origin.begin(), group.origin.end());
  return all;
}

CaseModel without_surrogate_error(const CaseModel& model) {
  CaseModel exact = model;
  if (model.distinct) exact.distinct = std::make_shared<const CaseModel>(without_surrogate_error(*model.distinct));
  for (RowGroup& group : exact.groups) {
    Emulator& emulator = group.emulator;
    emulator.predict = [predict = emulator.predict](const Eigen::MatrixXd& points) -> surrogate::Prediction {
      surrogate::Prediction found = predict(points);
      found.covariance.setZero();
      return found;
    };
    emulator.predict_with_gradient = {};
    if (emulator.predict_batch)
      emulator.predict_batch = [predict = emulator.predict_batch](const Eigen::MatrixXd& points,
                                                                  int rows) -> std::vector<surrogate::Prediction> {
        std::vector<surrogate::Prediction> found = predict(points, rows);
        for (surrogate::Prediction& one : found) one.covariance.setZero();
        return found;
      };
  }
  return exact;
}

}  // namespace uq
