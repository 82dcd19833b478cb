// Checks of the runs' inputs: whether they move together, and whether they cover the ranges.
//   correlation    of two inputs over the runs, plain and of ranks
//   multiple       R^2 of an input regressed on all others: 1 - 1 / (C^-1)_kk, C the correlation matrix
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "uq/calibrate/data_columns.hpp"
#include "uq/posterior/prior.hpp"

namespace uq {
namespace {

using data::Finding;
using data::Severity;

Eigen::VectorXd scaled(const data::Study& study, const InputColumn& column) {
  const data::Axis axis = column.is_parameter ? study.parameters[*study.parameter_index(column.name)].axis()
                                              : study.controls[*study.control_index(column.name)].axis();
  Eigen::VectorXd u(static_cast<Eigen::Index>(column.values.size()));
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    const double value = column.values[i];
    u[i] = axis.to_unit(value);
  }
  return u;
}

/// Ranks, equal values sharing their mean.
Eigen::VectorXd ranks(const Eigen::VectorXd& values) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return values[a] < values[b]; });
  Eigen::VectorXd rank(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t j = i;
    while (j < order.size() && values[order[j]] == values[order[i]]) ++j;
    for (std::size_t k = i; k < j; ++k) rank[order[k]] = 0.5 * static_cast<double>(i + j - 1);
    i = j;
  }
  return rank;
}

Eigen::MatrixXd correlations(Eigen::MatrixXd columns) {
  columns = columns.rowwise() - columns.colwise().mean();
  for (Eigen::Index k = 0; k < columns.cols(); ++k) columns.col(k) /= columns.col(k).norm();
  return columns.transpose() * columns;
}

/// Whether all readings of a material lie where the runs do, of two controls (unit interval) that move together in the
/// runs: then nobody asks for their effects apart. About the runs' straight line, with a little beyond their own
/// scatter.
bool readings_lie_on_line(const data::Study& study, const std::string& material,
                          const std::pair<std::string, std::string>& controls, const Eigen::VectorXd& first,
                          const Eigen::VectorXd& second) {
  constexpr double beyond = 0.02;  // of the second control's range
  const double mean_first = first.mean(), mean_second = second.mean();
  const Eigen::ArrayXd away = first.array() - mean_first;
  const double slope = (away * (second.array() - mean_second)).sum() / away.square().sum();
  const double scatter = (second.array() - mean_second - slope * away).abs().maxCoeff();
  const std::size_t a = *study.control_index(controls.first), b = *study.control_index(controls.second);
  bool any = false;
  for (const data::ObservationSet& set : study.observations) {
    if (set.material != material) continue;
    for (const data::Observation& point : set.points) {
      any = true;
      const double at = study.controls[a].axis().to_unit(point.controls[a]) - mean_first;
      const double off = study.controls[b].axis().to_unit(point.controls[b]) - mean_second - slope * at;
      if (std::abs(off) > scatter + beyond) return false;
    }
  }
  return any;
}

void check_together(const data::Study& study, const std::string& material,
                    const std::vector<const InputColumn*>& columns, const Eigen::MatrixXd& u,
                    const DataCheckThresholds& t, std::vector<Finding>& findings) {
  const Eigen::Index inputs = u.cols(), runs = u.rows();
  if (inputs < 2 || runs < 6) return;
  Eigen::MatrixXd ranked(runs, inputs);
  for (Eigen::Index k = 0; k < inputs; ++k) ranked.col(k) = ranks(u.col(k));
  const Eigen::MatrixXd plain = correlations(u), of_ranks = correlations(ranked);
  const std::string of = material.empty() ? "" : " of " + material;
  std::set<Eigen::Index> told;
  const auto add = [&](const std::string& what, const std::string& vary) {
    findings.push_back({.kind = data::FindingKind::inputs_that_move_together,
                        .place = columns.front()->places.front(),
                        .severity = Severity::warning,
                        .what = what,
                        .remedy = "add runs that vary " + vary + " on its own",
                        .places = {}});
  };
  for (Eigen::Index a = 0; a < inputs; ++a)
    for (Eigen::Index b = a + 1; b < inputs; ++b) {
      const double r = plain(a, b), s = of_ranks(a, b);
      if (std::max(std::abs(r), std::abs(s)) < t.together) continue;
      told.insert({a, b});
      if (!columns[a]->is_parameter && !columns[b]->is_parameter &&
          readings_lie_on_line(study, material, {columns[a]->name, columns[b]->name}, u.col(a), u.col(b)))
        continue;
      const std::string &first = columns[a]->name, &second = columns[b]->name;
      add(fmt::format("{} and {} move together in all {} runs{} (correlation {:.3f}, of ranks {:.3f}): the runs cannot "
                      "tell their effects apart",
                      first, second, runs, of, r, s),
          first);
    }
  if (runs < 2 * inputs + 4) return;
  const Eigen::LLT<Eigen::MatrixXd> factor(plain + 1e-12 * Eigen::MatrixXd::Identity(inputs, inputs));
  if (factor.info() != Eigen::Success) return;
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(inputs, inputs));
  for (Eigen::Index k = 0; k < inputs; ++k) {
    const double multiple = 1.0 - 1.0 / inverse(k, k);
    if (told.contains(k) || multiple < t.multiple) continue;
    const std::string& name = columns[k]->name;
    add(fmt::format(
            "{} follows from the other inputs in all {} runs{} (R2 {:.4f}): the runs cannot tell its effect from "
            "theirs",
            name, runs, of, multiple),
        name);
    return;  // the others of the combination would say the same
  }
}

