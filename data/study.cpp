#include "data/study.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <filesystem>
#include <set>

#include "data/atomic_file.hpp"
#include "data/file_name.hpp"
#include "data/observations.hpp"
#include "data/repeats.hpp"
#include "data/study_parts.hpp"

namespace data {
namespace {

namespace fs = std::filesystem;

/// Names that become parts of file names.
void check_file_name(const Section& section, const std::string& name) {
  if (!section.has("name")) return;  // reported as missing where it is required
  if (!is_file_name(name)) {
    section.problem("name", fmt::format("'{}' cannot be part of a file's name", name),
                    "use at most 100 letters, digits, '-', '_' and '.', beginning with a letter");
  }
}

std::string beside(const Study& study, const std::string& file) {
  return (fs::path(study.folder) / file).lexically_normal().string();
}

/// Names of the materials that mixtures are made of. These are simulated within the mixtures, and have no rows of their
/// own.
std::set<std::string> ingredients(const Section& materials) {
  std::set<std::string> names;
  for (const auto& [unused, section] : materials.children())
    for (const Section& part : section.array("components")) names.insert(part.text("material", ""));
  return names;
}

void read_materials(const Section& root, Study& study) {
  const std::set<std::string> parts = ingredients(root.child("materials"));
  for (const auto& [name, section] : root.child("materials").children()) {
    if (parts.contains(name)) continue;
    Material material{.name = name, .fixed = read_fixed(section.child("fixed"), study), .place = section.place()};
    if (section.has("runs")) material.runs = static_cast<int>(section.integer("runs", {.low = 1, .high = 1e6}));
    material.powder = section.text("powder", "");
    study.materials.push_back(std::move(material));
  }
  if (study.materials.empty()) study.materials.push_back({.place = root.place()});
}

void read_training(const Section& root, Study& study) {
  const Section section = root.child("training");
  Training& training = study.training;
  training.place = section.place();
  training.runs = static_cast<int>(section.integer("runs", {.low = 1, .high = 1e6}, training.runs));
  training.standard_error =
      section.number("standard_error", {.low = 0.0, .high = 1.0, .open_low = true}, training.standard_error);
  if (const std::string table = section.text("table", ""); !table.empty()) training.table = beside(study, table);
  if (const std::string low = section.text("low", ""); !low.empty()) training.low = beside(study, low);
  training.leave_out = section.labels("leave_out");
  training.engine = section.choice("engine", root.has("rig") ? Engine::demcal : Engine::none);
  if (training.engine == Engine::none && training.table.empty()) {
    section.problem("table", "is missing, and there is no [rig] to simulate with",
                    "name the CSV file of your runs, or add a [rig]");
  }
  if (training.engine == Engine::demcal && !root.has("rig")) {
    section.problem("engine", "'demcal' has no [rig] to simulate", "add a [rig], or write engine = \"none\"");
  }
}

}  // namespace

std::string material_of(const Section& section, const Study& study) {
  std::vector<std::string> names;
  for (const Material& material : study.materials) names.push_back(material.name);
  if (names.size() == 1) {
    if (!section.has("material")) return names.front();
    if (names.front().empty()) {
      section.problem("material", fmt::format("'{}' is not in the study", section.text("material")),
                      "add a [materials] section, or leave it out");
      return "";
    }
  }
  return section.choice("material", names);
}

namespace {

/// Problems of the observation files, with the exit status of the first one; and each set's settings.
struct ObservationFiles {
  ExitStatus status = ExitStatus::done;
  std::vector<Problem> problems;
  std::vector<std::map<std::string, double>> settings;

