#include "campaign/run_batch.hpp"

#include <fmt/core.h>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>

#include "campaign/design.hpp"
#include "campaign/foretell.hpp"
#include "campaign/run_point.hpp"
#include "campaign/training_table.hpp"

namespace campaign {
namespace {

/// What the workers share; the mutex guards all but the counter.
struct Ledger {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  BatchResult result;
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

/// One worker: takes runs until there are none, or the batch is to stop.
void work(const Workspace& workspace, const std::vector<PlannedRun>& runs, const BatchOptions& options, Ledger& ledger,
          std::stop_source& stop) {
  try {
    for (std::size_t i = ledger.next++; i < runs.size() && !stop.stop_requested(); i = ledger.next++) {
      const Point& point = runs[i].point;
      const Workspace own = with_seed(workspace, runs[i].seed);
      const dem::RunResult result =
          run_point(own, point, {.path = run_path(own, point), .keep_state = false, .stop = stop.get_token()});
      if (result.status == dem::RunStatus::interrupted) return;
      const std::string what = fmt::format("{} {}", point.material, describe(own.study, point));
      const std::lock_guard lock(ledger.mutex);
      BatchResult& all = ledger.result;
      for (const std::string& warning : result.warnings) all.warnings.push_back(what + ": " + warning);
      if (result.status == dem::RunStatus::failed) {
        all.failures.push_back(what + ": " + result.reason);
        if (options.progress) options.progress->note("failed: " + all.failures.back());
      } else {
        put_row(all.table, to_row(own, point, result));
        if (result.summary.state != dem::Steady::yes) ++all.unsteady;
        write_tables(workspace, all.table, options.kept);
        ++all.finished;
      }
      all.ended[i] = true;
      if (options.progress) options.progress->advance();
    }
  } catch (...) {
    const std::lock_guard lock(ledger.mutex);
    if (!ledger.result.error) ledger.result.error = std::current_exception();
    stop.request_stop();
  }
}

}  // namespace

BatchResult run_batch(const Workspace& workspace, const std::vector<PlannedRun>& runs, data::RunTable table,
                      const BatchOptions& options) {
  std::set<std::string> materials;
  for (const PlannedRun& run : runs) materials.insert(run.point.material);
  for (const std::string& material : materials) foretell(workspace, parse_point(workspace, material, {}));
  Ledger ledger;
  ledger.result.table = std::move(table);
  ledger.result.ended.assign(runs.size(), false);
  write_tables(workspace, ledger.result.table, options.kept);
  std::stop_source stop;
  const std::stop_callback forward(options.stop, [&] { stop.request_stop(); });
  {
    std::vector<std::jthread> workers;
    const std::size_t jobs = std::min<std::size_t>(static_cast<std::size_t>(options.jobs), runs.size());
    for (std::size_t j = 0; j < jobs; ++j) workers.emplace_back([&] { work(workspace, runs, options, ledger, stop); });
  }
  return std::move(ledger.result);
}

Workspace with_seed(const Workspace& workspace, std::uint64_t seed) {
  Workspace other = workspace;
  other.study.seed = seed;
  return other;
}

}  // namespace campaign
