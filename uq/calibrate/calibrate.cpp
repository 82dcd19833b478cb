#include "uq/calibrate/calibrate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

#include "data/error.hpp"
#include "data/random.hpp"
#include "uq/calibrate/data_check.hpp"
#include "uq/findings/study_units.hpp"
#include "uq/findings/thresholds.hpp"
#include "uq/findings/wording.hpp"
#include "uq/posterior/predictive.hpp"
#include "uq/posterior/support.hpp"
#include "uq/posterior/unused_data.hpp"

namespace uq {
namespace {

constexpr int scan_scouts = 8000;  // of each measurement error that is tried, at most

void add_findings(CalibrationReport& report, const std::vector<data::Finding>& findings) {
  report.findings.insert(report.findings.end(), findings.begin(), findings.end());
  for (const data::Finding& finding : findings)
    (finding.severity == data::Severity::note ? report.cautions : report.warnings).push_back(data::describe(finding));
}

/// The remedies of a case behind one that comes before them; "None needed." is none.
std::string before_remedy(const std::string& first, const std::string& remedy) {
  return remedy.starts_with("None needed") ? first : first + " Then: " + remedy;
}

/// Puts suspicions about units and errors before any other remedy.
void put_suspicions_first(CaseReport& report, const std::vector<data::Finding>& findings) {
  using enum data::FindingKind;
  for (const data::Finding& finding : findings)
    if (finding.severity == data::Severity::warning &&
        (finding.kind == unit || (finding.kind == standard_errors && report.lone_reading.empty()) ||
         finding.kind == no_response)) {
      report.remedy = before_remedy(
          fmt::format("First settle what is said of the data ({}: {}).", to_text(finding.kind), finding.place),
          report.remedy);
      return;
    }
}

/// Values that fail a prediction are no values to be used there, however well they are known.
void put_failed_prediction_first(CaseReport& report, const std::string& name) {
  report.consequence =
      fmt::format("The values describe the data that they come from, and not {}. {}", name, report.consequence);
  report.remedy = before_remedy(
      fmt::format("First find out what differs at {}: calibrate with it, too; where nothing fits both, the "
                  "model lacks what acts there.",
                  name),
      report.remedy);
}

/// The surrogates again without the runs that the others contradict; none where there are no such runs, or too few
/// others.
std::vector<FittedSurrogate> without_outlying(const data::Study& study, const data::RunTable& table,
                                              SurrogateOptions options, const std::vector<FittedSurrogate>& fitted) {
  std::set<std::string> places;
  options.known.clear();
  for (const FittedSurrogate& one : fitted) {
    for (const OutlyingRun& run : one.report.outlying) places.insert(run.place);
    if (one.report.outlying.empty()) options.known.push_back(one);
  }
  if (places.empty()) return {};
  data::RunTable rest = table;
  for (data::RunRow& row : rest.rows)
    if (!row.left_out && places.contains(row.place))
      row.left_out = {data::LeftOut::Because::others_contradict, "contradicted by the others"};
  if (data::used_rows(rest) == data::used_rows(table)) return {};
  try {
    return fit_surrogates(study, rest, options);
  } catch (const data::InputError&) {
    return {};
  }
}

/// The case with the surrogates of the other runs, where it rests on runs that they contradict; where that changes the
/// result, nothing is identified until somebody has decided on the runs.
std::optional<WithoutRuns> without_runs(const data::Study& study, const std::vector<FittedSurrogate>& fitted,
                                        const std::vector<FittedSurrogate>& others, const SampledCase& sampled,
                                        std::size_t index, CalibrateOptions& options) {
  std::vector<std::string> places;
  for (const RowGroup& group : sampled.model->groups)
    for (const FittedSurrogate& one : fitted)
      if (one.rows.material == group.emulator.material && one.rows.output == group.emulator.output)
        for (const OutlyingRun& run : one.report.outlying) places.push_back(run.place);
  if (places.empty()) return {};
  CalibrateOptions plain = options;
  plain.identify.unsupported.clear();
  WithoutRuns without = calibrate_without(study, others, index, plain);
  without.places = places;
  const std::string which = data::list_places(places);
  without.sentence = fmt::format("Without {}: {}", which, without.sentence);
  if (!options.identify.unsupported.empty() || sampled.draws.chains.empty()) return without;
  const Eigen::MatrixXd draws = sampled.draws.pooled();
  bool matters = false;
  for (std::size_t k = 0; k < without.parameters.size(); ++k) {
    const ParameterAgain& other = without.parameters[k];
    const auto column = static_cast<Eigen::Index>(k);
    const Unknown& unknown = sampled.model->unknowns[k];
    Eigen::VectorXd values = draws.col(column);
    for (double& value : values) value = in_study_unit(unknown.prior.parameter(), value);
    const double sd = std::sqrt((values.array() - values.mean()).square().mean());
    matters = matters || std::abs(values.mean() - other.mean) > decided_shift * other.sd ||
              sd > decided_factor * other.sd || sd < other.sd / decided_factor;
  }
  if (matters)
    options.identify.unsupported.assign(
        static_cast<std::size_t>(sampled.model->own_count()),
        fmt::format("the result depends on {}, which all other runs contradict", which));
  return without;
}

ParameterAgain again(const ParameterReport& parameter) {
  return {.name = parameter.name,
          .verdict = parameter.verdict,
          .reason = parameter.reason,
          .borderline = parameter.borderline,
          .mean = parameter.mean,
          .sd = parameter.sd};
}

/// Tells how far a calibration is.
class Steps {
 public:
  Steps(const CalibrateOptions& options, double length) : progress_(options.progress), length_(length) {}
  void begin(std::string step, double length = 1.0) {
    step_ = std::move(step);
    from_ = to_;
    to_ += length / length_;
    tell(0.0);
  }
  /// Reports how much of the current step is done.
  void tell(double share) const {
    if (progress_) progress_(step_, from_ + share * (to_ - from_));
  }

