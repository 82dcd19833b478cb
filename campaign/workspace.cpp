#include "campaign/workspace.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "campaign/out_files.hpp"
#include "data/atomic_file.hpp"
#include "data/csv.hpp"
#include "data/origin.hpp"
#include "dem/reading/read_case.hpp"
#include "dem/reading/target.hpp"
#include "dem/run/run.hpp"
#include "uq/emulate/surrogate_settings.hpp"
#include "uq/findings/report_file.hpp"
#include "uq/findings/study_units.hpp"

namespace campaign {
namespace fs = std::filesystem;
namespace {

/// Each parameter and control must name something the DEM has, in a range and unit that it can take.
void check_target(const data::Section& section, const data::Input& input) {
  const data::Unit& unit = input.unit;
  const std::optional<dem::Target> target = dem::find_target(input.target);
  if (!target) {
    std::string known;
    for (const dem::Target& t : dem::targets()) known += (known.empty() ? "" : ", ") + t.name;
    section.problem("target", fmt::format("the simulation has no quantity '{}'", input.target),
                    "choose one of: " + known + ", contact.A-B.KEY, material.NAME.KEY");
    return;
  }
  if (!data::convertible(unit.symbol, target->unit)) {
    section.problem("unit", fmt::format("'{}' does not measure {} ({})", unit.symbol, target->name, target->unit),
                    target->name == "rig.fill" && data::convertible(unit.symbol, "kg")
                        ? "it is a number of spheres; the fill as a mass is target = \"rig.fill_mass\""
                        : "use a unit of that dimension");
    return;
  }
  const auto outside = [&](const char* key, double value) {
    if (value >= target->low && value <= target->high) return;
    section.problem(key,
                    fmt::format("{} is outside the possible range [{:g}, {:g}] of {}", with_unit(value, unit),
                                unit.from_si(target->low), unit.from_si(target->high), target->name),
                    "choose a bound inside it");
  };
  outside("low", input.axis.low);
  outside("high", input.axis.high);
}

/// The quantity that a target sets. The names of the bed's amount stand for one quantity, and so do contact.A-B.KEY and
/// contact.B-A.KEY.
std::string quantity_set_by(const data::Input& input) {
  std::string name = dem::target(input.target).name;
  if (name == "rig.fill_mass" || name == "rig.level") return "rig.fill";
  const std::size_t first = name.find('.'), last = name.rfind('.');
  if (first == last || !name.starts_with("contact.")) return name;
  const std::string pair = name.substr(first + 1, last - first - 1);
  std::string least = pair;  // of its turns about each hyphen: names may have hyphens of their own
  for (std::size_t at = pair.find('-'); at != std::string::npos; at = pair.find('-', at + 1))
    least = std::min(least, pair.substr(at + 1) + "-" + pair.substr(0, at));
  return name.substr(0, first + 1) + least + name.substr(last);
}

/// Each parameter and control must set a quantity of its own, and one that a run depends on.
void check_effects(const Workspace& workspace, const std::vector<data::Input>& inputs,
                   const std::vector<data::Section>& sections) {
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    if (!dem::find_target(inputs[k].target)) continue;  // said already
    for (std::size_t other = 0; other < k; ++other) {
      if (!dem::find_target(inputs[other].target) || quantity_set_by(inputs[other]) != quantity_set_by(inputs[k]))
        continue;
      sections[k].problem("target",
                          fmt::format("is {}, which {} sets too, as {}", inputs[k].target, sections[other].place(),
                                      inputs[other].target),
                          "keep one of them, or give one another target");
    }
    std::string why;
    for (const auto& [material, of] : workspace.cases)
      if (why = dem::without_effect(of, inputs[k].target); why.empty()) break;
    if (!why.empty())
      sections[k].problem("target", fmt::format("{} {}", dem::target(inputs[k].target).name, why),
                          "choose another target, or leave it out");
  }
}

/// Each output must be one that the simulation has, in a unit of its dimension, and every rig must have it.
void check_output(const data::StudyFile& file, const Workspace& workspace, const data::Output& output) {
  const data::Section outputs = file.root().child("outputs");
  if (!dem::has_output(output.name)) {
    outputs.problem(output.name, fmt::format("the simulation has no output '{}'", output.name),
                    "choose one of: " + dem::output_names());
    return;
  }
  const std::string& unit = dem::output_unit(output.name);
  if (outputs.child(output.name).has("unit") && !data::convertible(output.unit.symbol, unit))
    outputs.child(output.name)
        .problem("unit", fmt::format("'{}' is no unit of {}, which is in {}", output.unit.symbol, output.name, unit),
                 "choose a unit that converts to it");
  for (const auto& [material, of] : workspace.cases) {
    const std::string why = dem::no_output_because(of, output.name);
    if (why.empty()) continue;
    outputs.problem(output.name, why, "leave it out");
    return;
  }
}

/// What the study says must fit the simulation.
void check_simulated(const data::StudyFile& file, const Workspace& workspace) {
  const data::Study& study = workspace.study;
  const std::vector<data::Input> inputs = data::inputs_of(study);
  std::vector<data::Section> sections;
  for (const data::Input& input : inputs) {
    const char* const kind = study.parameter_index(input.name) ? "parameters" : "controls";
    sections.push_back(file.root().child(kind).child(input.name));
    check_target(sections.back(), input);
  }
  check_effects(workspace, inputs, sections);
  for (const data::Output& output : study.outputs) check_output(file, workspace, output);
}

/// How tables were read that are not plain CSV; what is wrong with them was said before.
std::vector<std::string> how_tables_were_read(const data::Study& study) {
  std::vector<std::string> notes;
  const auto add = [&](const std::string& table) {
    if (const std::string how = data::read_csv(table).took_line(); !how.empty()) notes.push_back(how);
  };
  for (const data::ObservationSet& set : study.observations) add(set.file);
  if (const std::string& table = study.training.table;
      !table.empty() && fs::path(table).extension() == ".csv" && fs::exists(table))
    add(table);
  return notes;
}

/// The lists of points that another program or a hand has changed.
std::vector<std::string> changed_lists(const Workspace& workspace) {
  std::vector<std::string> notes;
  for (const std::string& path :
       {design_path(workspace), next_runs_path(workspace), verify_runs_path(workspace), posterior_runs_path(workspace)})
    if (data::origin_of(path) == data::Origin::changed)
      notes.push_back(fmt::format("{}: was changed since demcal wrote it; its points are taken as they stand",
                                  data::shown_path(path)));
  return notes;
}

/// What parameters and controls make of the rig in the middle of their ranges, or where the material fixes them.
std::vector<dem::SetValue> rig_amid(const data::Study& study, const data::Material& material) {
  std::vector<dem::SetValue> values;
  for (const data::Input& input : data::inputs_of(study)) {
    const std::optional<dem::Target> target = dem::find_target(input.target);
    if (!target || !target->name.starts_with("rig.") || target->name == "rig.rpm") continue;
    const auto fixed = material.fixed.find(input.name);
    const double value = fixed != material.fixed.end() ? fixed->second : 0.5 * (input.axis.low + input.axis.high);
    if (value >= target->low && value <= target->high) values.push_back({input.target, value});  // else said elsewhere
  }
  return values;
}

std::string default_out(const data::Study& study) {
  return fs::absolute(study.name + "-results").lexically_normal().string();
}

}  // namespace

