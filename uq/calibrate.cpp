#include "uq/calibrate.hpp"

#include <fmt/core.h>

#include <chrono>

#include "data/error.hpp"
#include "data/random.hpp"
#include "uq/predictive.hpp"

namespace uq {

std::vector<ErrorScan> scan_errors(const data::Study& study, const SampledCase& sampled, std::size_t case_index,
                                   const CalibrateOptions& options) {
  std::vector<ErrorScan> scans;
  if (sampled.draws.chains.empty()) return scans;
  const Eigen::VectorXd truth = mean_prediction(*sampled.model, sampled.draws.pooled());
  data::RandomStream random(seed_of(study, options), data::Purpose::measurement_noise,
                            static_cast<std::uint32_t>(case_index));
  Eigen::VectorXd normal(truth.size());
  for (double& value : normal) value = random.normal();
  for (const double error : options.error_scan) {
    const Eigen::VectorXd sd = error * truth.cwiseAbs();
    const Eigen::VectorXd y = truth + sd.cwiseProduct(normal);
    const auto model = std::make_shared<const CaseModel>(with_data(*sampled.model, y, sd.cwiseAbs2()));
    const Draws draws = sample_model(study, sampled, model, options, 500);
    ErrorScan scan;
    scan.case_name = model->name;
    scan.relative_error = error;
    if (!draws.chains.empty()) {
      const Identification found = identify(*model, draws.pooled(), options.identify);
      scan.ppp = found.check.predictive_p;
      for (const auto& parameter : found.parameters) {
        scan.parameters.push_back(parameter.name);
        std::string verdict = to_text(parameter.verdict);
        if (parameter.reason) verdict += " (" + *parameter.reason + ")";
        if (parameter.borderline) verdict += ", borderline";
        scan.verdicts.push_back(verdict);
        scan.mean.push_back(parameter.mean);
        scan.sd.push_back(parameter.sd);
      }
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

Calibration calibrate_all(const data::Study& study, const data::RunTable& table, const CalibrateOptions& options) {
  if (study.cases.empty())
    throw data::InputError(data::ExitStatus::bad_study, {study.file, "the study has no [[calibrate]] case",
                                                         "add one: what to free, given which observations"});
  const auto begin = std::chrono::steady_clock::now();
  const double steps = 1.0 + static_cast<double>(study.cases.size()) * (options.error_scan.empty() ? 1.0 : 2.0);
  double done = 0.0;
  auto tell = [&](const std::string& step) {
    if (options.progress) options.progress(step, done / steps);
    done += 1.0;
  };
  Calibration result;
  CalibrationReport& report = result.report;
  report.study_name = study.name;
  report.study_description = study.description;
  report.study_file = study.file;

  tell("surrogates");
  SurrogateOptions surrogates = options.surrogates;
  surrogates.fit.seed = seed_of(study, options);
  surrogates.observed_only = true;
  result.surrogates = fit_surrogates(study, table, surrogates);
  const std::vector<Emulator> emulators = emulators_of(result.surrogates);
  for (const auto& fitted : result.surrogates) {
    report.surrogates.push_back(fitted.report);
    for (const std::string& note : extrapolation_notes(study, fitted.rows))
      report.surrogates.back().notes.push_back(note);
    const std::string name =
        fitted.report.output + (fitted.report.material.empty() ? "" : " of " + fitted.report.material);
    if (fitted.report.verdict == "unusable")
      report.warnings.push_back(fmt::format("the surrogate of {} is unusable: {}", name, fitted.report.finding));
    if (!fitted.report.converged)
      report.warnings.push_back(fmt::format("the fit of the surrogate of {} did not converge", name));
  }

  for (std::size_t index = 0; index < study.cases.size(); ++index) {
    tell("case " + study.cases[index].name);
    result.cases.push_back(sample_case(study, emulators, index, options));
    report.cases.push_back(report_case(study, result.cases.back(), options));
    report.cases.back().comparisons = compare_models(study, emulators, result.cases.back(), index, options);
    const CaseReport& made = report.cases.back();
    report.warnings.insert(report.warnings.end(), made.warnings.begin(), made.warnings.end());
    if (options.error_scan.empty()) continue;
    tell("error scan of case " + study.cases[index].name);
    for (auto& scan : scan_errors(study, result.cases.back(), index, options))
      report.error_scan.push_back(std::move(scan));
  }
  report.warning = !report.warnings.empty();
  report.thresholds = describe(options.identify.thresholds);
  report.provenance.emplace_back("seed", std::to_string(seed_of(study, options)));
  report.provenance.emplace_back("runs in the table", std::to_string(table.rows.size()));
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  report.provenance.emplace_back("calibration time", fmt::format("{:.1f} s", elapsed.count()));
  if (options.progress) options.progress("done", 1.0);
  return result;
}

CalibrationReport calibrate(const data::Study& study, const data::RunTable& table, const CalibrateOptions& options) {
  return calibrate_all(study, table, options).report;
}

}  // namespace uq
