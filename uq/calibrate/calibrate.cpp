#include "uq/calibrate/calibrate.hpp"

#include <fmt/core.h>

#include <chrono>
#include <numeric>
#include <thread>

#include "data/error.hpp"
#include "uq/calibrate/data_check.hpp"
#include "uq/calibrate/effort.hpp"
#include "uq/calibrate/without_runs.hpp"
#include "uq/findings/study_units.hpp"
#include "uq/findings/thresholds.hpp"
#include "uq/findings/wording.hpp"
#include "uq/posterior/support.hpp"
#include "uq/posterior/unused_data.hpp"

namespace uq {
namespace {

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
    if (finding.severity == data::Severity::warning && (finding.kind == unit || finding.kind == standard_errors ||
                                                        finding.kind == no_response || finding.kind == counted_twice)) {
      report.consequence = "That holds only if the data are right as they stand. " + report.consequence;
      report.remedy = before_remedy(
          fmt::format("First settle what is said of the data ({}: {}).", to_text(finding.kind), finding.place),
          report.remedy);
      return;
    }
}

/// Where nothing fits and a surrogate is in doubt, the misfit may be the surrogate's: runs come before the look at the
/// bench.
void put_doubted_surrogate_first(CaseReport& report, const CaseModel& model,
                                 const std::vector<FittedSurrogate>& surrogates) {
  if (report.fits || report.unusable) return;
  for (const RowGroup& group : model.groups)
    for (const FittedSurrogate& one : surrogates) {
      if (one.rows.material != group.emulator.material || one.rows.output != group.emulator.output) continue;
      if (one.report.verdict != SurrogateWord::caution) continue;
      report.consequence =
          fmt::format("The surrogate of {} is in doubt, too, so that its error may be what does not fit. {}",
                      one.report.output, report.consequence);
      report.remedy = before_remedy("First make the surrogate sure. " + one.report.remedy, report.remedy);
      return;
    }
}

/// Values that fail a prediction are no values to be used there, however well they are known.
void put_failed_prediction_first(CaseReport& report, const PredictionReport& prediction) {
  const std::string& name = prediction.name;
  report.consequence =
      fmt::format("The values describe the data that they come from, and not {}. {}", name, report.consequence);
  report.remedy = before_remedy(
      prediction.unsupported > 0
          ? fmt::format("First make training runs at the settings of {}, where none speaks.", name)
          : fmt::format("First find out what differs at {}: calibrate with it, too; where nothing fits both, the "
                        "model lacks what acts there.",
                        name),
      report.remedy);
}

/// What the cases of a calibration stand on.
struct Basis {
  const data::Study& study;
  const std::vector<data::Finding>& findings;  ///< findings about the data
  const std::vector<FittedSurrogate>& surrogates;
  const std::vector<Emulator>& emulators;
};

/// For each own parameter, why no verdict can rest on the runs; empty where one can. Where runs that the others
/// contradict change the result, nothing is identified until somebody has decided on them.
std::vector<std::string> unsupported_in(const SampledCase& sampled, const std::optional<WithoutRuns>& without) {
  std::vector<std::string> why = unsupported_parameters(*sampled.model, sampled.support);
  if (why.empty() && without && depends_on_runs(sampled, *without))
    why.assign(
        static_cast<std::size_t>(sampled.model->own_count()),
        fmt::format("the result depends on {}, which all other runs contradict", data::list_places(without->places)));
  return why;
}

/// Compares what the case says of unused data with these, and says where it fails.
void add_predictions(CaseReport& made, const Basis& basis, const SampledCase& sampled, std::size_t index) {
  if (made.unusable || sampled.draws.chains.empty()) return;
  for (const data::UnusedData& wanted : basis.study.unused_data) {
    if (wanted.case_index != index) continue;
    made.predictions.push_back(
        predict_unused(basis.study, basis.emulators, wanted, *sampled.model, sampled.draws.pooled()));
    const PredictionReport& prediction = made.predictions.back();
    if (!prediction.predicts || prediction.unsupported > 0)
      made.warnings.push_back(fmt::format("case {}: {}", made.name, prediction.sentence));
    if (!prediction.predicts) put_failed_prediction_first(made, prediction);
  }
}

/// All that is said of a sampled case. `own`: the options with what is unsupported in it.
CaseReport whole_report(const Basis& basis, const SampledCase& sampled, std::size_t index,
                        std::optional<WithoutRuns> without, const CalibrateOptions& own) {
  CaseReport made = report_case(basis.study, sampled, own);
  made.without = std::move(without);
  put_doubted_surrogate_first(made, *sampled.model, basis.surrogates);
  put_suspicions_first(made, basis.findings);
  add_predictions(made, basis, sampled, index);
  if (made.doubt.empty()) made.comparisons = compare_models(basis.study, sampled, index, own);
  return made;
}

/// A run table after the looks at the data, and what they found.
struct LookedAt {
  data::RunTable rows;  ///< rows with those marked that are left out
  std::vector<data::Finding> findings;
};

LookedAt look_at(const data::Study& study, const data::RunTable& table, const CalibrateOptions& options) {
  LookedAt seen{.rows = table, .findings = {}};
  seen.findings = options.findings
                      ? *options.findings
                      : check_data(study, seen.rows, options.surrogates.low, options.surrogates.log_outputs);
  data::refuse(seen.findings);
  return seen;
}

/// What is said of the study's data and of the surrogates made of them.
CalibrationReport report_of_runs(const data::Study& study, const LookedAt& looked_at,
                                 const std::vector<FittedSurrogate>& surrogates) {
  CalibrationReport report;
  report.study_name = study.name;
  report.study_description = study.description;
  report.study_file = study.file;
  add_findings(report, looked_at.findings);
  report.designs = designs_of(study, looked_at.rows, surrogates);
  for (const auto& fitted : surrogates) {
    report.surrogates.push_back(fitted.report);
    for (const std::string& note : extrapolation_notes(study, fitted.rows))
      report.surrogates.back().notes.push_back(note);
  }
  for (std::string& warning : surrogate_warnings(surrogates)) report.warnings.push_back(std::move(warning));
  for (std::string& caution : surrogate_cautions(surrogates)) report.cautions.push_back(std::move(caution));
  return report;
}

/// Tells how far a calibration is. Lengths are seconds, as far as they can be foretold.
class Steps {
 public:
  Steps(const CalibrateOptions& options, double length) : progress_(options.progress), length_(length) {}
  void begin(std::string step, double length) {
    step_ = std::move(step);
    from_ = to_;
    to_ += length;
    tell(0.0);
  }
  /// Reports how much of the current step is done.
  void tell(double share) const {
    if (progress_) progress_(step_, (from_ + share * (to_ - from_)) / length_);
  }
  /// The current step is done and took so long, whatever was foretold.
  void took(double seconds) {
    length_ += seconds - (to_ - from_);
    to_ = from_ + seconds;
    tell(1.0);
  }

