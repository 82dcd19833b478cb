// demcal train: the missing training runs, one thread each, several at once. Every finished run is kept at once: its
// file in OUT/runs, its row in OUT/training.h5 and training.csv. An interrupted run goes on from its checkpoint.
#include <fmt/core.h>

#include <filesystem>
#include <thread>

#include "campaign/design.hpp"
#include "campaign/foretell.hpp"
#include "campaign/run_batch.hpp"
#include "cli/command.hpp"
#include "cli/train_posterior.hpp"
#include "cli/train_slurm.hpp"
#include "data/interrupt.hpp"
#include "data/number_text.hpp"
#include "data/progress.hpp"

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
      ->check(CLI::Range(0.001, 1.0));
  add_slurm_options(*command, options->slurm);
  return [options, command] {
    if (!options->slurm.task_list.empty()) return make_task(options->common, options->slurm);
    const int jobs_asked = command->count("--jobs") > 0 ? options->jobs : 0;
    if (options->until_posterior) {
      PosteriorTraining training{.jobs = options->jobs, .runs = options->runs, .seconds = {}, .share = options->share};
      if (options->slurm.slurm) {
        training.jobs = jobs_asked > 0 ? jobs_asked : 16;
        training.slurm = slurm_options(options->common, options->slurm, *command);
      }
      if (!options->time.empty()) training.seconds = parse_duration(options->time, "--for");
      return train_until_posterior(options->common, training);
    }
    const data::InterruptGuard interrupt;
    const Common& common = options->common;
    const Workspace workspace = open_workspace(common);
    require_rig(workspace);
    make_out(workspace, "runs");
    const auto held = hold_out(workspace, Writes::training, "train");
    StudyRows rows = study_rows(workspace);
    for (const std::string& note : rows.notes) say(common, "note: " + note);
    const std::size_t before = rows.all.rows.size();
    const Campaign campaign = options->at_posterior > 0 ? plan_at_posterior(workspace, rows.all, options->at_posterior)
                                                        : plan_campaign(workspace, rows.all, options->runs);
    write_design(workspace, campaign.points);
    if (campaign.points.empty())
      answer(common,
             fmt::format("nothing is missing: the table has {}. For more: --runs N", data::counted(before, "run")));
    else
      say(common, fmt::format("{} to make{}; the table has {}", data::counted(campaign.points.size(), "run"),
                              campaign.continues ? ", left by an unfinished campaign" : "", before));
    const std::string foretold = too_short(workspace, campaign.points);
    if (!foretold.empty()) say(common, "warning: " + foretold);

    std::vector<PlannedRun> runs;
    for (const Point& point : campaign.points) runs.push_back({point, workspace.study.seed});
    const std::size_t elsewhere = options->slurm.slurm ? 0 : runs_with_slurm(workspace, runs);
    if (elsewhere > 0)
      say(common,
          fmt::format("note: {} of them were left with Slurm, which demcal train --slurm collects; those that are "
                      "not finished are made here all the same",
                      elsewhere));
    SlurmResult ledger;
    {
      data::Progress progress("training runs", campaign.points.size(),
                              {.style = common.quiet ? data::ProgressStyle::quiet : data::ProgressStyle::automatic});
      const BatchOptions batch{
          .jobs = options->jobs, .kept = rows.kept, .stop = interrupt.token(), .progress = &progress};
      if (options->slurm.slurm) {
        SlurmOptions slurm = slurm_options(common, options->slurm, *command);
        slurm.at_once = jobs_asked;
        ledger = run_on_slurm(workspace, runs, std::move(rows.all), batch, slurm);
      } else {
        static_cast<BatchResult&>(ledger) = run_batch(workspace, runs, std::move(rows.all), batch);
      }
    }
    std::vector<Point> left;
    for (std::size_t i = 0; i < campaign.points.size(); ++i)
      if (!ledger.ended[i]) left.push_back(campaign.points[i]);
    write_design(workspace, left);
    if (ledger.error) std::rethrow_exception(ledger.error);
    const std::string table = (fs::path(workspace.out) / "training.csv").string();
    for (const std::string& warning : ledger.warnings) say(common, "warning: " + warning);
    for (const std::string& failure : ledger.failures) say(common, "warning: failed: " + failure);
    nlohmann::json json{{"finished", ledger.finished},      {"failed", ledger.failures},
                        {"warnings", ledger.warnings},      {"unsteady", ledger.unsteady},
                        {"rows", ledger.table.rows.size()}, {"table", table}};
    if (options->slurm.slurm) json["slurm"] = slurm_json(ledger);
    print_json(common, json);
    if (const auto status = tell_left(common, ledger, options->slurm.detach)) return *status;
    if (interrupt.interrupted()) {
      say(common, fmt::format("interrupted after {} of {} runs; the same command does the rest", ledger.finished,
                              campaign.points.size()));
      return data::ExitStatus::interrupted;
    }
    answer(common, fmt::format("{}, {} in all: {}", data::counted(ledger.finished, "new run"), ledger.table.rows.size(),
                               table));
    const bool short_wanted = workspace.unsteady == Unsteady::use;  // such runs were asked for
    if (short_wanted) {
      ledger.unsteady = 0;
      ledger.warnings.clear();
    }
    if (ledger.unsteady > 0)
      say(common,
          fmt::format("warning: {} of the new runs are not of the steady flow and train nothing (training.unsteady "
                      "= \"use\" takes them)",
                      ledger.unsteady));
    const bool clean = (short_wanted || foretold.empty()) && ledger.failures.empty() && ledger.warnings.empty() &&
                       ledger.unsteady == 0;
    return clean ? data::ExitStatus::done : data::ExitStatus::warning;
  };
}

}  // namespace cli