bool is_free(const data::Study& study, const std::string& name) {
  return study.cases.empty() ||
         std::any_of(study.cases.begin(), study.cases.end(), [&](const data::CalibrationCase& one) {
           return std::find(one.free.begin(), one.free.end(), name) != one.free.end();
         });
}

void check_cover(const data::Study& study, const InputColumn& column, const Eigen::VectorXd& u,
                 const DataCheckThresholds& t, std::vector<Finding>& findings) {
  const double low = std::max(0.0, u.minCoeff()), high = std::min(1.0, u.maxCoeff());
  if (high - low >= t.covered || !is_free(study, column.name)) return;
  const data::Parameter& parameter = study.parameters[*study.parameter_index(column.name)];
  findings.push_back(
      {.kind = data::FindingKind::range_not_covered,
       .place = column.places.front(),
       .severity = Severity::warning,
       .what =
           fmt::format("the runs cover {:.0f} % of the range of {}: {:.4g} to {:.4g} of {:.4g} to {:.4g}{}; nothing is "
                       "known in the rest",
                       100.0 * std::max(0.0, high - low), column.name, column.shown(parameter.axis().from_unit(low)),
                       column.shown(parameter.axis().from_unit(high)), column.shown(column.low),
                       column.shown(column.high), column.unit_text()),
       .remedy = fmt::format("run points there, or narrow parameters.{} to what the runs cover", column.name),
       .places = {}});
}

}  // namespace

bool is_held(const data::Study& study, const data::RunRow& row, const std::string& name) {
  return std::any_of(study.materials.begin(), study.materials.end(), [&](const data::Material& material) {
    return material.name == row.material && material.fixed.contains(name);
  });
}

std::size_t input_column(const data::RunTable& table, const std::string& name) {
  std::size_t at = 0;
  for (const data::Column& column : table.parameters) {
    if (column.name == name) return at;
    ++at;
  }
  for (const data::Column& column : table.controls) {
    if (column.name == name) return at;
    ++at;
  }
  return 0;
}

std::vector<InputColumn> input_columns(const data::Study& study, const data::RunTable& table,
                                       const std::string* material) {
  std::vector<InputColumn> columns;
  for (const data::Parameter& p : study.parameters) columns.push_back({p.name, p.unit, p.low, p.high, true, {}, {}});
  for (const data::Control& c : study.controls) columns.push_back({c.name, c.unit, c.low, c.high, false, {}, {}});
  for (InputColumn& column : columns) {
    const std::size_t at = input_column(table, column.name);
    for (const data::RunRow& row : table.rows) {
      if (row.left_out || (material != nullptr && row.material != *material)) continue;
      if (column.is_parameter && is_held(study, row, column.name)) continue;
      column.values.push_back(row.inputs[at]);
      column.places.push_back(row.place);
    }
  }
  return columns;
}

std::vector<Finding> check_design(const data::Study& study, const data::RunTable& table, const DataCheckThresholds& t) {
  std::vector<Finding> findings;
  std::set<std::string> materials;
  for (const data::RunRow& row : table.rows)
    if (!row.left_out) materials.insert(row.material);
  for (const std::string& material : materials) {
    const std::vector<InputColumn> columns = input_columns(study, table, &material);
    std::vector<const InputColumn*> varied;
    std::vector<Eigen::VectorXd> values;
    for (const InputColumn& column : columns) {
      const Eigen::VectorXd u = scaled(study, column);
      if (u.size() == 0 || !u.allFinite() || !(u.maxCoeff() - u.minCoeff() > 1e-9)) continue;
      varied.push_back(&column);
      values.push_back(u);
      if (column.is_parameter) check_cover(study, column, u, t, findings);
    }
    if (varied.empty()) continue;
    Eigen::MatrixXd u(values.front().size(), static_cast<Eigen::Index>(values.size()));
    for (std::size_t k = 0; k < values.size(); ++k) u.col(k) = values[k];
    check_together(study, material, varied, u, t, findings);
  }
  return findings;
}

}  // namespace uq
