#include "uq/surrogates.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "data/error.hpp"
#include "uq/prior.hpp"

namespace uq {
namespace {

using data::ExitStatus;

std::size_t column_of(const std::vector<data::Column>& columns, const std::string& name, const data::Study& study) {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].name == name) return i;
  throw data::InputError(ExitStatus::bad_data, {study.training.table.empty() ? study.file : study.training.table,
                                                fmt::format("the run table has no column '{}'", name),
                                                "add it, or take it out of the study"});
}

/// Where the study's names are in the table.
struct Columns {
  std::vector<std::size_t> parameters, controls, outputs;
};

TrainingRows rows_of(const data::Study& study, const std::vector<const data::RunRow*>& rows, const Columns& columns,
                     std::size_t output) {
  TrainingRows found{.material = rows.front()->material,
                     .output = output,
                     .set = {},
                     .inputs = {},
                     .constants = {},
                     .control_range = {}};
  const auto count = static_cast<Eigen::Index>(rows.size());
  std::vector<Eigen::VectorXd> inputs;
  auto keep = [&](Eigen::VectorXd column, EmulatorInput input) {
    inputs.push_back(std::move(column));
    found.inputs.push_back(input);
  };
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    const data::Parameter& parameter = study.parameters[p];
    Eigen::VectorXd u(count);
    for (Eigen::Index i = 0; i < count; ++i)
      u[i] = to_scaled(parameter, rows[static_cast<std::size_t>(i)]->inputs[columns.parameters[p]]);
    if (u.maxCoeff() - u.minCoeff() > 1e-9) {
      keep(u, {InputKind::parameter, p});
    } else {
      found.constants[p] = rows.front()->inputs[columns.parameters[p]];
    }
  }
  for (std::size_t c = 0; c < study.controls.size(); ++c) {
    const data::Control& control = study.controls[c];
    Eigen::VectorXd value(count);
    for (Eigen::Index i = 0; i < count; ++i)
      value[i] = rows[static_cast<std::size_t>(i)]->inputs[columns.parameters.size() + columns.controls[c]];
    found.control_range[c] = {value.minCoeff(), value.maxCoeff()};
    const Eigen::VectorXd scaled = (value.array() - control.low) / (control.high - control.low);
    if (scaled.maxCoeff() - scaled.minCoeff() > 1e-9) keep(scaled, {InputKind::control, c});
  }
  found.set.x.resize(count, static_cast<Eigen::Index>(inputs.size()));
  for (std::size_t k = 0; k < inputs.size(); ++k) found.set.x.col(static_cast<Eigen::Index>(k)) = inputs[k];
  found.set.y.resize(count);
  found.set.noise_variance.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const data::RunRow& row = *rows[static_cast<std::size_t>(i)];
    found.set.y[i] = row.outputs[columns.outputs[output]];
    found.set.noise_variance[i] = std::pow(row.standard_errors[columns.outputs[output]], 2);
  }
  return found;
}

/// Whether some case uses measurements of this material and output.
bool is_observed(const data::Study& study, const TrainingRows& rows) {
  for (const auto& one : study.cases)
    for (const auto& name : one.observe) {
      const data::ObservationSet& set = study.observations[study.observation_index(name).value()];
      if (set.material == rows.material &&
          std::find(set.outputs.begin(), set.outputs.end(), rows.output) != set.outputs.end())
        return true;
    }
  return false;
}

std::vector<double> in_unit(const Eigen::VectorXd& values, const data::Unit& unit) {
  std::vector<double> shown;
  for (const double value : values) shown.push_back(unit.from_si(value));
  return shown;
}

SurrogateReport report_of(const data::Study& study, const TrainingRows& rows, const surrogate::GaussianProcess& process,
                          const SurrogateOptions& options) {
  const data::Output& output = study.outputs[rows.output];
  surrogate::ValidationOptions validation_options = options.validation;
  validation_options.seed = options.fit.seed;
  const surrogate::Validation found = surrogate::validate(rows.set, options.fit, process, validation_options);
  SurrogateReport report;
  report.output = output.name;
  report.material = rows.material;
  report.runs = found.runs;
  report.unit = output.unit.symbol;
  report.q2 = found.q2_leave_one_out;
  report.q2_held_out = found.q2_held_out;
  report.coverage95 = found.coverage_leave_one_out.observed[2];
  const surrogate::HyperParameters hyper = process.hyper_parameters();
  // On the log scale the nugget is relative; shown at the mean output.
  const bool logarithmic = options.fit.scale == surrogate::OutputScale::log;
  report.nugget_sd = hyper.nugget_sd * (logarithmic ? std::abs(rows.set.y.mean()) : 1.0) / output.unit.factor;
  for (std::size_t k = 0; k < rows.inputs.size(); ++k) {
    const EmulatorInput& input = rows.inputs[k];
    report.inputs.push_back(input.kind == InputKind::parameter ? study.parameters[input.index].name
                                                               : study.controls[input.index].name);
    report.length_scales.push_back(hyper.length_scales[static_cast<Eigen::Index>(k)]);
  }
  report.observed = in_unit(rows.set.y, output.unit);
  report.predicted = in_unit(found.leave_one_out.mean, output.unit);
  report.standardised.assign(found.leave_one_out.standardised.begin(), found.leave_one_out.standardised.end());
  for (const double variance : rows.set.noise_variance)
    report.observed_se.push_back(std::sqrt(variance) / output.unit.factor);
  report.verdict = surrogate::to_text(found.verdict);
  report.finding = found.finding;
  report.consequence = found.consequence;
  report.remedy = found.remedy;
  report.notes = found.notes;
  return report;
}

}  // namespace