 private:
  std::function<void(const std::string&, double)> progress_;
  std::string step_;
  double length_, from_ = 0.0, to_ = 0.0;
};

}  // namespace

WithoutRuns calibrate_without(const data::Study& study, const std::vector<FittedSurrogate>& others,
                              std::size_t case_index, const CalibrateOptions& options) {
  WithoutRuns found;
  const SampledCase sampled = sample_case(study, emulators_of(others), case_index, options);
  if (sampled.draws.chains.empty()) {
    found.sentence = "the posterior could not be sampled: " + sampled.draws.reason;
    return found;
  }
  IdentifyOptions judged = options.identify;
  judged.unsupported = unsupported_parameters(*sampled.model, sampled.support);
  const Identification identified = identify(*sampled.model, sampled.draws.pooled(), judged);
  found.fits = identified.fits;
  for (const ParameterReport& parameter : identified.parameters) {
    found.parameters.push_back(again(parameter));
    found.sentence += fmt::format("{}{} {} ({})", found.sentence.empty() ? "" : ", ", parameter.name,
                                  format_with_error(parameter.mean, parameter.sd, parameter.unit, Typography::ascii),
                                  to_text(parameter.verdict));
  }
  if (!sampled.draws.converged) found.sentence += "; the chains have not converged";
  found.sentence += ".";
  return found;
}

std::vector<ErrorScan> scan_errors(const data::Study& study, const SampledCase& sampled, std::size_t case_index,
                                   const CalibrateOptions& options) {
  std::vector<ErrorScan> scans;
  if (sampled.draws.chains.empty()) return scans;
  const Eigen::VectorXd truth = mean_prediction(*sampled.model, sampled.draws.pooled());
  data::RandomStream random(seed_of(study, options), data::Purpose::measurement_noise,
                            static_cast<std::uint32_t>(case_index));
  Eigen::VectorXd normal(truth.size());
  for (double& value : normal) value = random.normal();
  std::uint32_t index = 0;
  for (const double error : options.error_scan) {
    CalibrateOptions own = options;
    const double before = static_cast<double>(index) / static_cast<double>(options.error_scan.size());
    if (options.progress)
      own.sampling_progress = [&, before](double share) {
        options.progress(fmt::format("errors of {:g} %", 100.0 * error),
                         before + 0.9 * share / static_cast<double>(options.error_scan.size()));
      };
    own.seed = data::child_seed(seed_of(study, options), data::Purpose::error_scan_seed,
                                static_cast<std::uint32_t>(case_index << 8) + index++);
    // Words alone are asked of it, and the case's own search has looked for maxima.
    own.mixture.explore.scouts = std::min(scouts_for(sampled.model->dimension()), scan_scouts);
    const Eigen::VectorXd sd = error * truth.cwiseAbs();
    const Eigen::VectorXd y = truth + own_errors(sd.cwiseAbs2(), sampled.model->linked_errors, normal);
    const auto model = std::make_shared<const CaseModel>(with_data(*sampled.model, y, sd.cwiseAbs2()));
    const Draws draws = sample_model(study, sampled, model, own, 500);
    ErrorScan scan;
    scan.case_name = model->name;
    scan.relative_error = error;
    if (!draws.chains.empty()) {
      const Identification found = identify(*model, draws.pooled(), options.identify);
      scan.ppp = found.check.predictive_p;
      for (const ParameterReport& parameter : found.parameters) scan.parameters.push_back(again(parameter));
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
  const double scan = static_cast<double>(options.error_scan.size());  // as long as a case for each error
  Steps steps(options, 1.0 + static_cast<double>(study.cases.size()) * (1.0 + scan));
  Calibration result;
  CalibrationReport& report = result.report;
  report.study_name = study.name;
  report.study_description = study.description;
  report.study_file = study.file;

  steps.begin("surrogates");
  data::RunTable rows = table;
  const std::vector<data::Finding> findings =
      options.findings ? *options.findings
                       : check_data(study, rows, options.surrogates.low, options.surrogates.log_outputs);
  data::refuse(findings);
  add_findings(report, findings);
  SurrogateOptions surrogates = options.surrogates;
  surrogates.fit.seed = seed_of(study, options);
  surrogates.observed_only = true;
  result.surrogates = fit_surrogates(study, rows, surrogates);
  report.designs = designs_of(study, rows, result.surrogates);
  const std::vector<Emulator> emulators = emulators_of(result.surrogates);
  for (const auto& fitted : result.surrogates) {
    report.surrogates.push_back(fitted.report);
    for (const std::string& note : extrapolation_notes(study, fitted.rows))
      report.surrogates.back().notes.push_back(note);
  }
  for (std::string& warning : surrogate_warnings(result.surrogates)) report.warnings.push_back(std::move(warning));
  for (std::string& caution : surrogate_cautions(result.surrogates)) report.cautions.push_back(std::move(caution));
  const std::vector<FittedSurrogate> others = without_outlying(study, rows, surrogates, result.surrogates);

  for (std::size_t index = 0; index < study.cases.size(); ++index) {
    steps.begin("case " + study.cases[index].name);
    CalibrateOptions sampling = options;
    sampling.sampling_progress = [&](double share) { steps.tell(0.9 * share); };
    result.cases.push_back(sample_case(study, emulators, index, sampling));
    const SampledCase& sampled = result.cases.back();
    CalibrateOptions own = options;
    own.identify.unsupported = unsupported_parameters(*sampled.model, sampled.support);
    std::optional<WithoutRuns> without;
    if (!others.empty()) without = without_runs(study, result.surrogates, others, sampled, index, own);
    report.cases.push_back(report_case(study, sampled, own));
    CaseReport& made = report.cases.back();
    made.without = std::move(without);
    put_suspicions_first(made, findings);
    for (const data::UnusedData& wanted : study.unused_data) {
      if (wanted.case_index != index || made.unusable || sampled.draws.chains.empty()) continue;
      made.predictions.push_back(predict_unused(study, emulators, wanted, *sampled.model, sampled.draws.pooled()));
      if (made.predictions.back().predicts) continue;
      made.warnings.push_back(fmt::format("case {}: {}", made.name, made.predictions.back().sentence));
      put_failed_prediction_first(made, made.predictions.back().name);
    }
    if (made.doubt.empty()) made.comparisons = compare_models(study, sampled, index, own);
    if (options.error_scan.empty()) continue;
    steps.begin("error scan of case " + study.cases[index].name, scan);
    if (!made.doubt.empty()) continue;  // what another error would give is as doubtful
    own.progress = [&](const std::string&, double share) { steps.tell(share); };
    for (auto& one : scan_errors(study, sampled, index, own)) report.error_scan.push_back(std::move(one));
  }
  report.warning = !first_lines(report).empty();
  report.thresholds = describe(options.identify.thresholds);
  for (auto& threshold : describe(SupportThresholds{})) report.thresholds.push_back(std::move(threshold));
  report.provenance.emplace_back("seed", std::to_string(seed_of(study, options)));
  report.provenance.emplace_back("runs in the table", std::to_string(data::used_rows(rows)));
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  report.provenance.emplace_back("calibration time", fmt::format("{:.1f} s", elapsed.count()));
  if (options.progress) options.progress("done", 1.0);
  return result;
}

}  // namespace uq
