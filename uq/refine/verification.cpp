#include "uq/refine/verification.hpp"

#include <fmt/core.h>
#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "uq/findings/study_units.hpp"
#include "uq/findings/wording.hpp"
#include "uq/posterior/prior.hpp"

namespace uq {
namespace {

using Eigen::Index;

/// The surrogate's inputs at a row.
Eigen::VectorXd inputs_at(const data::Study& study, const TrainingRows& rows, const data::RunRow& row) {
  Eigen::VectorXd point(static_cast<Index>(rows.inputs.size()));
  for (std::size_t k = 0; k < rows.inputs.size(); ++k) {
    const std::size_t index = rows.inputs[k].index;
    point[k] = rows.inputs[k].kind == InputKind::parameter
                   ? study.parameters[index].axis().to_unit(row.inputs[index])
                   : study.controls[index].axis().to_unit(row.inputs[study.parameters.size() + index]);
  }
  return point;
}

/// Variance of a run about the surrogate's function, beyond its stated error.
double scatter(const FittedSurrogate& fitted, double mean) {
  if (fitted.two_level) return std::pow(fitted.two_level->parameters().nugget_sd, 2);
  const double sd = fitted.process->hyper_parameters().nugget_sd;
  return std::pow(fitted.process->data().scale == surrogate::OutputScale::log ? sd * mean : sd, 2);
}

std::map<std::string, double> values_of(const data::Study& study, const data::RunRow& row) {
  const auto parameters = study.parameters.size();
  std::map<std::string, double> values = named_controls(study, std::span(row.inputs).subspan(parameters));
  for (std::size_t p = 0; p < parameters; ++p)
    values[study.parameters[p].name] = study.parameters[p].unit.from_si(row.inputs[p]);
  return values;
}

/// Adds one output of one material: appends its values and adds its distance.
void add_output(const data::Study& study, const FittedSurrogate& fitted, const std::vector<VerificationRun>& runs,
                VerificationReport& report) {
  const std::size_t output = fitted.rows.output;
  std::vector<const VerificationRun*> own;
  for (const VerificationRun& run : runs)
    if (run.row.material == fitted.rows.material && std::isfinite(run.row.outputs[output])) own.push_back(&run);
  if (own.empty()) return;
  const auto count = static_cast<Index>(own.size());
  Eigen::MatrixXd points(count, static_cast<Index>(fitted.rows.inputs.size()));
  for (Index i = 0; i < count; ++i) points.row(i) = inputs_at(study, fitted.rows, own[i]->row).transpose();
  const surrogate::Prediction prediction = emulator_of(fitted).predict(points);
  Eigen::MatrixXd total = prediction.covariance;
  Eigen::VectorXd residual(count);
  const data::Unit& unit = study.outputs[output].unit;
  for (Index i = 0; i < count; ++i) {
    const VerificationRun& run = *own[i];
    const double mean = prediction.mean[i], value = run.row.outputs[output], error = run.row.standard_errors[output];
    const double of_surrogate = prediction.covariance(i, i) + scatter(fitted, mean);
    total(i, i) = of_surrogate + error * error;
    residual[i] = value - mean;
    report.values.push_back({.inputs = values_of(study, run.row),
                             .material = run.row.material,
                             .output = study.outputs[output].name,
                             .unit = unit.symbol,
                             .label = run.label,
                             .predicted = unit.from_si(mean),
                             .predicted_sd = std::sqrt(of_surrogate) / unit.factor,
                             .simulated = unit.from_si(value),
                             .standard_error = error / unit.factor,
                             .z = residual[i] / std::sqrt(std::max(total(i, i), 1e-300))});
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(total);
  report.dof += static_cast<int>(count);
  // Where the covariance cannot be factorised, the values count one by one.
  report.chi2 += factor.info() == Eigen::Success
                     ? residual.dot(factor.solve(residual))
                     : (residual.array().square() / total.diagonal().array().max(1e-300)).sum();
}

}  // namespace

VerificationReport verify(const data::Study& study, const std::vector<FittedSurrogate>& surrogates,
                          const std::vector<VerificationRun>& runs) {
  VerificationReport report;
  report.runs = static_cast<int>(runs.size());
  std::set<std::vector<double>> points;
  for (const VerificationRun& run : runs)
    points.insert(
        {run.row.inputs.begin(), run.row.inputs.begin() + static_cast<std::ptrdiff_t>(study.parameters.size())});
  report.points = static_cast<int>(points.size());
  for (const FittedSurrogate& fitted : surrogates) add_output(study, fitted, runs, report);
  if (report.values.empty()) return report;
  report.p = gsl_cdf_chisq_Q(report.chi2, report.dof);
  const double each = 1.0 - std::pow(1.0 - least_p, 1.0 / static_cast<double>(report.values.size()));
  report.z_limit = gsl_cdf_ugaussian_Qinv(0.5 * each);
  report.agrees =
      report.p >= least_p && std::all_of(report.values.begin(), report.values.end(),
                                         [&](const VerifiedValue& v) { return std::abs(v.z) <= report.z_limit; });
  return report;
}

std::string verification_sentence(const VerificationReport& report, const std::string& simulation) {
  if (report.values.empty()) return {};
  const auto worst = std::max_element(report.values.begin(), report.values.end(),
                                      [](const auto& a, const auto& b) { return std::abs(a.z) < std::abs(b.z); });
  const std::string numbers =
      fmt::format("chi-squared {:.1f} for {} values (p = {}), largest deviation {:.1f} sd", report.chi2, report.dof,
                  significant(report.p, 2, Typography::ascii), std::abs(worst->z));
  if (report.agrees)
    return fmt::format("Confirmed by {} runs of {} at {} points of the posterior: {}.", report.runs, simulation,
                       report.points, numbers);
  std::string where;
  int named = 0;
  for (const VerifiedValue& value : report.values) {
    if (std::abs(value.z) <= std::min(report.z_limit, std::abs(worst->z) - 1e-9) && &value != &*worst) continue;
    if (++named > 4) continue;
    std::string at;
    for (const auto& [name, number] : value.inputs)
      at += fmt::format("{}{} {:.4g}", at.empty() ? "" : ", ", name, number);
    where +=
        fmt::format("{}{} ({}): {} {} where the surrogate has {} {}", where.empty() ? "" : "; ", value.label, at,
                    format_with_error(value.simulated, value.standard_error, value.unit, Typography::ascii),
                    value.output, format_with_error(value.predicted, value.predicted_sd, value.unit, Typography::ascii),
                    fmt::format("({:+.1f} sd)", value.z));
  }
  if (named > 4) where += fmt::format("; and {} more", named - 4);
  return fmt::format("Not confirmed by {} runs of {} at {} points of the posterior: {}. {}.", report.runs, simulation,
                     report.points, numbers, where);
}

}  // namespace uq
