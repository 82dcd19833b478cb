#include "campaign/run_point.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "campaign/foretell.hpp"
#include "data/atomic_file.hpp"
#include "data/origin.hpp"
#include "dem/contact/isa.hpp"
#include "dem/reading/prepare.hpp"
#include "dem/reading/target.hpp"
#include "dem/run/frame_file.hpp"
#include "dem/run/run_file.hpp"

namespace campaign {
namespace {

/// All that decides a run's bits up to where it stops: the settings without those that say how long it is, and what of
/// it is measured.
std::string course_of(const std::string& settings) {
  static constexpr std::string_view other[]{"run.standard_error ", "run.start_up", "run.shortest",
                                            "run.longest ",        "run.window ",  "run.known "};
  std::string course;
  for (std::size_t at = 0; at < settings.size();) {
    const std::size_t end = std::min(settings.find('\n', at), settings.size() - 1) + 1;
    const std::string_view line = std::string_view(settings).substr(at, end - at);
    if (std::none_of(std::begin(other), std::end(other), [&](std::string_view key) { return line.starts_with(key); }))
      course += line;
    at = end;
  }
  return course;
}

/// The run that an earlier start left in the file, if it is a run of the same course.
std::optional<dem::SavedRun> earlier(const std::string& path, const dem::Case& c, std::uint64_t seed) {
  if (!std::filesystem::exists(path)) return {};
  try {
    dem::SavedRun saved = dem::read_run(path);
    if (course_of(saved.settings) == course_of(dem::settings_text(c)) && saved.result.seed == seed) return saved;
  } catch (const data::InputError&) {  // damaged, or of another version: made again
  }
  return {};
}

/// Whether the file knows all outputs that the study has: one that came after it was written is in none of its series.
/// A run that was interrupted or failed has no outputs yet, or none at all.
bool has_all(const dem::SavedRun& saved, const data::Study& study) {
  return std::all_of(study.outputs.begin(), study.outputs.end(), [&](const data::Output& output) {
    return saved.result.status != dem::RunStatus::done ||
           std::find(saved.outputs.begin(), saved.outputs.end(), output.name) != saved.outputs.end();
  });
}

/// Whether the run has ended as this case's would.
bool ended(const dem::SavedRun& saved, const dem::Case& c) {
  // A run that failed fails again: it depends on its point, seed and settings alone.
  return saved.result.status != dem::RunStatus::interrupted && saved.settings == dem::settings_text(c) &&
         saved.rule == dem::look_rule_version;
}

}  // namespace

std::optional<dem::RunResult> ended_run(const Workspace& workspace, const Point& point, const std::string& path) {
  const dem::Case c = case_at(workspace, point);
  std::optional<dem::SavedRun> before = earlier(path, c, run_seed(workspace, point));
  if (!before || !ended(*before, c) || !has_all(*before, workspace.study)) return {};
  return std::move(before->result);
}

std::optional<dem::RunResult> finished_run(const Workspace& workspace, const Point& point, const std::string& path) {
  std::optional<dem::SavedRun> before = earlier(path, case_at(workspace, point), run_seed(workspace, point));
  if (!before || before->result.status != dem::RunStatus::done || !has_all(*before, workspace.study)) return {};
  return std::move(before->result);
}

bool is_done(const Workspace& workspace, const Point& point, const std::string& path) {
  return ended_run(workspace, point, path).has_value();
}

std::string longest_run(const Workspace& workspace, const Point& point, const std::string& folder) {
  namespace fs = std::filesystem;
  const dem::Case c = case_at(workspace, point);
  const std::uint64_t seed = run_seed(workspace, point);
  std::string longest;
  std::size_t most = 0;
  std::error_code failure;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure)) {
    const fs::path& path = entry->path();
    if (!path.filename().string().starts_with("run") || path.extension() != ".h5") continue;
    const std::optional<dem::SavedRun> saved = earlier(path.string(), c, seed);
    if (!saved || saved->result.status == dem::RunStatus::failed || saved->result.series.time.size() <= most) continue;
    most = saved->result.series.time.size();
    longest = path.string();
  }
  return longest;
}

std::uint64_t steps_made(const Workspace& workspace, const Point& point, const std::string& path) {
  const std::optional<dem::SavedRun> before = earlier(path, case_at(workspace, point), run_seed(workspace, point));
  return before ? before->result.checkpoint.state.step : 0;
}

