#include "campaign/point.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "data/hash.hpp"
#include "data/number_text.hpp"
#include "data/provenance.hpp"
#include "dem/reading/target.hpp"

namespace campaign {

namespace {

data::InputError usage(std::string place, std::string what, std::string remedy) {
  return {data::ExitStatus::usage, data::Problem{std::move(place), std::move(what), std::move(remedy)}};
}

std::string names_of(const std::vector<data::Input>& inputs) {
  std::vector<std::string> names;
  for (const data::Input& input : inputs) names.push_back(input.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// "2e-18 J" or, in the input's unit, "2e-18".
double parse_value(const std::string& text, const data::Input& input, const std::string& place) {
  const auto number = data::number_with_unit(text);
  if (!number)
    throw usage(place, fmt::format("'{}' is not a number", text),
                fmt::format("write {}=NUMBER or {}=\"NUMBER UNIT\"", input.name, input.name));
  if (number->unit.empty()) return input.unit.to_si(number->digits);
  try {
    if (data::convertible(number->unit, input.unit.symbol)) return data::parse_unit(number->unit).to_si(number->digits);
  } catch (const std::invalid_argument&) {
  }
  throw usage(place, fmt::format("'{}' is not a unit of {}", number->unit, input.name),
              fmt::format("use {}", input.unit.symbol.empty() ? "a bare number" : input.unit.symbol));
}

/// The middle of an input's range. Of speeds to either side of a standstill, at which nothing can be simulated, it is
/// the middle of those forwards.
double amid(const data::Input& input) {
  const double middle = 0.5 * (input.axis.low + input.axis.high);
  const bool at_rest = std::abs(middle) < 1e-9 * input.axis.high && dem::target(input.target).name == "rig.rpm";
  return at_rest ? 0.5 * input.axis.high : middle;
}

}  // namespace

std::string choose_material(const data::Study& study, const std::string& wanted) {
  std::string known;
  for (const data::Material& material : study.materials) {
    if (wanted.empty() || material.name == wanted) return material.name;
    known += (known.empty() ? "" : ", ") + material.name;
  }
  throw usage("--material", fmt::format("the study has no material '{}'", wanted), "choose one of: " + known);
}

Point parse_point(const Workspace& workspace, const std::string& material, const std::vector<std::string>& at) {
  const std::vector<data::Input> inputs = data::inputs_of(workspace.study);
  const data::Material& rows = workspace.study.material(material);
  Point point{material, {}};
  for (const data::Input& input : inputs) {
    const auto fixed = rows.fixed.find(input.name);
    point.inputs.push_back(fixed != rows.fixed.end() ? fixed->second : amid(input));
  }
  std::vector<std::string> set;
  for (const std::string& assignment : at) {
    const std::size_t equals = assignment.find('=');
    const std::string name = assignment.substr(0, equals);
    const auto found =
        std::find_if(inputs.begin(), inputs.end(), [&](const data::Input& input) { return input.name == name; });
    if (equals == std::string::npos || found == inputs.end())
      throw usage("--at", fmt::format("'{}' sets no parameter or control", assignment),
                  inputs.empty() ? "the study has none: set a key of it by --set, like --set rig.rpm=\"100 rpm\""
                                 : fmt::format("write NAME=VALUE with one of: {}", names_of(inputs)));
    const std::string place = "--at " + name;
    if (std::find(set.begin(), set.end(), name) != set.end())
      throw usage(place, fmt::format("is set twice, the second time by '{}'", assignment), "keep one of them");
    set.push_back(name);
    const double value = parse_value(assignment.substr(equals + 1), *found, place);
    const dem::Target target = dem::target(found->target);
    if (!(value >= target.low && value <= target.high))
      throw usage(place,
                  fmt::format("{} is outside the possible range [{:g}, {:g}] of {}", with_unit(value, found->unit),
                              found->unit.from_si(target.low), found->unit.from_si(target.high), target.name),
                  "choose a value inside it");
    point.inputs[found - inputs.begin()] = value;
  }
  return point;
}

std::string describe(const data::Study& study, const Point& point) {
  std::string text;
  const std::vector<data::Input> inputs = data::inputs_of(study);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    text += fmt::format("{}{} {}", i == 0 ? "" : ", ", inputs[i].name, with_unit(point.inputs[i], inputs[i].unit));
  return text;
}

dem::Case case_at(const Workspace& workspace, const Point& point) {
  dem::Case result = workspace.cases.at(point.material);
  const std::vector<data::Input> inputs = data::inputs_of(workspace.study);
  for (std::size_t i = 0; i < inputs.size(); ++i) dem::set_target(result, inputs[i].target, point.inputs[i]);
  for (const data::Output& output : workspace.study.outputs)
    if (output.name != "torque") result.run.known.push_back(output.name);
  return result;
}

namespace {

/// The material's DEM settings with every input at one value, whatever its range is: rows stay good when a range is
/// moved. How long a run is decides its standard error, not what it estimates: rows of any length stay good.
dem::Case settings_of(const Workspace& workspace, const std::string& material) {
  dem::Case settings = workspace.cases.at(material);
  for (const data::Input& input : data::inputs_of(workspace.study)) {
    const dem::Target target = dem::target(input.target);
    dem::set_target(settings, input.target, std::clamp(1.0, target.low, target.high));
  }
  const dem::RunControl usual;
  settings.run.standard_error = usual.standard_error;
  settings.run.shortest = 0.3;  // one for all: the default when the first tables were made
  settings.run.shortest_turns = usual.shortest_turns;
  settings.run.longest = usual.longest;
  // Whether a run is stopped, not what it gives.
  settings.run.overlap_limit = usual.overlap_limit;
  return settings;
}

}  // namespace

std::string settings_hash(const Workspace& workspace, const std::string& material) {
  if (!workspace.cases.contains(material)) return "";  // another code's runs
  return data::hash_text(dem::settings_text(settings_of(workspace, material)));
}

std::string course_hash(const Workspace& workspace, const std::string& material) {
  if (!workspace.cases.contains(material)) return "";
  dem::Case settings = settings_of(workspace, material);
  settings.run.start_up_turns = 0.25;  // one for all; with this one seeds are what they were when it was the default
  return data::hash_text(dem::settings_text(settings));
}

std::uint64_t number_from(const std::string& text) {
  return std::stoull(data::hash_text(text).substr(0, 16), nullptr, 16);
}

std::uint64_t run_seed(const Workspace& workspace, const Point& point) {
  std::string text = fmt::format("{} {}", workspace.study.seed, course_hash(workspace, point.material));
  for (const double value : point.inputs) text += fmt::format(" {:.12g}", value);
  return number_from(text);
}

data::RunRow to_row(const Workspace& workspace, const Point& point, const dem::RunResult& result) {
  data::RunRow row{.material = point.material,
                   .inputs = point.inputs,
                   .seed = workspace.study.seed,
                   .settings = settings_hash(workspace, point.material),
                   .isa = result.diagnostics.isa,
                   .origin = "demcal " + data::program_version(),
                   .cpu_seconds = result.summary.cpu_seconds,
                   .state = data::to_text(result.summary.state),
                   .unreliable = ""};
  for (const data::Output& output : workspace.study.outputs) {
    const data::SeriesMean& mean = dem::output(result, output.name);
    row.outputs.push_back(mean.mean);
    row.standard_errors.push_back(mean.standard_error);
    if (mean.reliable) continue;
    if (!row.unreliable.empty()) row.unreliable += " ";
    row.unreliable += output.name + (mean.drifts ? "" : data::brief_mark);
  }
  return row;
}

}  // namespace campaign
