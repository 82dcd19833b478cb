// demcal calibrate: the main job. Surrogates, posteriors, verdicts, report; with --verify the posteriors are confirmed
// by runs of the simulation at their points, which then join the table.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <thread>

#include "campaign/out_files.hpp"
#include "campaign/verify.hpp"
#include "cli/calibration.hpp"
#include "cli/make_runs.hpp"
#include "cli/train_posterior.hpp"
#include "data/interrupt.hpp"
#include "data/number_text.hpp"
#include "uq/calibrate/posterior_nc.hpp"

namespace cli {
namespace {

struct CalibrateCommand {
  Common common;
  std::shared_ptr<std::optional<data::Sampler>> sampler;
  int verify = 0;  ///< points of each case's posterior; 0: none
  int jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  int rounds = 3;    ///< rounds of verification, at most
  std::string time;  ///< no new round after it
  bool no_scan = false;
};

uq::Calibration calibrate_once(const CalibrateCommand& options, const Workspace& workspace, const StudyRows& rows) {
  const uq::SurrogateOptions surrogates = surrogate_options(options.common, workspace, rows);
  uq::Calibration result;
  {
    JobProgress progress(options.common, "calibrating");
    uq::CalibrateOptions calibrate{.surrogates = surrogates,
                                   .sampler = *options.sampler,
                                   .seed = workspace.study.seed,
                                   .findings = rows.findings,
                                   .progress = std::ref(progress)};
    if (options.no_scan) calibrate.error_scan.clear();
    result = uq::calibrate_all(workspace.study, rows.table, calibrate);
  }
  keep_surrogates(workspace, rows, surrogates, result.surrogates);
  return result;
}

data::ExitStatus report_on(const Common& common, const Workspace& workspace, const StudyRows& rows,
                           uq::Calibration& result) {
  for (const uq::SampledCase& sampled : result.cases)
    if (!sampled.draws.chains.empty())
      uq::write_posterior(posterior_path(workspace, sampled.model->name), workspace.study, sampled,
                          workspace.study.seed);
  std::vector<uq::SupportReport> supports;
  for (const uq::CaseReport& one : result.report.cases) supports.push_back(one.support);
  write_next_runs(workspace, supports);
  add_provenance(result.report, workspace, rows);
  keep_plans(common, workspace, rows, result.report);
  write_report(workspace, result.report);
  say_surrogates(common, result.surrogates);  // after everything is saved: saying may fail
  return say_report(common, workspace, result.report);
}

/// Rounds of verification so far, per case.
using Rounds = std::vector<std::vector<uq::VerificationReport>>;

/// Puts the rounds into the report; a case that its last round does not confirm has a warning.
void add_rounds(const Rounds& rounds, uq::CalibrationReport& report) {
  for (std::size_t i = 0; i < rounds.size() && i < report.cases.size(); ++i) {
    uq::CaseReport& one = report.cases[i];
    one.verification = rounds[i];
    if (rounds[i].empty() || rounds[i].back().agrees || rounds[i].back().values.empty()) continue;
    one.warnings.push_back(fmt::format("case '{}': {}", one.name, rounds[i].back().sentence));
    report.warning = true;
  }
}

/// Whether the last round of every case confirms it.
bool all_agree(const Rounds& rounds) {
  return std::all_of(rounds.begin(), rounds.end(), [](const std::vector<uq::VerificationReport>& of_case) {
    return of_case.empty() || of_case.back().agrees || of_case.back().values.empty();
  });
}

/// The runs that were not made yet. One that is not of the steady flow was made, though it says nothing.
std::vector<PlannedRun> not_made(const Workspace& workspace, const StudyRows& rows,
                                 const std::vector<ListedRun>& listed) {
  const HeldBack made = hold_back(workspace, rows.all, listed);
  std::vector<PlannedRun> missing;
  for (std::size_t i = 0; i < listed.size(); ++i)
    if (!made.listed[i]) missing.push_back(listed[i].run);
  return missing;
}

/// The runs of a round were made.
struct RoundMade {
  StudyRows rows;         ///< with them
  bool doubtful = false;  ///< a run ended with a warning, or not at all
  bool interrupted = false;
};

RoundMade make_round(const CalibrateCommand& options, const Workspace& workspace,
                     const std::vector<PlannedRun>& missing, StudyRows rows, const data::InterruptGuard& interrupt) {
  const Common& common = options.common;
  const BatchResult batch = make_runs(common, workspace, missing, std::move(rows.all), rows.kept,
                                      {.what = "verification runs", .jobs = options.jobs}, interrupt.token());
  say_faults(common, batch.warnings, batch.failures);
  if (batch.error) std::rethrow_exception(batch.error);
  RoundMade made{.rows = rows_to_learn_from(common, workspace),
                 .doubtful = !batch.warnings.empty() || !batch.failures.empty()};
  made.interrupted = interrupt.interrupted();
  if (made.interrupted)
    say(common,
        fmt::format("interrupted after {} of {} runs; the same command goes on", batch.finished, missing.size()));
  return made;
}

/// Says what a round came to, case by case, and adds it to the rounds of each.
void add_reports(const Common& common, const Workspace& workspace, const std::vector<uq::VerificationReport>& reports,
                 Rounds& rounds) {
  for (std::size_t i = 0; i < reports.size(); ++i) {
    rounds[i].push_back(reports[i]);
    if (!reports[i].sentence.empty())
      say(common, fmt::format("case {}: {}", workspace.study.cases[i].name, reports[i].sentence));
  }
}

data::ExitStatus calibrate_and_verify(const CalibrateCommand& options) {
  const data::InterruptGuard interrupt;
  const Common& common = options.common;
  const auto begin = std::chrono::steady_clock::now();
  const Workspace workspace = open_workspace(common);
  const bool own_runs = own_engine(workspace);
  data::require_cases(workspace.study);
  StudyRows rows = rows_to_learn_from(common, workspace);
  make_out(workspace, own_runs ? "runs" : "");
  const auto results = hold_out(workspace, Writes::results, "calibrate --verify");
  const auto training = own_runs ? hold_out(workspace, Writes::training, "calibrate --verify") : nullptr;
  const double limit =
      options.time.empty() ? std::numeric_limits<double>::infinity() : parse_duration(options.time, "--for");
  Rounds rounds(workspace.study.cases.size());
  bool doubtful = false;  // a run of a round ended with a warning, or not at all
  const auto worst = [&doubtful](data::ExitStatus status) {
    return doubtful && status == data::ExitStatus::done ? data::ExitStatus::warning : status;
  };
  std::vector<ListedRun> listed = read_verify_runs(workspace);
  for (int round = 1;; ++round) {
    // Surrogates that have not seen the round's runs.
    HeldBack held = hold_back(workspace, rows.table, listed);
    StudyRows unseen = rows;
    unseen.table = held.others;
    uq::Calibration result = calibrate_once(options, workspace, unseen);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    const bool last = round > options.rounds || elapsed.count() > limit;
    if (last || (round > 1 && all_agree(rounds))) {
      add_rounds(rounds, result.report);
      return worst(report_on(common, workspace, unseen, result));
    }

    // The round's runs, where they were not made yet.
    if (listed.empty()) {
      listed = verification_runs(workspace, unseen, result, options.verify);
      write_verify_runs(workspace, listed);
    }
    const std::vector<PlannedRun> missing = not_made(workspace, rows, listed);
    if (!missing.empty() && !own_runs) {
      answer(common, fmt::format("{} to run with your code: {}. Add what they give to {}, and give this command again",
                                 data::counted(missing.size(), "point"), verify_runs_path(workspace),
                                 workspace.study.training.table));
      return worst(report_on(common, workspace, unseen, result));
    }
    if (!missing.empty()) {
      say(common, fmt::format("verification, round {}: {} at points of the posterior", round,
                              data::counted(missing.size(), "run")));
      RoundMade made = make_round(options, workspace, missing, std::move(rows), interrupt);
      if (made.interrupted) return data::ExitStatus::interrupted;
      doubtful = doubtful || made.doubtful;
      rows = std::move(made.rows);
    }

    // What the runs say of the surrogates. From now on they teach them.
    held = hold_back(workspace, rows.table, listed);
    add_reports(common, workspace, verify_cases(workspace, result.surrogates, listed, held), rounds);
    listed.clear();
    std::error_code ignored;
    std::filesystem::remove(verify_runs_path(workspace), ignored);
  }
}

}  // namespace

Action add_calibrate(CLI::App& program) {
  const auto options = std::make_shared<CalibrateCommand>();
  CLI::App* command =
      add_study_command(program, "calibrate", "fit, sample, identify, report: what the torque determines and what not",
                        "demcal calibrate data/developer", options->common);
  options->sampler = add_sampler_option(*command);
  add_isa_option(*command);
  CLI::Option* verify =
      command
          ->add_option(
              "--verify", options->verify,
              "run the simulation at so many points of each case's posterior, at up to three measured settings, "
              "compare with the surrogate, learn from the runs, and repeat until they agree. For another code's "
              "runs it writes OUT/verify-runs.csv")
          ->check(CLI::Range(1, 1000));
  command->add_option("--rounds", options->rounds, "of --verify, at most (default 3)")
      ->needs(verify)
      ->check(CLI::Range(1, 100));
  command->add_option("--for", options->time, "with --verify: no new round after this time, as 2h or 90min")
      ->needs(verify);
  command->add_flag("--no-scan", options->no_scan,
                    "leave out what other measurement errors would identify, half of the time of the cases");
  command->add_option("--jobs", options->jobs, "with --verify: runs at the same time (default: one a core)")
      ->needs(verify)
      ->check(CLI::Range(1, 4096));
  return [options] {
    if (options->verify > 0) return calibrate_and_verify(*options);
    const Workspace workspace = open_workspace(options->common);
    data::require_cases(workspace.study);
    const StudyRows rows = rows_to_learn_from(options->common, workspace);
    const auto held = hold_out(workspace, Writes::results, "calibrate");
    uq::Calibration result = calibrate_once(*options, workspace, rows);
    return report_on(options->common, workspace, rows, result);
  };
}

}  // namespace cli