namespace {

/// The case of the point. Throws InputError (78) where its rig cannot be simulated. Where no input changes the rig, its
/// forecast at the middle of the ranges has been for all points.
dem::PreparedCase possible(const Workspace& workspace, const Point& point) {
  if (changes_rig(workspace.study)) return foretell(workspace, point).prepared;
  return dem::prepare(case_at(workspace, point));
}

dem::RunResult make_run(const Workspace& workspace, const Point& point, const PointRun& options) {
  const dem::PreparedCase prepared = possible(workspace, point);
  const dem::Case& c = prepared.given();
  const std::uint64_t seed = run_seed(workspace, point);
  data::require_replaceable(options.path);
  const bool damaged = data::origin_of(options.path) == data::Origin::changed;
  std::optional<dem::SavedRun> before = earlier(options.path, c, seed);
  if (!before && !options.from.empty()) before = earlier(options.from, c, seed);
  if (before && !has_all(*before, workspace.study)) before.reset();
  const std::vector<std::uint64_t> frames =
      options.frames > 0 ? dem::frame_steps(prepared, options.frames) : std::vector<std::uint64_t>{};
  const auto tag = [&](int index) {
    return dem::FrameTag{.index = index, .count = options.frames, .seed = seed, .settings = dem::settings_text(c)};
  };
  // Frames that a finished or interrupted run has passed can only be had by making it again.
  const bool no_state = before && before->result.checkpoint.state.position.empty();
  const std::uint64_t passed = !before                         ? 0
                               : no_state || ended(*before, c) ? ~std::uint64_t{0}
                                                               : before->result.checkpoint.state.step;
  for (int k = 0; k < options.frames && before; ++k)
    if (frames[k] <= passed && !dem::is_frame(dem::frame_path(options.frames_folder, k), tag(k))) before.reset();
  if (before && ended(*before, c)) return before->result;

  dem::RunOptions run{.threads = options.threads, .stop = options.stop, .progress = options.progress};
  run.checkpoint = [&](const dem::Checkpoint& checkpoint) {
    dem::RunResult so_far{
        .status = dem::RunStatus::interrupted, .seed = seed, .series = checkpoint.series, .checkpoint = checkpoint};
    so_far.diagnostics.isa = dem::isa();
    dem::write_run(options.path, c, so_far);
  };
  run.frames = options.frames;
  std::vector<std::string> lacking;  // frames that could not be written: no reason to lose the run
  run.frame = [&](int index, const dem::Simulation& simulation, double time) {
    try {
      dem::write_frame(dem::frame_path(options.frames_folder, index), simulation, time, tag(index));
    } catch (const data::InputError& error) {
      lacking.push_back(data::describe(error.problems));
    }
  };
  const bool goes_on = before && before->result.status != dem::RunStatus::failed;
  const bool judged_anew = goes_on && no_state && dem::long_enough(prepared, before->result.series);
  if (goes_on && (judged_anew || !no_state)) run.resume = &before->result.checkpoint;
  dem::RunResult result = dem::run(prepared, seed, run);
  if (judged_anew) {
    result.diagnostics = before->result.diagnostics;
    result.summary.cpu_seconds = before->result.summary.cpu_seconds;
  }
  const bool steady = result.status == dem::RunStatus::done && result.summary.state == data::FlowState::steady;
  if (judged_anew || (steady && !options.keep_state)) result.checkpoint = {};
  dem::write_run(options.path, c, result);
  if (damaged)
    result.warnings.push_back(fmt::format("{} was damaged, and the run is made again", data::shown_path(options.path)));
  for (const std::string& what : lacking) result.warnings.push_back("a frame is lacking: " + what);
  return result;
}

}  // namespace

dem::RunResult run_point(const Workspace& workspace, const Point& point, const PointRun& options) {
  try {
    return make_run(workspace, point, options);
  } catch (const data::InputError& error) {
    if (error.status != data::ExitStatus::bad_study) throw;
    dem::RunResult failed{
        .status = dem::RunStatus::failed, .reason = data::describe(error.problems), .seed = run_seed(workspace, point)};
    failed.diagnostics.isa = dem::isa();
    dem::write_run(options.path, case_at(workspace, point), failed);
    return failed;
  }
}

}  // namespace campaign