Workspace open_workspace(const StudyOptions& options) {
  const data::StudyFile file = data::StudyFile::open(options.study, options.set);
  Workspace workspace{.study = data::read_study(file), .cases = {}, .surrogates = {}, .out = {}, .plan = {}};
  workspace.surrogates =
      std::make_shared<const uq::SurrogateOptions>(uq::read_surrogate_options(file, workspace.study));
  data::Study& study = workspace.study;
  workspace.changes = options.set;
  if (options.seed) {
    study.seed = *options.seed;
    workspace.changes.push_back(fmt::format("study.seed={}", study.seed));
  }
  if (file.root().child("rig").exists()) {
    for (const data::Material& material : study.materials)
      workspace.cases[material.name] = dem::read_case(file, material.name, rig_amid(study, material));
    check_simulated(file, workspace);
  }
  workspace.unsteady = file.root().child("training").choice("unsteady", Unsteady::leave_out);
  workspace.plan = data::read_plan(file, study);
  file.finish();
  workspace.out = options.out.empty() ? default_out(study) : fs::absolute(options.out).lexically_normal().string();
  workspace.notes = how_tables_were_read(study);
  for (std::string& note : changed_lists(workspace)) workspace.notes.push_back(std::move(note));
  return workspace;
}

void require_rig(const Workspace& workspace) {
  if (!workspace.cases.empty()) return;
  throw data::InputError(
      data::ExitStatus::bad_study,
      {data::shown_path(workspace.study.file), "has no [rig], so demcal cannot simulate it",
       "add a [rig], as demcal new shows one; for runs of another code demcal design lists points, and "
       "demcal train --until posterior the most useful ones"});
}

