// The run table's rows as training sets.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "data/error.hpp"
#include "data/number_text.hpp"
#include "uq/emulate/surrogates.hpp"

namespace uq {
namespace {

using data::ExitStatus;

std::string table_place(const data::Study& study) {
  return study.training.table.empty() ? study.file : study.training.table;
}

std::size_t column_of(const std::vector<data::Column>& columns, const std::string& name, const data::Study& study) {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].name == name) return i;
  throw data::InputError(ExitStatus::bad_data,
                         {table_place(study), fmt::format("the run table has no column '{}'", name),
                          "add it, or take it out of the study"});
}

/// Where the study's names are in a table.
struct Columns {
  std::vector<std::size_t> parameters, controls, outputs;
};

/// The place of an input in RunRow::inputs.
std::size_t column_of(const Columns& columns, const EmulatorInput& input) {
  return input.kind == InputKind::parameter ? columns.parameters[input.index]
                                            : columns.parameters.size() + columns.controls[input.index];
}

Columns columns_of(const data::Study& study, const data::RunTable& table) {
  Columns columns;
  for (const auto& parameter : study.parameters)
    columns.parameters.push_back(column_of(table.parameters, parameter.name, study));
  for (const auto& control : study.controls) columns.controls.push_back(column_of(table.controls, control.name, study));
  for (const auto& output : study.outputs) columns.outputs.push_back(column_of(table.outputs, output.name, study));
  // The row's inputs are the table's parameters, then its controls.
  if (table.parameters.size() != study.parameters.size() || table.controls.size() != study.controls.size())
    throw data::InputError(ExitStatus::bad_data,
                           {table_place(study), "the run table has columns of inputs that the study does not name",
                            "remake the table from this study"});
  return columns;
}

/// Rows of one material that have one output, in SI: parameters and controls in the study's order.
struct LevelRows {
  Eigen::MatrixXd parameters, controls;
  Eigen::VectorXd y, noise_variance;
  std::vector<std::string> places;
};

LevelRows level_rows(const data::Study& study, const data::RunTable& table, const std::string& material,
                     std::size_t output) {
  const Columns columns = columns_of(study, table);
  const std::size_t column = columns.outputs[output];
  std::vector<const data::RunRow*> rows;
  for (const auto& row : table.rows)
    if (!row.left_out && row.material == material && std::isfinite(row.outputs[column]) &&
        std::isfinite(row.standard_errors[column]))
      rows.push_back(&row);
  const auto count = static_cast<Eigen::Index>(rows.size());
  LevelRows found{Eigen::MatrixXd(count, static_cast<Eigen::Index>(study.parameters.size())),
                  Eigen::MatrixXd(count, static_cast<Eigen::Index>(study.controls.size())),
                  Eigen::VectorXd(count),
                  Eigen::VectorXd(count),
                  {}};
  for (Eigen::Index i = 0; i < count; ++i) {
    const data::RunRow& row = *rows[i];
    for (std::size_t p = 0; p < study.parameters.size(); ++p)
      found.parameters(i, p) = row.inputs[columns.parameters[p]];
    for (std::size_t c = 0; c < study.controls.size(); ++c)
      found.controls(i, c) = row.inputs[columns.parameters.size() + columns.controls[c]];
    found.places.push_back(row.place);
    found.y[i] = row.outputs[column];
    found.noise_variance[i] = std::pow(row.standard_errors[column], 2);
  }
  return found;
}

/// The rows as training sets over the inputs that vary, on either level.
TrainingRows rows_of(const data::Study& study, const LevelRows& high, const LevelRows& low) {
  TrainingRows found{.material = {},
                     .output = 0,
                     .set = {{}, high.y, high.noise_variance},
                     .low = std::nullopt,
                     .places = high.places,
                     .inputs = {},
                     .constants = {},
                     .control_range = {}};
  const Eigen::Index highs = high.y.size(), lows = low.y.size();
  std::vector<Eigen::VectorXd> inputs;
  const auto keep = [&](const Eigen::VectorXd& column, EmulatorInput input) {
    inputs.push_back(column);
    found.inputs.push_back(input);
  };
  Eigen::VectorXd column(highs + lows);
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    const auto index = static_cast<Eigen::Index>(p);
    column << high.parameters.col(index), low.parameters.col(index);
    const double first = column[0];
    for (double& value : column) value = study.parameters[p].axis().to_unit(value);
    if (column.maxCoeff() - column.minCoeff() > 1e-9) {
      keep(column, {InputKind::parameter, p});
    } else {
      found.constants[p] = first;
    }
  }
  for (std::size_t c = 0; c < study.controls.size(); ++c) {
    const data::Control& control = study.controls[c];
    column << high.controls.col(c), low.controls.col(c);
    found.control_range[c] = {column.minCoeff(), column.maxCoeff()};
    for (double& value : column) value = control.axis().to_unit(value);
    if (column.maxCoeff() - column.minCoeff() > 1e-9) keep(column, {InputKind::control, c});
  }
  found.set.x.resize(highs, static_cast<Eigen::Index>(inputs.size()));
  for (std::size_t k = 0; k < inputs.size(); ++k) found.set.x.col(k) = inputs[k].head(highs);
  for (const EmulatorInput& input : found.inputs) found.set.names.push_back(input_of(study, input).name);
  if (lows == 0) return found;
  found.low =
      surrogate::TrainingSet{Eigen::MatrixXd(lows, found.set.x.cols()), low.y, low.noise_variance, found.set.names};
  for (std::size_t k = 0; k < inputs.size(); ++k) found.low->x.col(k) = inputs[k].tail(lows);
  return found;
}

}  // namespace

