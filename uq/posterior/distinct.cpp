#include "uq/posterior/distinct.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <tuple>

namespace uq {
namespace {

/// Which rows of a group stand for the same number, up to their own errors.
struct Classes {
  std::vector<Eigen::Index> of_row;  ///< class of each row, classes by their first row
  std::vector<Eigen::Index> first;   ///< row of each class
};

int set_of(const Measurement& measurement, Eigen::Index row) {
  for (std::size_t s = 0; s < measurement.sets.size(); ++s) {
    const ReadSet& set = measurement.sets[s];
    if (row >= set.first && row < set.first + set.count) return static_cast<int>(s);
  }
  return -1;
}

int discrepancy_of(const Measurement& measurement, Eigen::Index row) {
  for (std::size_t s = 0; s < measurement.discrepancies.size(); ++s) {
    const DiscrepancyRows& part = measurement.discrepancies[s];
    if (row >= part.first && row < part.first + part.count) return static_cast<int>(s);
  }
  return -1;
}

Classes classes_of(const RowGroup& group) {
  Classes classes;
  std::map<std::vector<double>, Eigen::Index> known;
  for (Eigen::Index i = 0; i < group.base.rows(); ++i) {
    const int set = set_of(group.measurement, i);
    std::vector<double> key = {static_cast<double>(set), static_cast<double>(discrepancy_of(group.measurement, i)),
                               static_cast<double>(group.origin[i].set)};
    for (Eigen::Index k = 0; k < group.base.cols(); ++k) {
      key.push_back(group.unknown(i, k));
      key.push_back(group.unknown(i, k) < 0 ? group.base(i, k) : 0.0);
    }
    if (set >= 0) {
      const ReadSet& read = group.measurement.sets[set];
      for (const SettingShift& setting : read.settings) {
        key.push_back(setting.error[i - read.first]);
        key.push_back(setting.level[i - read.first]);
      }
    }
    const auto [at, fresh] = known.emplace(std::move(key), static_cast<Eigen::Index>(classes.first.size()));
    if (fresh) classes.first.push_back(i);
    classes.of_row.push_back(at->second);
  }
  return classes;
}

/// Rows [first, first + count) of the group as a range of classes: sets are whole, and their classes are in order.
std::pair<Eigen::Index, Eigen::Index> range_of(const Classes& classes, Eigen::Index first, Eigen::Index count) {
  Eigen::Index low = classes.of_row[first], high = low;
  for (Eigen::Index i = first; i < first + count; ++i) {
    low = std::min(low, classes.of_row[i]);
    high = std::max(high, classes.of_row[i]);
  }
  return {low, high - low + 1};
}

Measurement pooled_measurement(const Measurement& measurement, const Classes& classes) {
  Measurement pooled = measurement;
  for (std::size_t s = 0; s < pooled.sets.size(); ++s) {
    const ReadSet& full = measurement.sets[s];
    ReadSet& set = pooled.sets[s];
    std::tie(set.first, set.count) = range_of(classes, full.first, full.count);
    set.noise_is_sd = false;  // the variances say how many rows each one stands for
    for (std::size_t q = 0; q < set.settings.size(); ++q) {
      set.settings[q].error.resize(set.count);
      set.settings[q].level.resize(set.count);
      for (Eigen::Index i = 0; i < set.count; ++i) {
        const Eigen::Index row = classes.first[set.first + i] - full.first;
        set.settings[q].error[i] = full.settings[q].error[row];
        set.settings[q].level[i] = full.settings[q].level[row];
      }
    }
  }
  for (std::size_t s = 0; s < pooled.discrepancies.size(); ++s) {
    const DiscrepancyRows& full = measurement.discrepancies[s];
    DiscrepancyRows& part = pooled.discrepancies[s];
    std::tie(part.first, part.count) = range_of(classes, full.first, full.count);
    part.controls.resize(part.count, full.controls.cols());
    for (Eigen::Index i = 0; i < part.count; ++i)
      part.controls.row(i) = full.controls.row(classes.first[part.first + i] - full.first);
  }
  return pooled;
}

/// A group whose rows are the classes; `pooled` tells whether there is a difference.
RowGroup pool_group(const RowGroup& group, const Classes& classes) {
  const auto count = static_cast<Eigen::Index>(classes.first.size());
  RowGroup pooled = group;
  pooled.distinct_row.clear();
  pooled.base = group.base(classes.first, Eigen::all);
  pooled.unknown = group.unknown(classes.first, Eigen::all);
  pooled.origin.clear();
  for (const Eigen::Index row : classes.first) pooled.origin.push_back(group.origin[row]);
  pooled.measurement = pooled_measurement(group.measurement, classes);

  Eigen::VectorXd weight = Eigen::VectorXd::Zero(count), sum = weight;
  Eigen::VectorXd own(group.base.rows());
  for (Eigen::Index i = 0; i < own.size(); ++i) {
    const int set = set_of(group.measurement, i);
    const bool unit = set >= 0 && group.measurement.sets[set].noise_is_sd;
    own[i] = unit ? 1.0 : 1.0 / group.variance[i];
    const Eigen::Index c = classes.of_row[i];
    weight[c] += own[i];
    sum[c] += own[i] * group.observed[i];
  }
  pooled.observed = sum.cwiseQuotient(weight);
  pooled.variance = weight.cwiseInverse();

  std::map<int, Repeats> by_noise;
  const double log_two_pi = std::log(2.0 * std::numbers::pi);
  const auto of = [&](Eigen::Index row) -> Repeats& {
    const int set = set_of(group.measurement, row);
    const int noise = set < 0 ? -1 : group.measurement.sets[set].noise;
    by_noise[noise].noise = noise;
    return by_noise[noise];
  };
  for (Eigen::Index i = 0; i < own.size(); ++i) {
    Repeats& repeats = of(i);
    const double away = group.observed[i] - pooled.observed[classes.of_row[i]];
    repeats.scatter += own[i] * away * away;
    repeats.extra += 1;
    repeats.log_constant += 0.5 * (std::log(own[i]) - log_two_pi);
  }
  for (Eigen::Index c = 0; c < count; ++c) {
    Repeats& repeats = of(classes.first[c]);
    repeats.extra -= 1;
    repeats.log_constant -= 0.5 * (std::log(weight[c]) - log_two_pi);
  }
  for (const auto& [noise, repeats] : by_noise)
    if (repeats.extra > 0) pooled.repeats.push_back(repeats);
  return pooled;
}

}  // namespace

void pool_rows(CaseModel& model) {
  model.distinct.reset();
  if (model.joint()) return;  // a mean over repeats would have errors linked to those of other means
  auto pooled = std::make_shared<CaseModel>(model);
  bool fewer = false;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    RowGroup& group = model.groups[g];
    group.distinct_row.clear();
    const Classes classes = classes_of(group);
    const bool known = group.variance.size() == 0 || group.variance.minCoeff() > 0.0;
    fewer = fewer || (known && classes.first.size() < classes.of_row.size());
    if (!known) return;
    group.distinct_row = classes.of_row;
    pooled->groups[g] = pool_group(group, classes);
  }
  if (fewer) model.distinct = std::move(pooled);
}

int number_count(const CaseModel& model) {
  int count = model.row_count();
  for (const RowGroup& group : model.groups)
    for (const Repeats& repeats : group.repeats) count += repeats.extra;
  return count;
}

const CaseModel& distinct_rows(const CaseModel& model) { return model.distinct ? *model.distinct : model; }

Scatter scatter_of(const CaseModel& model, const Repeats& repeats, const Eigen::VectorXd& u) {
  if (repeats.noise < 0)
    return {.log_density = repeats.log_constant - 0.5 * repeats.scatter, .chi_squared = repeats.scatter};
  const Unknown& unknown = model.unknowns[repeats.noise];
  const double k = unknown.value(u[repeats.noise]), chi = repeats.scatter / (k * k);
  return {.log_density = repeats.log_constant - 0.5 * chi - repeats.extra * std::log(k),
          .chi_squared = chi,
          .slope = (chi - repeats.extra) / k * unknown.slope(u[repeats.noise])};
}

}  // namespace uq
