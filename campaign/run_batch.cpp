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
#include "data/atomic_file.hpp"

namespace campaign {
namespace {

/// The state that the workers share; the mutex guards all but the counter.
struct Shared {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  Ledger ledger;

  /// Keeps the exception that is being handled, the first of all, and stops every worker.
  void fail(std::stop_source& stop) {
    const std::lock_guard lock(mutex);
    if (!ledger.result.error) ledger.result.error = std::current_exception();
    stop.request_stop();
  }
};

/// One worker: takes runs until there are none, or the batch is to stop.
void work(const Workspace& workspace, const std::vector<PlannedRun>& runs, const BatchOptions& options, Shared& shared,
          std::stop_source& stop) {
  BatchResult& all = shared.ledger.result;
  try {
    for (std::size_t i = shared.next++; i < runs.size() && !stop.stop_requested(); i = shared.next++) {
      const Point& point = runs[i].point;
      const Workspace own = with_seed(workspace, runs[i].seed);
      const dem::RunResult result =
          run_point(own, point, {.path = run_path(own, point), .keep_state = false, .stop = stop.get_token()});
      if (result.status == dem::RunStatus::interrupted) return;
      const std::lock_guard lock(shared.mutex);
      shared.ledger.take(i, own, point, result, options.progress);
      if (result.status != dem::RunStatus::failed) write_tables(workspace, all.table, options.kept);
    }
  } catch (...) {
    shared.fail(stop);
  }
}

}  // namespace

BatchResult run_batch(const Workspace& workspace, const std::vector<PlannedRun>& runs, data::RunTable table,
                      const BatchOptions& options) {
  require_places(workspace, runs);
  foretell_materials(workspace, runs, static_cast<int>(std::min<std::size_t>(runs.size(), options.jobs)));
  Shared shared{.ledger = Ledger(std::move(table), runs.size())};
  write_tables(workspace, shared.ledger.result.table, options.kept);
  std::stop_source stop;
  const std::stop_callback forward(options.stop, [&] { stop.request_stop(); });
  {
    std::vector<std::jthread> workers;
    const std::size_t jobs = std::min<std::size_t>(static_cast<std::size_t>(options.jobs), runs.size());
    try {
      for (std::size_t j = 0; j < jobs; ++j)
        workers.emplace_back([&] { work(workspace, runs, options, shared, stop); });
    } catch (...) {  // no thread left for a worker: those that are there end, too
      shared.fail(stop);
    }
  }
  return std::move(shared.ledger.result);
}

void require_places(const Workspace& workspace, const std::vector<PlannedRun>& runs) {
  for (const PlannedRun& run : runs) data::require_replaceable(run_path(with_seed(workspace, run.seed), run.point));
}

void foretell_materials(const Workspace& workspace, const std::vector<PlannedRun>& runs, int here) {
  std::set<std::string> materials;
  for (const PlannedRun& run : runs) materials.insert(run.point.material);
  for (const std::string& material : materials) {
    const Foretold told = foretell(workspace, parse_point(workspace, material, {}));
    if (here > 0) require_memory(workspace, told, here);
  }
}

Workspace with_seed(const Workspace& workspace, std::uint64_t seed) {
  Workspace other = workspace;
  other.study.seed = seed;
  return other;
}

}  // namespace campaign
