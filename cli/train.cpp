// demcal train: the missing training runs, one thread each, several at once. Every finished run is kept at once: its
// file in OUT/runs, its row in OUT/training.h5 and training.csv. An interrupted run goes on from its checkpoint.
#include <fmt/core.h>

#include <filesystem>
#include <thread>

#include "campaign/design.hpp"
#include "campaign/foretell.hpp"
#include "campaign/out_files.hpp"
#include "cli/make_runs.hpp"
#include "cli/train_posterior.hpp"
#include "cli/train_slurm.hpp"
#include "data/interrupt.hpp"
#include "data/number_text.hpp"

namespace cli {
namespace fs = std::filesystem;
namespace {

struct TrainOptions {
  Common common;
  int jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  int runs = 0, at_posterior = 0;
  bool until_posterior = false;
  std::string time;
  double share = 0.1;
  SlurmChoice slurm;
};

/// Runs where they sharpen the posteriors. `jobs_asked`: as given, 0 for none.
data::ExitStatus train_posterior(const TrainOptions& options, int jobs_asked, std::optional<SlurmOptions> slurm) {
  constexpr int batch_of_slurm = 16;
  PosteriorTraining training{.jobs = options.jobs, .runs = options.runs, .seconds = {}, .share = options.share};
  if (slurm) {
    training.jobs = jobs_asked > 0 ? jobs_asked : batch_of_slurm;
    training.slurm = std::move(slurm);
  }
  if (!options.time.empty()) training.seconds = parse_duration(options.time, "--for");
  return train_until_posterior(options.common, training);
}

void announce(const Common& common, const Campaign& campaign, std::size_t rows) {
  const std::size_t missing = campaign.points.size();
  if (missing == 0) {
    answer(common, fmt::format("nothing is missing: the table has {}. For more: --runs N", data::counted(rows, "run")));
  } else {
    say(common,
        fmt::format("{} to make{}; the table has {}{}", data::counted(missing, "run"),
                    campaign.continues ? ", left by an unfinished campaign" : "", rows,
                    campaign.later.empty() ? "" : fmt::format("; {} more stay in design.csv", campaign.later.size())));
  }
}

/// The answer, its JSON and the exit status. `foretold`: some runs were expected to be too short.
data::ExitStatus tell_made(const Common& common, const Workspace& workspace, const BatchResult& made,
                           const SlurmOptions* slurm, bool foretold, bool interrupted) {
  const std::string table = training_copy_path(workspace);
  say_faults(common, made.warnings, made.failures);
  nlohmann::json json{{"finished", made.finished}, {"failed", made.failures},        {"warnings", made.warnings},
                      {"unsteady", made.unsteady}, {"rows", made.table.rows.size()}, {"table", table}};
  if (slurm != nullptr) json["slurm"] = slurm_json(made.left);
  print_json(common, json);
  if (const auto status = tell_left(common, made, slurm != nullptr && slurm->detach)) return *status;
  if (interrupted) {
    const std::size_t left = made.ended.size() - made.finished;
    say(common, fmt::format("interrupted after {} of {} runs; with --runs {} it does the rest", made.finished,
                            made.ended.size(), left));
    return data::ExitStatus::interrupted;
  }
  answer(common,
         fmt::format("{}, {} in all: {}", data::counted(made.finished, "new run"), made.table.rows.size(), table));
  if (!made.failures.empty()) return data::ExitStatus::warning;
  if (workspace.unsteady == Unsteady::use) {  // short runs were asked for
    if (made.unsteady > 0)
      say(common, fmt::format("note: {} of the new runs are not of the steady flow, and train as they are "
                              "(training.unsteady = \"use\")",
                              made.unsteady));
    return made.warnings.empty() ? data::ExitStatus::done : data::ExitStatus::warning;
  }
  if (made.unsteady > 0)
    say(common, fmt::format("warning: {} of the new runs are not of the steady flow and train nothing "
                            "(training.unsteady = \"use\" takes them)",
                            made.unsteady));
  return foretold || !made.warnings.empty() || made.unsteady > 0 ? data::ExitStatus::warning : data::ExitStatus::done;
}

/// The missing runs of the design, or so many points of the last posteriors.
data::ExitStatus train_missing(const TrainOptions& options, const std::optional<SlurmOptions>& slurm) {
  const data::InterruptGuard interrupt;
  const Common& common = options.common;
  const Workspace workspace = open_workspace(common);
  require_own_runs(workspace);
  make_out(workspace, "runs");
  const auto held = hold_out(workspace, Writes::training, "train");

  StudyRows rows = study_rows(workspace);
  for (const std::string& note : rows.notes) say(common, "note: " + note);
  const Campaign campaign = options.at_posterior > 0 ? plan_at_posterior(workspace, rows.all, options.at_posterior)
                                                     : plan_campaign(workspace, rows.all, options.runs);
  write_design(workspace, campaign.listed(campaign.points));
  announce(common, campaign, rows.all.rows.size());
  const std::string foretold = too_short(workspace, campaign.points);
  if (!foretold.empty()) say(common, (workspace.unsteady == Unsteady::use ? "note: " : "warning: ") + foretold);

  std::vector<PlannedRun> runs;
  for (const Point& point : campaign.points) runs.push_back({point, workspace.study.seed});
  if (const std::size_t elsewhere = slurm ? 0 : runs_with_slurm(workspace, runs); elsewhere > 0)
    say(common,
        fmt::format("note: {} of them were left with Slurm, which demcal train --slurm collects; those that are "
                    "not finished are made here all the same",
                    elsewhere));
  const BatchResult made = make_runs(common, workspace, runs, std::move(rows.all), rows.kept,
                                     {.jobs = options.jobs, .slurm = slurm}, interrupt.token());
  std::vector<Point> left;
  for (std::size_t i = 0; i < campaign.points.size(); ++i)
    if (!made.ended[i]) left.push_back(campaign.points[i]);
  write_design(workspace, campaign.listed(std::move(left)));
  if (made.error) std::rethrow_exception(made.error);
  return tell_made(common, workspace, made, slurm ? &*slurm : nullptr, !foretold.empty(), interrupt.interrupted());
}

}  // namespace

Action add_train(CLI::App& program) {
  const auto options = std::make_shared<TrainOptions>();
  CLI::App* command = add_study_command(program, "train", "make the training runs that are missing",
                                        "demcal train data/developer --runs 6", options->common);
  add_isa_option(*command);
  command
      ->add_option("--jobs", options->jobs,
                   "runs at the same time, one thread each (default: one a core); with --slurm, tasks at the same time "
                   "(default: as many as Slurm starts)")
      ->check(CLI::Range(1, 4096));
  command
      ->add_option("--runs", options->runs,
                   "so many runs: those still missing from the design, or, when there are none, further ones")
      ->check(CLI::Range(1, 100000));
  CLI::Option* at_posterior =
      command
          ->add_option("--at-posterior", options->at_posterior,
                       "instead: so many points of the last calibration's posteriors that lie far from the runs "
                       "(OUT/next-runs.csv)")
          ->check(CLI::Range(1, 100000))
          ->type_name("N");
  CLI::Option* until = command
                           ->add_option_function<std::string>(
                               "--until", [options](const std::string&) { options->until_posterior = true; },
                               "posterior: runs in batches where they sharpen the posteriors of the study's cases, "
                               "until little of their "
                               "width is the surrogate's; --runs and --for limit them. For another code's runs it "
                               "writes OUT/next-runs.csv")
                           ->check(one_of({"posterior"}));
  at_posterior->excludes(until)->excludes("--runs");
  command->add_option("--for", options->time, "with --until: no new batch after this time, as 2h or 90min")
      ->needs(until);
  command
      ->add_option("--share", options->share,
                   "with --until: the part of the posterior variance that may stay the surrogate's (default 0.1)")
      ->needs(until)
      ->check(number_in(0.001, 1.0, "a part from 0.001 to 1"));
  add_slurm_options(*command, options->slurm);
  return [options, command] {
    if (!options->slurm.task_list.empty()) return make_task(options->common, options->slurm);
    const int jobs_asked = command->count("--jobs") > 0 ? options->jobs : 0;
    std::optional<SlurmOptions> slurm;
    if (options->slurm.slurm) slurm = slurm_options(options->common, options->slurm, *command);
    if (options->until_posterior) return train_posterior(*options, jobs_asked, std::move(slurm));
    if (slurm) slurm->at_once = jobs_asked;
    return train_missing(*options, slurm);
  };
}

}  // namespace cli
