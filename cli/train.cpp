// demcal train: the missing training runs, one thread each, several at once. Every finished run is kept at once: its
// file in OUT/runs, its row in OUT/training.h5 and training.csv. An interrupted run goes on from its checkpoint.
#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <thread>

#include "cli/campaign.hpp"
#include "cli/foretell.hpp"
#include "cli/run_point.hpp"
#include "cli/training_table.hpp"
#include "data/interrupt.hpp"
#include "data/progress.hpp"

namespace cli {
namespace fs = std::filesystem;
namespace {

struct Options {
  Common common;
  int jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  int runs = 0, at_posterior = 0;
};

/// What the workers share; the mutex guards all but the counter.
struct Ledger {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  data::RunTable table;
  std::vector<data::RunRow> kept;  ///< rows of other settings, written back
  std::size_t finished = 0, unsteady = 0;
  std::vector<bool> ended;  ///< per point of the campaign: finished or failed
  std::vector<std::string> failures, warnings;
  std::exception_ptr error;
};

/// Adds the row, or puts it where an earlier, shorter run of the point stands.
void put_row(data::RunTable& table, data::RunRow row) {
  const std::string key = data::row_key(row);
  for (data::RunRow& there : table.rows) {
    if (data::row_key(there) != key) continue;
    there = std::move(row);
    return;
  }
  table.rows.push_back(std::move(row));
}

/// One worker: takes points until there are none, or the campaign is to stop.
void work(const Workspace& workspace, const Campaign& campaign, Ledger& ledger, data::Progress& progress,
          std::stop_source& stop) {
  try {
    for (std::size_t i = ledger.next++; i < campaign.points.size() && !stop.stop_requested(); i = ledger.next++) {
      const Point& point = campaign.points[i];
      const dem::RunResult result = run_point(
          workspace, point, {.path = run_path(workspace, point), .keep_state = false, .stop = stop.get_token()});
      if (result.status == dem::RunStatus::interrupted) return;
      const std::string what = fmt::format("{} {}", point.material, describe(workspace.study, point));
      const std::lock_guard lock(ledger.mutex);
      for (const std::string& warning : result.warnings) ledger.warnings.push_back(what + ": " + warning);
      if (result.status == dem::RunStatus::failed) {
        ledger.failures.push_back(what + ": " + result.reason);
        progress.note("failed: " + ledger.failures.back());
      } else {
        put_row(ledger.table, to_row(workspace, point, result));
        if (result.summary.state != dem::Steady::yes) ++ledger.unsteady;
        write_tables(workspace, ledger.table, ledger.kept);
        ++ledger.finished;
      }
      ledger.ended[i] = true;
      progress.advance();
    }
  } catch (...) {
    const std::lock_guard lock(ledger.mutex);
    if (!ledger.error) ledger.error = std::current_exception();
    stop.request_stop();
  }
}

}  // namespace

Action add_train(CLI::App& program) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = add_study_command(program, "train", "make the training runs that are missing",
                                        "demcal train data/developer --runs 6", options->common);
  add_isa_option(*command);
  command->add_option("--jobs", options->jobs, "runs at the same time, one thread each (default: one a core)")
      ->check(CLI::Range(1, 4096));
  command
      ->add_option("--runs", options->runs,
                   "so many runs: those still missing from the design, or, when there are none, further ones")
      ->check(CLI::Range(1, 100000));
  command
      ->add_option("--at-posterior", options->at_posterior,
                   "instead: so many points of the last calibration's posteriors that lie far from the runs "
                   "(OUT/next-runs.csv)")
      ->check(CLI::Range(1, 100000))
      ->type_name("N");
  return [options] {
    const data::InterruptGuard interrupt;
    const Common& common = options->common;
    const Workspace workspace = open_workspace(common);
    require_rig(workspace);
    make_out(workspace, "runs");
    const auto held = hold_out(workspace, Writes::training, "train");
    TrainingRows rows = training_rows(workspace);
    for (const std::string& note : rows.notes) say(common, "note: " + note);
    const std::size_t before = rows.all.rows.size();
    const Campaign campaign = options->at_posterior > 0 ? plan_at_posterior(workspace, rows.all, options->at_posterior)
                                                        : plan_campaign(workspace, rows.all, options->runs);
    for (const auto& [material, unused] : workspace.cases) {
      if (std::any_of(campaign.points.begin(), campaign.points.end(),
                      [&](const Point& p) { return p.material == material; }))
        foretell(workspace, parse_point(workspace, material, {}));  // before hours go into runs of nothing
    }
    write_design(workspace, campaign.points);
    if (campaign.points.empty())
      say(common, fmt::format("nothing is missing: the table has {} runs. For more of them: --runs N", before));
    else
      say(common, fmt::format("{} runs to make{}; the table has {}", campaign.points.size(),
                              campaign.continues ? ", left by an unfinished campaign" : "", before));

    Ledger ledger;
    ledger.table = std::move(rows.all);
    ledger.ended.assign(campaign.points.size(), false);
    ledger.kept = std::move(rows.kept);
    write_tables(workspace, ledger.table, ledger.kept);
    std::stop_source stop;
    const std::stop_callback forward(interrupt.token(), [&] { stop.request_stop(); });
    {
      data::Progress progress("training runs", campaign.points.size(),
                              {.style = common.quiet ? data::ProgressStyle::quiet : data::ProgressStyle::automatic});
      std::vector<std::jthread> workers;
      const std::size_t jobs = std::min<std::size_t>(static_cast<std::size_t>(options->jobs), campaign.points.size());
      for (std::size_t j = 0; j < jobs; ++j)
        workers.emplace_back([&] { work(workspace, campaign, ledger, progress, stop); });
    }
    std::vector<Point> left;
    for (std::size_t i = 0; i < campaign.points.size(); ++i)
      if (!ledger.ended[i]) left.push_back(campaign.points[i]);
    write_design(workspace, left);
    if (ledger.error) std::rethrow_exception(ledger.error);
    const std::string table = (fs::path(workspace.out) / "training.csv").string();
    for (const std::string& warning : ledger.warnings) say(common, "warning: " + warning);
    for (const std::string& failure : ledger.failures) say(common, "failed: " + failure);
    print_json(common, {{"finished", ledger.finished},
                        {"failed", ledger.failures},
                        {"warnings", ledger.warnings},
                        {"unsteady", ledger.unsteady},
                        {"rows", ledger.table.rows.size()},
                        {"table", table}});
    if (interrupt.interrupted()) {
      say(common, fmt::format("interrupted after {} of {} runs; the same command does the rest", ledger.finished,
                              campaign.points.size()));
      return data::ExitStatus::interrupted;
    }
    say(common, fmt::format("{} new runs, {} in all: {}", ledger.finished, ledger.table.rows.size(), table));
    if (workspace.unsteady == Unsteady::use) ledger.unsteady = 0;  // they were asked for
    if (ledger.unsteady > 0)
      say(common,
          fmt::format("warning: {} of the new runs are not of the steady flow and train nothing (training.unsteady "
                      "= \"use\" takes them)",
                      ledger.unsteady));
    const bool clean = ledger.failures.empty() && ledger.warnings.empty() && ledger.unsteady == 0;
    return clean ? data::ExitStatus::done : data::ExitStatus::warning;
  };
}

}  // namespace cli