std::vector<TrainingRows> training_rows(const data::Study& study, const data::RunTable& table,
                                        const std::optional<data::RunTable>& low) {
  std::vector<std::string> materials;
  for (const auto& row : table.rows)
    if (std::find(materials.begin(), materials.end(), row.material) == materials.end())
      materials.push_back(row.material);
  std::vector<TrainingRows> all;
  std::vector<data::Problem> problems;
  for (const auto& material : materials)
    for (std::size_t output = 0; output < study.outputs.size(); ++output) {
      const LevelRows high = level_rows(study, table, material, output);
      if (high.y.size() == 0) continue;
      const data::RunTable nothing = data::empty_table(study);
      TrainingRows found = rows_of(study, high, level_rows(study, low ? *low : nothing, material, output));
      found.material = material;
      found.output = output;
      const std::string name = material.empty() ? "the study" : "material '" + material + "'";
      const auto demand = [&](Eigen::Index count, std::size_t needed, const std::string& level) {
        const auto rows = static_cast<std::size_t>(count);
        if (rows >= needed && !found.inputs.empty()) return;
        const std::string has =
            fmt::format("{} has {} of {}{}", name, data::counted(rows, "run"), study.outputs[output].name, level);
        problems.push_back(
            {table_place(study),
             found.inputs.empty()
                 ? has + (rows == 1 ? "" : ", all at the same point") + ", too few to tell what any input does"
                 : fmt::format("{}, fewer than the {} that {} need{} at the very least", has, needed,
                               data::counted(found.inputs.size(), "input"), found.inputs.size() == 1 ? "s" : ""),
             study.training.engine == data::Engine::none
                 ? "add rows to the table, ten per input is a good start"
                 : "run `demcal train` for more, ten per input is a good start"});
      };
      const std::size_t needed = found.inputs.size() + 2;
      demand(high.y.size(), found.low ? 3 : needed, "");
      if (found.low) demand(found.low->y.size(), needed, " on the cheaper level");
      all.push_back(std::move(found));
    }
  if (all.empty())
    problems.push_back({table_place(study), "there are no training runs",
                        "run `demcal train`, or name a table of another code's runs under [training] table"});
  if (!problems.empty()) throw data::InputError(ExitStatus::bad_data, problems);
  return all;
}

std::vector<Emulator> outlines_of(const data::Study& study, const data::RunTable& table,
                                  const std::optional<data::RunTable>& low) {
  std::vector<Emulator> outlines;
  for (TrainingRows& rows : training_rows(study, table, low))
    outlines.push_back({.material = std::move(rows.material),
                        .output = rows.output,
                        .inputs = std::move(rows.inputs),
                        .constants = std::move(rows.constants),
                        .control_range = std::move(rows.control_range),
                        .predict = {}});
  return outlines;
}

std::vector<DesignReport> designs_of(const data::Study& study, const data::RunTable& table,
                                     const std::vector<FittedSurrogate>& fitted) {
  std::vector<DesignReport> designs;
  const Columns columns = columns_of(study, table);
  for (const FittedSurrogate& one : fitted) {
    const bool known = std::any_of(designs.begin(), designs.end(),
                                   [&](const DesignReport& other) { return other.material == one.rows.material; });
    if (known) continue;
    DesignReport design{
        .material = one.rows.material, .inputs = {}, .units = {}, .runs = {}, .left_out = {}, .reasons = {}};
    for (const EmulatorInput& input : one.rows.inputs) {
      design.inputs.push_back(input_of(study, input).name);
      design.units.push_back(input_of(study, input).unit.symbol);
    }
    for (const data::RunRow& row : table.rows) {
      if (row.material != one.rows.material) continue;
      std::vector<double> point;
      for (const EmulatorInput& input : one.rows.inputs)
        point.push_back(input_of(study, input).unit.from_si(row.inputs[column_of(columns, input)]));
      const std::size_t column = columns.outputs[one.rows.output];
      const std::string reason = row.left_out ? row.left_out.words
                                 : std::isfinite(row.outputs[column])
                                     ? ""
                                     : "without " + study.outputs[one.rows.output].name;
      if (!reason.empty()) design.reasons.push_back(reason);
      (reason.empty() ? design.runs : design.left_out).push_back(std::move(point));
    }
    designs.push_back(std::move(design));
  }
  return designs;
}

}  // namespace uq
