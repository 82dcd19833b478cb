#include "cli/run_point.hpp"

#include <filesystem>

#include "data/atomic_file.hpp"
#include "dem/isa.hpp"
#include "dem/run_file.hpp"
#include "dem/target.hpp"

namespace cli {
namespace {

/// What an earlier start left in the file, if it is this very run.
std::optional<dem::RunResult> earlier(const std::string& path, const dem::Case& c, std::uint64_t seed) {
  if (!std::filesystem::exists(path)) return {};
  try {
    dem::SavedRun saved = dem::read_run(path);
    if (saved.settings == dem::settings_text(c) && saved.result.seed == seed) return std::move(saved.result);
  } catch (const data::InputError&) {  // damaged, or of another version: made again
  }
  return {};
}

}  // namespace

dem::RunResult run_point(const Workspace& workspace, const Point& point, const PointRun& options) {
  const dem::Case c = case_at(workspace, point);
  const std::uint64_t seed = run_seed(workspace, point);
  data::require_replaceable(options.path);
  const std::optional<dem::RunResult> before = earlier(options.path, c, seed);
  // A run that failed fails again: it depends on its point, seed and settings alone.
  if (before && before->status != dem::RunStatus::interrupted) return *before;

  dem::RunOptions run{.threads = options.threads, .stop = options.stop, .progress = options.progress};
  run.checkpoint = [&](const dem::Checkpoint& checkpoint) {
    dem::RunResult so_far{
        .status = dem::RunStatus::interrupted, .seed = seed, .series = checkpoint.series, .checkpoint = checkpoint};
    so_far.diagnostics.isa = dem::isa();
    dem::write_run(options.path, c, so_far);
  };
  if (before) run.resume = &before->checkpoint;
  dem::RunResult result = dem::run(c, seed, run);
  if (result.status == dem::RunStatus::done && !options.keep_state) result.checkpoint = {};
  dem::write_run(options.path, c, result);
  return result;
}

}  // namespace cli
