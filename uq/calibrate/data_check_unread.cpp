// A column of the runs that nothing reads, and that is an input of theirs. A surrogate takes its influence for scatter
// of the runs. But the real powder has one value of it, which no posterior knows of: posteriors come out too narrow.
//
// Whether it is one is asked by two regressions on the inputs with their squares and products, as far as the runs
// allow:
//   of the column   R^2, adjusted for the number of terms: an output follows from the inputs, an input is chosen apart
//   of an output    without the column and with it and its square, by the F test of nested models (N. R. Draper, H.
//                   Smith, Applied Regression Analysis (1998), chapter 6)
// An output above 0 is taken as its logarithm, since influences most often multiply. Where several columns are inputs,
// outputs follow from all of them: the column that follows least from the inputs is named first, and is an input of all
// later regressions.
#include <fmt/format.h>
#include <gsl/gsl_cdf.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "uq/calibrate/data_columns.hpp"

namespace uq {
namespace {

using data::Finding;
using data::Severity;

/// Rows of one material that have an output and a column, and what is in them.
struct RowsWithBoth {
  Eigen::MatrixXd inputs;          ///< unit cube, one row per run
  Eigen::VectorXd output, column;  ///< the column in the unit interval
};

/// Values scaled to 0 to 1; zeros where all are the same.
Eigen::VectorXd in_unit(const Eigen::VectorXd& values) {
  const double low = values.minCoeff(), width = values.maxCoeff() - low;
  if (!(width > 0.0)) return Eigen::VectorXd::Zero(values.size());
  return (values.array() - low) / width;
}

/// `further`: columns that are inputs beside the study's own.
RowsWithBoth rows_with_both(const data::Study& study, const data::RunTable& table, const std::string& material,
                            std::size_t output, const std::string& column, const std::vector<std::string>& further) {
  const auto has = [](const data::RunRow& row, const std::string& name) { return row.unread.contains(name); };
  std::vector<const data::RunRow*> rows;
  for (const data::RunRow& row : table.rows)
    if (!row.left_out && row.material == material && std::isfinite(row.outputs[output]) && has(row, column) &&
        std::all_of(further.begin(), further.end(), [&](const std::string& name) { return has(row, name); }))
      rows.push_back(&row);
  std::vector<data::Axis> axes;
  for (const data::Parameter& parameter : study.parameters) axes.push_back(parameter.axis());
  for (const data::Control& control : study.controls) axes.push_back(control.axis());
  const auto count = static_cast<Eigen::Index>(rows.size());
  const auto own = static_cast<Eigen::Index>(axes.size()), all = own + static_cast<Eigen::Index>(further.size());
  RowsWithBoth both{Eigen::MatrixXd(count, all), Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index k = 0; k < own; ++k) both.inputs(i, k) = axes[k].to_unit(rows[i]->inputs[k]);
    for (Eigen::Index k = own; k < all; ++k) both.inputs(i, k) = rows[i]->unread.at(further[k - own]);
    both.output[i] = rows[i]->outputs[output];
    both.column[i] = rows[i]->unread.at(column);
  }
  if (count == 0) return both;
  for (Eigen::Index k = own; k < all; ++k) both.inputs.col(k) = in_unit(both.inputs.col(k));
  both.column = in_unit(both.column);
  if (both.output.minCoeff() > 0.0) both.output = both.output.array().log();
  return both;
}

/// 1, the inputs, their squares and products; without products, or squares, where the runs are too few for them.
Eigen::MatrixXd terms_of(const Eigen::MatrixXd& inputs) {
  constexpr Eigen::Index spare = 10;  // runs beyond the number of terms
  const Eigen::Index runs = inputs.rows(), d = inputs.cols();
  const bool squares = runs >= 1 + 2 * d + spare, products = runs >= 1 + 2 * d + d * (d - 1) / 2 + spare;
  std::vector<Eigen::VectorXd> columns{Eigen::VectorXd::Ones(runs)};
  for (Eigen::Index a = 0; a < d; ++a) {
    columns.emplace_back(inputs.col(a));
    if (squares) columns.emplace_back(inputs.col(a).array().square());
    for (Eigen::Index b = 0; products && b < a; ++b) columns.emplace_back(inputs.col(a).cwiseProduct(inputs.col(b)));
  }
  Eigen::MatrixXd terms(runs, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) terms.col(static_cast<Eigen::Index>(k)) = columns[k];
  return terms;
}

/// What least squares leave of y.
struct Rest {
  double squares = 0.0;  ///< sum of them
  Eigen::Index degrees = 0;
};

Rest rest_of(const Eigen::MatrixXd& terms, const Eigen::VectorXd& y) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(terms);
  return {(y - terms * factor.solve(y)).squaredNorm(), y.size() - factor.rank()};
}

