// A column of the runs that nothing reads, and that is an input of theirs. A surrogate takes its influence for scatter of the
// runs. But the real powder has one value of it, which no posterior knows of: posteriors come out too narrow.
//
// Whether it is one is asked by two regressions on the inputs with their squares and products, as far as the runs allow:
//   of the column   R^2, adjusted for the number of terms: an output follows from the inputs, an input is chosen apart
//   of an output    without the column and with it and its square, by the F test of nested models (N. R. Draper, H.
//                   Smith, Applied Regression Analysis (1998), chapter 6)
// An output above 0 is taken as its logarithm, since influences most often multiply.
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
  Eigen::MatrixXd inputs;  ///< unit cube, one row per run
  Eigen::VectorXd output, column;
};

RowsWithBoth rows_with_both(const data::Study& study, const data::RunTable& table, const std::string& material,
                            std::size_t output, std::size_t column) {
  std::vector<const data::RunRow*> rows;
  for (const data::RunRow& row : table.rows)
    if (!row.left_out && row.material == material && column < row.unread.size() && std::isfinite(row.outputs[output]) &&
        std::isfinite(row.unread[column]))
      rows.push_back(&row);
  std::vector<data::Axis> axes;
  for (const data::Parameter& parameter : study.parameters) axes.push_back(parameter.axis());
  for (const data::Control& control : study.controls) axes.push_back(control.axis());
  const auto count = static_cast<Eigen::Index>(rows.size());
  RowsWithBoth both{Eigen::MatrixXd(count, static_cast<Eigen::Index>(axes.size())), Eigen::VectorXd(count),
                    Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < axes.size(); ++k)
      both.inputs(i, static_cast<Eigen::Index>(k)) = axes[k].to_unit(rows[i]->inputs[k]);
    both.output[i] = rows[i]->outputs[output];
    both.column[i] = rows[i]->unread[column];
  }
  if (count > 0 && both.output.minCoeff() > 0.0) both.output = both.output.array().log();
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

/// The share that a column takes of what the inputs leave of an output. None where it follows from the inputs, is the same in
/// all runs, or where chance could do that.
std::optional<double> share_taken(const RowsWithBoth& rows, const DataCheckThresholds& t) {
  constexpr Eigen::Index degrees_least = 8;
  if (rows.column.size() <= degrees_least || !rows.inputs.allFinite()) return {};
  const double low = rows.column.minCoeff(), width = rows.column.maxCoeff() - low;
  if (!(width > 0.0)) return {};
  const Eigen::VectorXd column = (rows.column.array() - low) / width;
  const Eigen::MatrixXd terms = terms_of(rows.inputs);
  const Rest without = rest_of(terms, rows.output), own = rest_of(terms, column);
  const auto degrees_all = static_cast<double>(column.size() - 1);
  const double all = (column.array() - column.mean()).square().sum() / degrees_all;
  if (own.degrees < degrees_least || own.squares / static_cast<double>(own.degrees) < (1.0 - t.unread_own) * all)
    return {};
  Eigen::MatrixXd more(terms.rows(), terms.cols() + 2);
  more << terms, column, column.array().square().matrix();
  const Rest with = rest_of(more, rows.output);
  const auto taken = static_cast<double>(without.degrees - with.degrees), left = static_cast<double>(with.degrees);
  if (!(taken > 0.0) || !(with.degrees >= degrees_least) || !(without.squares > 0.0)) return {};
  const double share = 1.0 - with.squares / without.squares;
  if (share < t.unread_share) return {};
  const double f = (without.squares - with.squares) / taken / (with.squares / left);
  if (gsl_cdf_fdist_Q(f, taken, left) > t.unread_p) return {};
  return share;
}

}  // namespace

std::vector<Finding> check_unread_inputs(const data::Study& study, const data::RunTable& table,
                                         const DataCheckThresholds& t) {
  std::vector<Finding> findings;
  std::set<std::string> materials;
  for (const data::RunRow& row : table.rows)
    if (!row.left_out) materials.insert(row.material);
  for (std::size_t column = 0; column < table.unread.size(); ++column) {
    double most = 0.0;
    std::string moved;
    for (const std::string& material : materials)
      for (std::size_t output = 0; output < table.outputs.size(); ++output)
        if (const auto share = share_taken(rows_with_both(study, table, material, output, column), t);
            share && *share > most) {
          most = *share;
          moved = table.outputs[output].name;
        }
    if (moved.empty()) continue;
    findings.push_back(
        {.kind = data::FindingKind::unread_columns,
         .place = table.rows.front().place.substr(0, table.rows.front().place.rfind(':')),
         .severity = Severity::warning,
         .what = fmt::format(
             "the column {} moves {}, and nothing reads it: it takes {:.0f} % of what the inputs leave of {}. "
             "The surrogate takes its influence for scatter, and no posterior knows of it",
             table.unread[column], moved, 100.0 * most, moved),
         .remedy = fmt::format("declare it, [parameters.{}] or [controls.{}]; where it is an output, under [outputs]",
                               table.unread[column], table.unread[column]),
         .places = {}});
  }
  return findings;
}

}  // namespace uq