bool own_engine(const Workspace& workspace) { return workspace.study.training.engine == data::Engine::demcal; }

void require_own_runs(const Workspace& workspace) {
  require_rig(workspace);
  if (own_engine(workspace)) return;
  throw data::InputError(
      data::ExitStatus::bad_study,
      {workspace.study.training.place, "another code makes the runs (engine = \"none\"), so demcal makes none",
       "run the points that demcal design lists, or those of demcal train --until posterior, with that "
       "code; or leave engine out"});
}

void make_out(const Workspace& workspace, const std::string& subfolder) {
  const fs::path out = workspace.out;
  std::error_code failure;
  if (fs::weakly_canonical(out, failure) == fs::weakly_canonical(workspace.study.folder, failure))
    throw data::InputError(data::ExitStatus::cannot_write,
                           {workspace.out, "is the study's own folder, and nothing is ever written there",
                            "start demcal elsewhere, or give --out DIR"});
  fs::create_directories(out / subfolder, failure);
  if (failure)
    throw data::InputError(
        data::ExitStatus::cannot_write,
        {(out / subfolder).string(), "cannot be made: " + failure.message(), "give another folder with --out DIR"});
  if (::access((out / subfolder).c_str(), W_OK | X_OK) != 0)
    throw data::InputError(data::ExitStatus::cannot_write,
                           {(out / subfolder).string(), fmt::format("cannot be written: {}", std::strerror(errno)),
                            "give another folder with --out DIR"});
}

namespace {

/// Two studies of one name have one results folder by default, and the second must not replace the first's results.
/// A study that was moved or renamed still owns its own.
void require_own_results(const Workspace& workspace) {
  const std::string results = results_path(workspace);
  std::error_code failure;
  if (!fs::exists(results, failure)) return;
  std::string of;
  try {
    of = uq::load_report(results).study_file;
  } catch (const data::InputError&) {  // damaged or of another version: it says of nobody whose it is
    return;
  }
  if (of.empty() || !fs::exists(of, failure) || fs::equivalent(of, workspace.study.file, failure)) return;
  throw data::InputError(data::ExitStatus::cannot_write,
                         {workspace.out, fmt::format("holds the results of another study, {}", of),
                          "give another folder with --out DIR, give this study a name of its own ([study] name), or "
                          "move those results away"});
}

}  // namespace

std::unique_ptr<data::FolderLock> hold_out(const Workspace& workspace, Writes files, const std::string& command) {
  make_out(workspace);
  const char* const name = files == Writes::training ? "training" : files == Writes::results ? "results" : "run";
  auto lock = std::make_unique<data::FolderLock>(workspace.out, name, "demcal " + command);
  std::vector<std::string> written;
  if (files == Writes::training)
    written = {training_path(workspace), training_copy_path(workspace), design_path(workspace)};
  if (files == Writes::results) {
    require_own_results(workspace);
    written = {surrogate_path(workspace), results_path(workspace), page_path(workspace), plan_path(workspace)};
    for (const data::CalibrationCase& one : workspace.study.cases)
      written.push_back(posterior_path(workspace, one.name));
  }
  for (const std::string& file : written) data::require_replaceable(file);
  return lock;
}

std::string with_unit(double si, const data::Unit& unit) {
  return fmt::format("{:.5g}{}", unit.from_si(si), uq::behind_number(unit.symbol));
}

}  // namespace campaign
