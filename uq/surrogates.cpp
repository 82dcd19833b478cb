#include "uq/surrogates.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "data/error.hpp"
#include "uq/parallel.hpp"
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

/// 1 - mean squared error over variance.
double q_squared(const Eigen::VectorXd& y, const Eigen::VectorXd& predicted) {
  return 1.0 - (y - predicted).squaredNorm() / (y.array() - y.mean()).square().sum();
}

/// Predictions of each fold's rows by a process fitted to the others. Rows go to folds in turn.
Eigen::VectorXd held_out(const surrogate::TrainingSet& set, const SurrogateOptions& options) {
  const Eigen::Index n = set.y.size();
  Eigen::VectorXd predicted(n);
  surrogate::FitOptions fit = options.fit;
  fit.starts = std::min(fit.starts, 3);
  for_each_index(options.folds, options.threads, [&](int fold) {
    std::vector<Eigen::Index> in, out;
    for (Eigen::Index i = 0; i < n; ++i) (i % options.folds == fold ? out : in).push_back(i);
    const surrogate::TrainingSet part{
        .x = set.x(in, Eigen::all), .y = set.y(in), .noise_variance = set.noise_variance(in)};
    const surrogate::GaussianProcess process = surrogate::fit(part, fit);
    const Eigen::MatrixXd points = set.x(out, Eigen::all);
    const Eigen::VectorXd means = process.predict_marginal(points).mean;
    for (std::size_t i = 0; i < out.size(); ++i) predicted[out[i]] = means[static_cast<Eigen::Index>(i)];
  });
  return predicted;
}

std::vector<double> in_unit(const Eigen::VectorXd& values, const data::Unit& unit) {
  std::vector<double> shown;
  for (const double value : values) shown.push_back(unit.from_si(value));
  return shown;
}

SurrogateReport report_of(const data::Study& study, const TrainingRows& rows, const surrogate::GaussianProcess& process,
                          const SurrogateOptions& options) {
  const data::Output& output = study.outputs[rows.output];
  const surrogate::LeaveOneOut loo = process.leave_one_out();
  SurrogateReport report;
  report.output = output.name;
  report.material = rows.material;
  report.runs = static_cast<int>(rows.set.y.size());
  report.unit = output.unit.symbol;
  report.q2 = q_squared(rows.set.y, loo.mean);
  report.coverage95 = static_cast<double>((loo.standardised.array().abs() <= 1.959964).count()) /
                      static_cast<double>(loo.standardised.size());
  const surrogate::HyperParameters hyper = process.hyper_parameters();
  const bool logarithmic = options.fit.scale == surrogate::OutputScale::log;
  report.nugget_sd =
      logarithmic ? hyper.nugget_sd * output.unit.from_si(rows.set.y.mean()) : hyper.nugget_sd / output.unit.factor;
  for (std::size_t k = 0; k < rows.inputs.size(); ++k) {
    const EmulatorInput& input = rows.inputs[k];
    report.inputs.push_back(input.kind == InputKind::parameter ? study.parameters[input.index].name
                                                               : study.controls[input.index].name);
    report.length_scales.push_back(hyper.length_scales[static_cast<Eigen::Index>(k)]);
  }
  report.observed = in_unit(rows.set.y, output.unit);
  report.predicted = in_unit(loo.mean, output.unit);
  report.standardised.assign(loo.standardised.begin(), loo.standardised.end());
  for (const double variance : rows.set.noise_variance)
    report.observed_se.push_back(std::sqrt(variance) / output.unit.factor);

  const surrogate::FitDiagnostics& diagnostics = process.diagnostics();
  if (!diagnostics.converged) report.notes.push_back("the hyper-parameters' optimiser did not converge");
  if (diagnostics.jitter > 0.0)
    report.notes.push_back(fmt::format("jitter {:.1e} of the output's variance was needed", diagnostics.jitter));
  for (const auto& hit : diagnostics.bound_hits)
    report.notes.push_back(fmt::format("{} is on its {} bound {:.3g}{}", hit.parameter, hit.upper ? "upper" : "lower",
                                       hit.value, hit.harmless ? " (harmless)" : ""));
  report.notes.push_back(fmt::format("{} of {} starts of the optimiser ended at the same likelihood",
                                     diagnostics.agreeing_starts, diagnostics.starts.size()));

  report.q2_held_out =
      report.runs >= 3 * options.folds ? q_squared(rows.set.y, held_out(rows.set, options)) : std::nan("");
  const double q2 = std::isfinite(report.q2_held_out) ? std::min(report.q2, report.q2_held_out) : report.q2;
  const double median_noise = std::sqrt(rows.set.noise_variance.mean());
  const double scatter = std::sqrt((rows.set.y.array() - rows.set.y.mean()).square().mean());
  report.finding = fmt::format(
      "Q2 is {:.3f} (leave-one-out) and {:.3f} (held out, refitted); {:.0f} % of the runs lie in their 95 % intervals; "
      "the runs' own noise is {:.1f} % of their scatter.",
      report.q2, report.q2_held_out, 100.0 * report.coverage95, 100.0 * median_noise / scatter);
  if (q2 >= 0.9 && report.coverage95 >= 0.85) {
    report.verdict = "good";
    report.consequence = "Its error is small beside what the parameters change, and is counted in every result.";
    report.remedy = "None needed.";
  } else if (q2 >= 0.6 && report.coverage95 >= 0.75) {
    report.verdict = "caution";
    report.consequence = "Its error widens the posteriors; where it understates that error they are too narrow.";
    report.remedy = "More training runs, or longer ones.";
  } else {
    report.verdict = "unusable";
    report.consequence = "Results that rest on it mean little.";
    report.remedy = "More training runs, a narrower range of the parameters, or longer runs.";
  }
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
    auto process = std::make_shared<const surrogate::GaussianProcess>(surrogate::fit(part.set, options.fit));
    SurrogateReport report = report_of(study, part, *process, options);
    fitted.push_back({.rows = std::move(part), .process = std::move(process), .report = std::move(report)});
  }
  return fitted;
}

}  // namespace uq