std::vector<TrainingRows> training_rows(const data::Study& study, const data::RunTable& table) {
  Columns columns;
  for (const auto& parameter : study.parameters)
    columns.parameters.push_back(column_of(table.parameters, parameter.name, study));
  for (const auto& control : study.controls) columns.controls.push_back(column_of(table.controls, control.name, study));
  for (const auto& output : study.outputs) columns.outputs.push_back(column_of(table.outputs, output.name, study));
  // The row's inputs are the table's parameters, then its controls.
  if (table.parameters.size() != study.parameters.size() || table.controls.size() != study.controls.size())
    throw data::InputError(ExitStatus::bad_data, {study.training.table.empty() ? study.file : study.training.table,
                                                  "the run table has columns of inputs that the study does not name",
                                                  "remake the table from this study"});

  std::vector<std::string> materials;
  for (const auto& row : table.rows)
    if (std::find(materials.begin(), materials.end(), row.material) == materials.end())
      materials.push_back(row.material);
  std::vector<TrainingRows> all;
  std::vector<data::Problem> problems;
  const std::string where = study.training.table.empty() ? study.file : study.training.table;
  for (const auto& material : materials)
    for (std::size_t output = 0; output < study.outputs.size(); ++output) {
      std::vector<const data::RunRow*> rows;
      for (const auto& row : table.rows)
        if (row.material == material && std::isfinite(row.outputs[columns.outputs[output]]) &&
            std::isfinite(row.standard_errors[columns.outputs[output]]))
          rows.push_back(&row);
      if (rows.empty()) continue;
      TrainingRows found = rows_of(study, rows, columns, output);
      const std::size_t needed = found.inputs.size() + 2;
      const std::string name = material.empty() ? "the study" : "material '" + material + "'";
      if (rows.size() < needed)
        problems.push_back({where,
                            fmt::format("{} has {} runs of {}, fewer than the {} that {} inputs need at the very least",
                                        name, rows.size(), study.outputs[output].name, needed, found.inputs.size()),
                            "run `demcal train` for more, ten per input is a good start"});
      all.push_back(std::move(found));
    }
  if (all.empty())
    problems.push_back({where, "there are no training runs",
                        "run `demcal train`, or name a table of another code's runs under [training] table"});
  if (!problems.empty()) throw data::InputError(ExitStatus::bad_data, problems);
  return all;
}

Emulator emulator_of(const TrainingRows& rows, std::shared_ptr<const surrogate::GaussianProcess> process) {
  Emulator emulator = make_emulator(std::move(process), rows.material, rows.output, rows.inputs);
  emulator.constants = rows.constants;
  emulator.control_range = rows.control_range;
  return emulator;
}

std::vector<Emulator> emulators_of(const std::vector<FittedSurrogate>& fitted) {
  std::vector<Emulator> emulators;
  for (const auto& item : fitted) emulators.push_back(emulator_of(item.rows, item.process));
  return emulators;
}

std::vector<FittedSurrogate> fit_surrogates(const data::Study& study, const data::RunTable& table,
                                            const SurrogateOptions& options) {
  std::vector<TrainingRows> rows = training_rows(study, table);
  std::vector<FittedSurrogate> fitted;
  for (auto& part : rows) {
    if (options.observed_only && !is_observed(study, part)) continue;
    auto process = std::make_shared<const surrogate::GaussianProcess>(surrogate::fit(part.set, options.fit));
    SurrogateReport report = report_of(study, part, *process, options);
    fitted.push_back({.rows = std::move(part), .process = std::move(process), .report = std::move(report)});
  }
  return fitted;
}

}  // namespace uq
