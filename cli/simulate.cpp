// demcal simulate: one DEM run at one point.
#include <fmt/core.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "campaign/foretell.hpp"
#include "campaign/run_point.hpp"
#include "cli/command.hpp"
#include "cli/point_options.hpp"
#include "data/atomic_file.hpp"
#include "data/file_name.hpp"
#include "data/hash.hpp"
#include "data/interrupt.hpp"
#include "data/progress.hpp"
#include "data/terminal.hpp"
#include "dem/reading/target.hpp"
#include "dem/rig/rig.hpp"
#include "dem/run/frame_file.hpp"
#include "dem/run/mixing.hpp"
#include "dem/run/run_file.hpp"
#include "dem/walls/stl.hpp"
#include "uq/findings/wording.hpp"

namespace cli {
namespace {

struct SimulateOptions {
  Common common;
  PointOptions point;
  int threads = 1;
  int frames = 0;
  bool stl = false;
};

/// Time in which the powder of two channels goes round once, whichever way: its mass over the mean of both flows. None
/// where this mean is not told from 0.
struct Lap {
  double time = 0.0, error = 0.0;  ///< s
};
std::optional<Lap> lap_of(const dem::Derived& derived, const dem::RunResult& result) {
  const data::SeriesMean& first = dem::output(result, "first_flow");
  const data::SeriesMean& second = dem::output(result, "second_flow");
  const double flow = std::abs(0.5 * (first.mean + second.mean));
  const double error = 0.5 * std::hypot(first.standard_error, second.standard_error);
  if (!(flow > 2.0 * error)) return {};
  const double time = static_cast<double>(derived.spheres) * derived.mass / flow;
  return Lap{time, time * error / flow};
}

nlohmann::json to_json(const Workspace& workspace, const Point& point, const dem::Derived& derived,
                       const dem::RunResult& result) {
  nlohmann::json json{{"material", point.material},
                      {"seed", workspace.study.seed},
                      {"isa", result.diagnostics.isa},
                      {"settings", settings_hash(workspace, point.material)},
                      {"bond_number", derived.bond},
                      {"time_step", {{"s", derived.time_step}, {"from", derived.duration_of}}},
                      {"warnings", result.warnings},
                      {"state", data::to_text(result.summary.state)},
                      {"why", result.summary.why},
                      {"ordering", result.summary.ordering},
                      {"measured", {{"from_s", result.summary.measured_from}, {"turns", result.summary.turns}}}};
  for (const dem::ContactKind& kind : derived.kinds)
    json["contacts"].push_back({{"between", {kind.first, kind.second}},
                                {"pull_off_N", kind.pull_off},
                                {"bond_number", kind.bond},
                                {"damping_ratio", kind.law.damping_ratio},
                                {"duration_s", kind.duration}});
  std::size_t column = 0;
  const auto input = [&](const auto& named) { json["point"][named.name] = named.unit.from_si(point.inputs[column++]); };
  for (const data::Parameter& p : workspace.study.parameters) input(p);
  for (const data::Control& c : workspace.study.controls) input(c);
  const data::RunRow row = to_row(workspace, point, result);
  for (std::size_t i = 0; i < row.outputs.size(); ++i) {
    const data::Output& output = workspace.study.outputs[i];
    json["outputs"][output.name] = {{"unit", output.unit.symbol},
                                    {"mean", std::stod(output.unit.digits(row.outputs[i]))},  // as a table has it
                                    {"standard_error", row.standard_errors[i] / output.unit.factor},
                                    {"reliable", dem::output(result, output.name).reliable}};
  }
  if (const auto round = dem::circulation(result.series, result.summary.measured_from)) {
    const auto channel = [&](std::size_t k) {
      const auto* const first = round->fill.data() + k * dem::places_along;
      return std::vector<double>(first, first + dem::places_along);
    };
    const std::optional<Lap> lap = lap_of(derived, result);
    const auto number = [&](double Lap::*part) { return lap ? nlohmann::json((*lap).*part) : nlohmann::json(nullptr); };
    json["circulation"] = {{"lap_s", number(&Lap::time)},
                           {"lap_standard_error_s", number(&Lap::error)},
                           {"mixing_index", round->mixing_index},
                           {"fill_along_first", channel(0)},
                           {"fill_along_second", channel(1)}};
  }
  return json;
}

/// How the powder of two channels goes round, two lines.
std::string circulation_text(const dem::Derived& derived, const dem::RunResult& result) {
  const auto round = dem::circulation(result.series, result.summary.measured_from);
  if (!round) return {};
  std::string fill;
  for (std::size_t k = 0; k < round->fill.size(); ++k)
    fill += fmt::format("{}{:.2f}", k == 0 ? "" : k == dem::places_along ? " | " : " ", round->fill[k]);
  const std::optional<Lap> lap = lap_of(derived, result);
  return fmt::format(
      "  a lap {}; mixing index of the two channels {:.2f} at the end\n"
      "  powder along the first channel | the second, of the mean: {}\n",
      lap ? "takes " + uq::format_with_error(lap->time, lap->error, "s", uq::Typography::ascii)
          : "is not known: no flow round the two channels is told from none",
      round->mixing_index, fill);
}

std::string summary(const Workspace& workspace, const Point& point, const dem::PreparedCase& prepared,
                    const dem::RunResult& result) {
  std::string text;
  for (const std::string& line : dem::describe(prepared.given(), prepared.derived())) text += line + "\n";
  const dem::Summary& s = result.summary;
  text += fmt::format("{}: measured from {:.3g} to {:.3g} s of turning, {:.3g} turns\n", data::to_text(s.state),
                      s.measured_from, result.diagnostics.simulated, s.turns);
  const data::RunRow row = to_row(workspace, point, result);
  for (std::size_t i = 0; i < row.outputs.size(); ++i) {
    const data::Output& output = workspace.study.outputs[i];
    text += fmt::format(
        "  {:<20} {}{}\n", output.name,
        uq::format_with_error(output.unit.from_si(row.outputs[i]), row.standard_errors[i] / output.unit.factor,
                              output.unit.symbol, uq::Typography::ascii),
        std::isnan(row.outputs[i])                  ? " (not measured: too short, or not seen)"
        : dem::output(result, output.name).reliable ? ""
                                                    : " (too short to know this error)");
  }
  return text + circulation_text(prepared.derived(), result);
}

/// Where a run is kept, and what it goes on from.
struct RunFiles {
  std::string path;       ///< run.h5, or, where that holds another run or is no run of ours, run-HASH.h5
  std::string from = {};  ///< a file of the same run with another length: the course that it holds is not made again
  bool damaged = false;   ///< run.h5 cannot be read
};

/// What is there is never replaced, and nothing that is there is computed again.
RunFiles files_of(const Workspace& workspace, const Point& point) {
  namespace fs = std::filesystem;
  const fs::path usual = fs::path(workspace.out) / "run.h5";
  if (!fs::exists(usual)) return {usual.string()};
  const std::string settings = dem::settings_text(case_at(workspace, point));
  const std::uint64_t seed = run_seed(workspace, point);
  bool damaged = false;
  try {
    const dem::SavedRun saved = dem::read_run(usual.string());
    if (saved.settings == settings && saved.result.seed == seed) return {usual.string()};
  } catch (const data::InputError&) {  // not to be read: it stays as it is
    damaged = true;
  }
  const std::string name = data::hash_text(fmt::format("{} {}", settings, seed)).substr(0, 12);
  return {(fs::path(workspace.out) / ("run-" + name + ".h5")).string(), longest_run(workspace, point, workspace.out),
          damaged};
}

/// frames, or, where that holds frames of another run or another number of them, frames-HASH: ParaView takes all files
/// of a folder for one series.
std::string frames_folder_of(const Workspace& workspace, const Point& point, int count) {
  namespace fs = std::filesystem;
  const fs::path usual = fs::path(workspace.out) / "frames";
  const dem::FrameTag tag{.index = 0,
                          .count = count,
                          .seed = run_seed(workspace, point),
                          .settings = dem::settings_text(case_at(workspace, point))};
  const std::string first = dem::frame_path(usual.string(), 0);
  if (!fs::exists(first) || dem::is_frame(first, tag)) return usual.string();
  const std::string name = data::hash_text(fmt::format("{} {} {}", tag.settings, tag.seed, count)).substr(0, 12);
  return usual.string() + "-" + name;
}

/// The run, its progress shown.
dem::RunResult run_with_progress(const SimulateOptions& options, const Workspace& workspace, const Point& point,
                                 const RunFiles& files, const std::string& frames_folder, std::stop_token stop) {
  data::Progress progress(
      "simulating (at most)", 1000,
      {.style = options.common.quiet ? data::ProgressStyle::quiet : data::ProgressStyle::automatic, .counted = false});
  return run_point(workspace, point,
                   {.path = files.path,
                    .from = files.from,
                    .threads = options.threads,
                    .frames = options.frames,
                    .frames_folder = frames_folder,
                    .stop = std::move(stop),
                    .progress = [&](const dem::RunProgress& now) {
                      progress.set(static_cast<std::uint64_t>(std::lround(1000.0 * now.fraction)));
                    }});
}

data::ExitStatus simulate(const SimulateOptions& options) {
  const data::InterruptGuard interrupt;
  const Common& common = options.common;
  const Workspace workspace = open_workspace(common);
  require_rig(workspace);
  const Point point = point_of(workspace, options.point);
  std::vector<std::string> notes = outside_ranges(workspace, point);
  const Foretold told = foretell(workspace, point);
  require_memory(workspace, told, 1);
  for (const std::string& warning : told.forecast.warnings) notes.push_back(warning);
  for (const std::string& warning : dem::rig_warnings(told.prepared.given())) notes.push_back(warning);
  const auto held = hold_out(workspace, Writes::run, "simulate");
  const std::filesystem::path out = workspace.out;
  const RunFiles files = files_of(workspace, point);
  const std::string& path = files.path;
  const auto name_of = [](const std::string& file) { return std::filesystem::path(file).filename().string(); };
  if (!files.from.empty() && files.from != path)
    notes.push_back(fmt::format("{} holds this run with another length and is kept; this one goes on from it, in {}",
                                name_of(files.from), name_of(path)));
  else if (path != out / "run.h5")
    notes.push_back(fmt::format("run.h5 {} and is kept; this one is in {}",
                                files.damaged ? "cannot be read (damaged, or no run of demcal)" : "holds another run",
                                name_of(path)));
  std::string frames_folder;
  if (options.frames > 0) {
    frames_folder = frames_folder_of(workspace, point, options.frames);
    const std::string name = std::filesystem::path(frames_folder).filename().string();
    make_out(workspace, name);
    for (int k = 0; k < options.frames; ++k) data::require_replaceable(dem::frame_path(frames_folder, k));
    if (name != "frames")
      notes.push_back(fmt::format("frames/ holds other frames and is kept; these are in {}/", name));
  }
  if (options.stl) {
    for (const dem::NamedMesh& mesh : dem::rig_meshes(told.prepared.given()))
      dem::write_stl(mesh.mesh, (out / (data::file_name(mesh.name) + ".stl")).string());
  }
  const std::string inputs = describe(workspace.study, point);
  const std::string at =
      fmt::format("{}{}{}", point.material, point.material.empty() || inputs.empty() ? "" : ": ", inputs);
  if (!at.empty()) say(common, at);
  for (const std::string& note : notes) say(common, "note: " + note);
  const dem::RunResult result = run_with_progress(options, workspace, point, files, frames_folder, interrupt.token());
  if (result.status == dem::RunStatus::interrupted) {
    say(common, "interrupted; the same command goes on from here (" + path + ")");
    return data::ExitStatus::interrupted;
  }
  if (result.status == dem::RunStatus::failed)
    throw data::InputError(data::ExitStatus::bad_study,
                           {describe(workspace.study, point), result.reason,
                            result.checkpoint.state.position.empty() ? "" : "its last good state is in " + path});
  for (const std::string& warning : result.warnings) say(common, "warning: " + warning);
  answer(common,
         (data::answers_go_elsewhere() ? at + "\n" : "") + summary(workspace, point, told.prepared, result) + path);
  nlohmann::json json = to_json(workspace, point, told.prepared.derived(), result);
  json["notes"] = notes;
  json["file"] = path;
  print_json(common, json);
  return result.warnings.empty() ? data::ExitStatus::done : data::ExitStatus::warning;
}

}  // namespace

Action add_simulate(CLI::App& program) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = add_study_command(
      program, "simulate", "run the DEM at one point and say its torque",
      "demcal simulate data/developer --material carrier --at friction=0.4,hamaker=9e-18,rpm=150", options->common);
  add_point_options(*command, options->point);
  command->add_option("--threads", options->threads, "threads of this run; the result does not depend on it")
      ->check(CLI::Range(1, 256));
  add_isa_option(*command);
  command
      ->add_option("--frames", options->frames,
                   "write N moments of the run, spheres and surfaces, as frames/0000.vtkhdf ... for ParaView")
      ->check(CLI::Range(1, 10000))
      ->type_name("N");
  command->add_flag("--stl", options->stl, "write the rig's surfaces too (mixer.stl, trough.stl)");
  return [options] { return simulate(*options); };
}

}  // namespace cli