 private:
  std::function<void(const std::string&, double)> progress_;
  std::string step_;
  double length_, from_ = 0.0, to_ = 0.0;
};

/// About how long each case takes, s: its sampling, and what a small one takes.
std::vector<double> lengths_of_cases(const data::Study& study, const data::RunTable& table,
                                     const CalibrateOptions& options) {
  constexpr double at_least = 1.0;
  const int threads = options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
  std::vector<double> lengths;
  for (const data::CalibrationCase& one : study.cases)
    lengths.push_back(at_least + sampling_seconds(study, one, table, options.surrogates) / std::max(1, threads));
  return lengths;
}

}  // namespace

Calibration calibrate_all(const data::Study& study, const data::RunTable& table, const CalibrateOptions& options) {
  if (study.cases.empty())
    throw data::InputError(data::ExitStatus::bad_study, {study.file, "the study has no [[calibrate]] case",
                                                         "add one: what to free, given which observations"});
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  const double scan = static_cast<double>(options.error_scan.size());  // as long as a case for each error
  const std::vector<double> lengths = lengths_of_cases(study, table, options);
  Steps steps(options, 1.0 + (1.0 + scan) * std::accumulate(lengths.begin(), lengths.end(), 0.0));

  // The surrogates, and what they and the data are worth.
  steps.begin("surrogates", 1.0);
  const LookedAt looked_at = look_at(study, table, options);
  SurrogateOptions learning = options.surrogates;
  learning.fit.seed = seed_of(study, options);
  learning.observed_only = true;
  Calibration result;
  result.surrogates = fit_surrogates(study, looked_at.rows, learning);
  result.report = report_of_runs(study, looked_at, result.surrogates);
  CalibrationReport& report = result.report;
  const std::vector<Emulator> emulators = emulators_of(result.surrogates);
  const std::vector<FittedSurrogate> others = without_outlying(study, looked_at.rows, learning, result.surrogates);
  steps.took(seconds());
  const Basis basis{
      .study = study, .findings = looked_at.findings, .surrogates = result.surrogates, .emulators = emulators};

  // Each case, and each again with other errors of its measurement.
  for (std::size_t index = 0; index < study.cases.size(); ++index) {
    steps.begin("case " + study.cases[index].name, lengths[index]);
    CalibrateOptions own = options;
    own.sampling_progress = [&](double share) { steps.tell(0.9 * share); };
    result.cases.push_back(sample_case(study, emulators, index, own));
    const SampledCase& sampled = result.cases.back();
    own.sampling_progress = options.sampling_progress;
    std::optional<WithoutRuns> without = without_runs(study, {result.surrogates, others}, sampled, index, options);
    own.identify.unsupported = unsupported_in(sampled, without);
    report.cases.push_back(whole_report(basis, sampled, index, std::move(without), own));
    if (options.error_scan.empty()) continue;
    steps.begin("error scan of case " + study.cases[index].name, scan * lengths[index]);
    if (!report.cases.back().doubt.empty()) continue;  // what another error would give is as doubtful
    own.progress = [&](const std::string&, double share) { steps.tell(share); };
    for (auto& one : scan_errors(study, sampled, index, own)) report.error_scan.push_back(std::move(one));
  }

  // By what it was judged, and where it comes from.
  report.warning = !first_lines(report).empty();
  report.thresholds = describe(options.identify.thresholds);
  for (auto& threshold : describe(SupportThresholds{})) report.thresholds.push_back(std::move(threshold));
  report.provenance.emplace_back("seed", std::to_string(seed_of(study, options)));
  report.provenance.emplace_back("runs in the table", std::to_string(data::used_rows(looked_at.rows)));
  report.provenance.emplace_back("calibration time", fmt::format("{:.1f} s", seconds()));
  if (options.progress) options.progress("done", 1.0);
  return result;
}

}  // namespace uq