  void add(ExitStatus of_these, const std::vector<Problem>& these) {
    if (problems.empty()) status = of_these;
    problems.insert(problems.end(), these.begin(), these.end());
  }
};

/// Reads each observation file; whether one may lack its standard errors is known with the cases alone.
ObservationFiles read_observation_sets(const Section& root, Study& study) {
  ObservationFiles found;
  for (const Section& section : root.array("observe")) {
    const std::string name = section.text("name");
    check_file_name(section, name);
    if (study.observation_index(name)) {
      section.problem("name", fmt::format("'{}' is taken", name), "give each [[observe]] its own name");
    }
    const std::string material = material_of(section, study);
    const std::string file = section.text("file");
    ObservationSet set{.file = beside(study, file)};
    const std::map<std::string, double> settings = read_settings(section.child("settings"), study);
    if (file.empty() && section.has("file"))
      section.problem("file", "is empty", "name the CSV with the measured points");
    std::error_code unseen;
    if (!file.empty() && !fs::exists(set.file, unseen)) {
      found.add(ExitStatus::missing_input,
                {{section.place("file"), fmt::format("there is no file '{}'", shown_path(set.file)),
                  "paths start at the study's folder"}});
    } else if (!file.empty()) {
      try {
        set = read_observations(set.file, study, settings, MissingErrors::nan);
      } catch (const InputError& error) {
        found.add(error.status, error.problems);
      }
    }
    set.name = name;
    set.material = material;
    set.place = section.place();
    read_measurement(root, section, study, set);
    study.observations.push_back(std::move(set));
    found.settings.push_back(settings);
  }
  return found;
}

/// Checks that sets which name the same meter agree on its error: one meter has one error.
void check_meters(const Section& root, const Study& study) {
  std::size_t index = 0;
  for (const Section& section : root.array("observe")) {
    const ObservationSet& set = study.observations[index++];
    if (set.meter.empty()) continue;
    for (const ObservationSet& other : study.observations) {
      if (&other == &set) break;
      if (other.meter != set.meter) continue;
      for (const CommonError& error : set.common_errors)
        for (const CommonError& first : other.common_errors)
          if (error.output == first.output && !(error.spread == first.spread))
            section.problem("common_error",
                            fmt::format("of {} is not that of '{}', though both are of the meter '{}'",
                                        study.outputs[error.output].name, other.name, set.meter),
                            "state the same one in both, or name two meters");
    }
  }
}

/// The middle of a noise's prior: what stands for an error that is unknown wherever one number is shown.
double middle_of(const Prior& prior) {
  if (prior.kind == PriorKind::normal || prior.kind == PriorKind::truncated_normal ||
      prior.kind == PriorKind::log_normal)
    return prior.mean > 0.0 ? prior.mean : prior.mean + prior.sd;
  return 0.5 * (prior.low + prior.high);
}

/// Standard errors that a file lacks: the middle of the noise that stands in their place, or the file's problem.
void replace_missing_errors(Study& study, ObservationFiles& files) {
  for (std::size_t index = 0; index < study.observations.size(); ++index) {
    ObservationSet& set = study.observations[index];
    bool replaced = false;
    for (std::size_t k = 0; !set.points.empty() && k < set.outputs.size(); ++k) {
      const auto is_missing = [k](const Observation& point) {
        return point.has(k) && std::isnan(point.standard_errors[k]);
      };
      if (std::none_of(set.points.begin(), set.points.end(), is_missing)) continue;
      const Nuisance* noise = noise_instead(study, set, set.outputs[k]);
      if (noise == nullptr) {
        try {
          read_observations(set.file, study, files.settings[index]);
        } catch (const InputError& error) {
          files.add(error.status, error.problems);
        }
        replaced = false;
        break;
      }
      for (Observation& point : set.points)
        if (point.has(k)) point.standard_errors[k] = middle_of(noise->parameter.prior);
      replaced = true;
    }
    if (replaced) count_copies_once(set, study);
  }
}

}  // namespace

std::optional<std::size_t> Study::parameter_index(std::string_view parameter_name) const {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].name == parameter_name) return i;
  }
  return {};
}

std::optional<std::size_t> Study::control_index(std::string_view control_name) const {
  for (std::size_t i = 0; i < controls.size(); ++i) {
    if (controls[i].name == control_name) return i;
  }
  return {};
}

std::vector<Input> inputs_of(const Study& study) {
  std::vector<Input> inputs;
  for (const Parameter& p : study.parameters) inputs.push_back({p.name, p.target, p.unit, p.axis()});
  for (const Control& c : study.controls) inputs.push_back({c.name, c.target, c.unit, c.axis()});
  return inputs;
}

std::optional<std::size_t> Study::observation_index(std::string_view set_name) const {
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (observations[i].name == set_name) return i;
  }
  return {};
}