/// What a column does to an output that the inputs do not.
struct ColumnEffect {
  std::string output;
  double share = 0.0;  ///< taken of what the inputs leave of the output
  double own = 0.0;    ///< adjusted R^2 of the column on the inputs
};

/// None where the column follows from the inputs, is the same in all runs, or where chance could do as much.
std::optional<ColumnEffect> effect_of(const RowsWithBoth& rows, const std::string& output,
                                      const DataCheckThresholds& t) {
  constexpr Eigen::Index degrees_least = 8;
  if (rows.column.size() <= degrees_least || !rows.inputs.allFinite()) return {};
  const Eigen::MatrixXd terms = terms_of(rows.inputs);
  const Rest column = rest_of(terms, rows.column), without = rest_of(terms, rows.output);
  const double squares = (rows.column.array() - rows.column.mean()).square().sum();
  if (column.degrees < degrees_least || !(squares > 0.0) || !(without.squares > 0.0)) return {};
  const double own = 1.0 - column.squares / squares * static_cast<double>(rows.column.size() - 1) /
                               static_cast<double>(column.degrees);
  if (own > t.unread_own) return {};
  Eigen::MatrixXd more(terms.rows(), terms.cols() + 2);
  more << terms, rows.column, rows.column.array().square().matrix();
  const Rest with = rest_of(more, rows.output);
  if (with.degrees < degrees_least || with.degrees == without.degrees) return {};
  const double share = 1.0 - with.squares / without.squares;
  if (share < t.unread_share) return {};
  const auto taken = static_cast<double>(without.degrees - with.degrees), left = static_cast<double>(with.degrees);
  const double f = share / taken / ((1.0 - share) / left);
  if (gsl_cdf_fdist_Q(f, taken, left) > t.unread_p) return {};
  return ColumnEffect{output, share, own};
}

/// The largest influence of a column on any output of any material.
std::optional<ColumnEffect> largest_effect(const data::Study& study, const data::RunTable& table,
                                           const std::string& column, const std::vector<std::string>& further,
                                           const DataCheckThresholds& t) {
  std::set<std::string> materials;
  for (const data::RunRow& row : table.rows)
    if (!row.left_out) materials.insert(row.material);
  std::optional<ColumnEffect> largest;
  for (const std::string& material : materials)
    for (std::size_t output = 0; output < table.outputs.size(); ++output) {
      const RowsWithBoth rows = rows_with_both(study, table, material, output, column, further);
      if (const auto found = effect_of(rows, table.outputs[output].name, t);
          found && (!largest || found->share > largest->share))
        largest = found;
    }
  return largest;
}

}  // namespace

std::vector<Finding> check_unread_inputs(const data::Study& study, const data::RunTable& table,
                                         const DataCheckThresholds& t) {
  std::set<std::string> unread;
  for (const data::RunRow& row : table.rows)
    if (!row.left_out)
      for (const auto& [column, value] : row.unread) unread.insert(column);
  std::vector<Finding> findings;
  std::vector<std::string> named;
  while (true) {
    std::optional<ColumnEffect> next;
    std::string name;
    for (const std::string& column : unread)
      if (const auto found = largest_effect(study, table, column, named, t);
          found && (!next || found->own < next->own)) {
        next = found;
        name = column;
      }
    if (!next) return findings;
    unread.erase(name);
    named.push_back(name);
    findings.push_back(
        {.kind = data::FindingKind::unread_columns,
         .place = table.rows.front().place.substr(0, table.rows.front().place.rfind(':')),
         .severity = Severity::warning,
         .what = fmt::format(
             "the column {} moves {}, and nothing reads it: it takes {:.0f} % of what the inputs leave of {}. "
             "The surrogate takes its influence for scatter, and no posterior knows of it",
             name, next->output, 100.0 * next->share, next->output),
         .remedy = fmt::format("declare it, [parameters.{}] or [controls.{}]; where it is an output, under [outputs]",
                               name, name),
         .places = {}});
  }
}

}  // namespace uq