std::optional<std::size_t> Study::case_index(std::string_view case_name) const {
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (cases[i].name == case_name) return i;
  }
  return {};
}

std::optional<std::size_t> ObservationSet::column_of(std::size_t output) const {
  const auto found = std::find(outputs.begin(), outputs.end(), output);
  if (found == outputs.end()) return {};
  return static_cast<std::size_t>(found - outputs.begin());
}

const Material& Study::material(std::string_view material_name) const {
  for (const Material& candidate : materials) {
    if (candidate.name == material_name) return candidate;
  }
  throw std::out_of_range(fmt::format("the study has no material '{}'", material_name));
}

Study read_study(const StudyFile& file) {
  const Section root = file.root();
  Study study;
  study.file = file.path();
  study.folder = file.folder();
  const Section head = root.child("study");
  study.name = head.text("name", fs::path(study.folder).filename().string());
  check_file_name(head, study.name);
  study.description = head.text("description", "");
  study.notes = head.texts("notes");
  study.seed = static_cast<std::uint64_t>(head.integer("seed", non_negative, 1));

  read_parameters(root, study);
  read_controls(root, study);
  read_outputs(root, study);
  check_column_names(root, study);
  // A rig may be simulated, and its outputs learnt over the controls, without any; a calibration needs one.
  if (study.parameters.empty() && (!root.has("rig") || root.has("calibrate")))
    root.problem("parameters", "names no parameter", "add a section like [parameters.friction]");
  read_materials(root, study);
  read_training(root, study);
  read_rig_scale(root, study);
  ObservationFiles files = read_observation_sets(root, study);
  check_meters(root, study);
  read_correlations(root, study);
  read_cases(root, study);
  read_unused_data(root, study);
  replace_missing_errors(study, files);
  for (ObservationSet& set : study.observations) average_shared_errors(set, study);
  for (const Section& section : root.array("calibrate")) check_file_name(section, section.text("name"));

  if (!files.problems.empty()) {
    std::vector<Problem> problems = file.recorded();
    const ExitStatus status = problems.empty() ? files.status : ExitStatus::bad_study;
    problems.insert(problems.end(), files.problems.begin(), files.problems.end());
    throw InputError(status, std::move(problems));
  }
  return study;
}

void require_cases(const Study& study) {
  std::vector<Problem> problems;
  const std::string place = shown_path(study.file);
  if (study.observations.empty()) {
    problems.push_back({place, "has no measurements to calibrate against", "add [[observe]] with a name and a file"});
  }
  if (study.cases.empty()) {
    problems.push_back({place, "has no case to calibrate", "add [[calibrate]] with name, observe and free"});
  }
  for (const CalibrationCase& one : study.cases)
    if (one.observe.empty() && !study.observations.empty())
      problems.push_back({one.place, fmt::format("case '{}' observes nothing", one.name),
                          "name at least one [[observe]] set in `observe`"});
  if (!problems.empty()) throw InputError(ExitStatus::bad_study, std::move(problems));
}

std::vector<Problem> outside_training_range(const Study& study) {
  std::vector<Problem> problems;
  for (const ObservationSet& set : study.observations) {
    for (const Observation& point : set.points) {
      assert(point.controls.size() == study.controls.size());
      for (std::size_t i = 0; i < study.controls.size(); ++i) {
        const Control& control = study.controls[i];
        // Speeds converted from another unit are rounded there: 0.83333 Hz are 49.9998 rpm.
        const double slack = 1e-4 * (control.high - control.low);
        if (point.controls[i] >= control.low - slack && point.controls[i] <= control.high + slack) continue;
        problems.push_back(
            {fmt::format("{}:{}: {}", shown_path(set.file), point.line, control.name),
             fmt::format("{:.10g}{} is outside the training range, {:.10g} to {:.10g}{}",
                         control.unit.from_si(point.controls[i]), behind_number(control.unit.symbol),
                         control.unit.from_si(control.low), control.unit.from_si(control.high),
                         behind_number(control.unit.symbol)),
             fmt::format("the surrogate extrapolates there: widen controls.{} and train again", control.name)});
      }
    }
  }
  return problems;
}

}  // namespace data
