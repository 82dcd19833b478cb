#include "campaign/foretell.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "campaign/design.hpp"
#include "data/progress.hpp"
#include "data/provenance.hpp"
#include "dem/reading/prepare.hpp"
#include "dem/reading/target.hpp"
#include "dem/rig/drive.hpp"
#include "dem/run/looks.hpp"

namespace campaign {
namespace {

/// Before anything of the size of the bed is made: what `require_memory` would refuse by far.
void refuse_absurd(const Workspace& workspace, const dem::Derived& derived) {
  constexpr double bytes_at_least = 100.0;  // of a sphere
  const double bytes = bytes_at_least * static_cast<double>(derived.spheres), machine = data::machine_memory();
  if (bytes <= machine) return;
  throw data::InputError(
      data::ExitStatus::bad_study,
      {workspace.study.file + ": [rig] fill",
       fmt::format(
           "makes {:.3g} spheres of {:.3g} m, which need over {:.2g} GB of memory, and this machine has {:.2g} GB",
           static_cast<double>(derived.spheres), derived.diameter, 1e-9 * bytes, 1e-9 * machine),
       "check the diameter and its unit and the fill; use fewer or larger spheres (coarse_graining)"});
}

/// Whether the input changes the rig or its fill, so that the forecast at its ends is another one.
bool is_of_rig(const data::Input& input) {
  const std::string name = dem::target(input.target).name;
  return name.starts_with("rig.") && name != "rig.rpm";
}

}  // namespace

Foretold foretell(const Workspace& workspace, const Point& point) {
  dem::PreparedCase prepared = dem::prepare(case_at(workspace, point));
  refuse_absurd(workspace, prepared.derived());
  dem::Forecast forecast = dem::forecast(prepared, workspace.study.seed);
  Foretold told{std::move(prepared), std::move(forecast)};
  if (!told.forecast.problems.empty())
    throw data::InputError(data::ExitStatus::bad_study, std::move(told.forecast.problems));
  if (std::string short_of = too_short(workspace, {point}); !short_of.empty())
    told.forecast.warnings.push_back(std::move(short_of));
  return told;
}

bool changes_rig(const data::Study& study) {
  const std::vector<data::Input> inputs = data::inputs_of(study);
  return std::any_of(inputs.begin(), inputs.end(), is_of_rig);
}

Cost cost_of(const dem::PreparedCase& prepared) {
  const dem::Case& c = prepared.given();
  const dem::Derived& derived = prepared.derived();
  Cost cost;
  cost.effort = dem::measure_effort(c, derived);
  const double spheres = static_cast<double>(derived.spheres);
  cost.steps = (c.run.settle + c.run.longest) / derived.time_step;
  cost.seconds = cost.steps * (spheres / cost.effort.rate + cost.effort.seconds_at_walls);
  // The state, and the last good one; and the meshes.
  cost.bytes = 2.0 * spheres * cost.effort.bytes_per_sphere + cost.effort.bytes_of_meshes;
  const double machine = data::machine_memory();
  if (cost.bytes > 0.8 * machine)
    cost.warnings.push_back(fmt::format("a run needs about {:.2g} GB of memory, and this machine has {:.2g} GB",
                                        1e-9 * cost.bytes, 1e-9 * machine));
  if (cost.seconds > 86400.0)
    cost.warnings.push_back(
        fmt::format("a run takes up to {} on one core: {} spheres, {:.2g} steps of {:.2g} s (fewer "
                    "or larger spheres, or a softer contact.stiffness, shorten it)",
                    data::rough_duration_text(cost.seconds), derived.spheres, cost.steps, derived.time_step));
  return cost;
}

std::optional<data::Problem> too_large(const Cost& cost, std::int64_t spheres, int jobs, double machine) {
  const double bytes = jobs * cost.bytes;
  if (bytes <= machine) return {};
  if (cost.effort.bytes_of_meshes > 0.5 * cost.bytes)
    return data::Problem{"rig.mesh",
                         fmt::format("has triangles that need about {:.2g} GB of memory in {}, and this machine has "
                                     "{:.2g} GB",
                                     1e-9 * jobs * cost.effort.bytes_of_meshes,
                                     jobs == 1 ? "a run" : fmt::format("{} runs at a time", jobs), 1e-9 * machine),
                         "give a coarser mesh: triangles of half a sphere's diameter are fine enough"};
  return data::Problem{
      "[rig] fill",
      fmt::format(
          "makes {} spheres of {:.0f} bytes each, so that {} need about {:.2g} GB of memory, and this machine has "
          "{:.2g} GB",
          spheres, cost.bytes / static_cast<double>(spheres),
          jobs == 1 ? "the state of a run and its last good one" : fmt::format("{} runs at a time", jobs), 1e-9 * bytes,
          1e-9 * machine),
      cost.bytes <= machine
          ? fmt::format("--jobs {} at most, or fewer or larger spheres", static_cast<int>(machine / cost.bytes))
          : "fewer or larger spheres, or a larger machine"};
}

void require_memory(const Workspace& workspace, const Foretold& told, int jobs) {
  constexpr std::int64_t surely_fits = 100000;  // spheres, and triangles: some 80 MB
  const auto spheres = static_cast<std::int64_t>(told.prepared.derived().spheres);
  std::int64_t triangles = 0;
  if (const auto& stl = told.prepared.given().rig.stl)
    for (const dem::RigMesh& m : stl->meshes) triangles += static_cast<std::int64_t>(m.mesh.triangles.size());
  if ((spheres + triangles) * jobs <= surely_fits) return;
  std::optional<data::Problem> problem = too_large(cost_of(told.prepared), spheres, jobs, data::machine_memory());
  if (!problem) return;
  problem->place = workspace.study.file + ": " + problem->place;
  throw data::InputError(data::ExitStatus::bad_study, *problem);
}

namespace {

/// What keeps the rig of a point from being simulated, or "".
std::string wrong_with_rig(const Workspace& workspace, const Point& point) {
  try {
    return data::describe(dem::forecast(dem::prepare(case_at(workspace, point)), workspace.study.seed).problems);
  } catch (const data::InputError& error) {
    return data::describe(error.problems);
  }
}

/// What a speed's range that reaches 0 means: turns near a standstill take long, as the design's own points tell.
std::vector<std::string> problems_at_standstill(const Workspace& workspace, const std::string& material,
                                                bool short_amid) {
  std::vector<std::string> found;
  for (const data::Input& input : data::inputs_of(workspace.study)) {
    const data::Axis& axis = input.axis;
    if (dem::target(input.target).name != "rig.rpm" || axis.low > 0.0 || axis.high < 0.0) continue;
    if (axis.low < 0.0 && axis.high > 0.0)
      found.push_back(fmt::format(
          "{} goes from {} to {}: the rig turns either way, and outputs may bend or change their sign at a standstill; "
          "a range on one side of 0 is learnt better",
          input.name, with_unit(axis.low, input.unit), with_unit(axis.high, input.unit)));
    const int runs = workspace.study.material(material).runs.value_or(workspace.study.training.runs);
    if (std::string short_of = too_short(workspace, training_design(workspace, material, 0, runs));
        !short_amid && !short_of.empty())
      found.push_back(std::move(short_of));
  }
  return found;
}

}  // namespace

std::vector<std::string> problems_at_ends(const Workspace& workspace, const Point& middle) {
  const std::vector<data::Input> inputs = data::inputs_of(workspace.study);
  const auto& fixed = workspace.study.material(middle.material).fixed;
  const bool short_amid = !too_short(workspace, {middle}).empty();  // then `foretell` says so once
  std::vector<std::string> found = problems_at_standstill(workspace, middle.material, short_amid);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (fixed.count(inputs[i].name) > 0) continue;
    for (const double end : {inputs[i].axis.low, inputs[i].axis.high}) {
      // No run is made at a standstill: the design's points lie inside.
      if (end == 0.0 && dem::target(inputs[i].target).name == "rig.rpm") continue;
      Point point = middle;
      point.inputs[i] = end;
      if (is_of_rig(inputs[i]))
        if (std::string wrong = wrong_with_rig(workspace, point); !wrong.empty()) {
          found.push_back(fmt::format("at {} {}: {}", inputs[i].name, with_unit(end, inputs[i].unit), wrong));
          continue;
        }
      for (const data::Problem& p : dem::problems(case_at(workspace, point)))
        found.push_back(
            fmt::format("at {} {}: {}", inputs[i].name, with_unit(end, inputs[i].unit), data::describe({p})));
      if (const std::string short_of = too_short(workspace, {point}); !short_amid && !short_of.empty())
        found.push_back(fmt::format("at {} {}: {}", inputs[i].name, with_unit(end, inputs[i].unit), short_of));
    }
  }
  return found;
}

std::string too_short(const Workspace& workspace, const std::vector<Point>& points) {
  std::size_t count = 0;
  double worst = 0.0;
  dem::Case of_worst;
  for (const Point& point : points) {
    const dem::Case c = case_at(workspace, point);
    const double wanted = dem::turning_missed(c.run, dem::turn_of(c));
    if (wanted > 0.0) ++count;
    if (wanted > worst) {
      worst = wanted;
      of_worst = c;
    }
  }
  if (count == 0) return {};
  const dem::RunControl& run = of_worst.run;
  return fmt::format(
      "{} of {} runs would be too short: run.longest, {:g} s, ends before the start-up "
      "({:g} turns and {:g} s at least) and the measurement ({:g} turns and {:g} s at least) are done, which takes up "
      "to {:.3g} s: raise run.longest",
      count, points.size(), run.longest, run.start_up_turns, run.start_up, run.shortest_turns, run.shortest, worst);
}

std::vector<std::string> outside_ranges(const Workspace& workspace, const Point& point) {
  std::vector<std::string> notes;
  const std::vector<data::Input> inputs = data::inputs_of(workspace.study);
  const auto& fixed = workspace.study.material(point.material).fixed;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const data::Input& in = inputs[i];
    const double x = point.inputs[i];
    if (const auto held = fixed.find(in.name); held != fixed.end()) {
      if (x != held->second)
        notes.push_back(fmt::format("{} {} is not what the study holds it at for this material, {}", in.name,
                                    with_unit(x, in.unit), with_unit(held->second, in.unit)));
    } else if (x < in.axis.low || x > in.axis.high) {
      notes.push_back(fmt::format("{} {} lies outside the study's range, {} to {}: no training run is made there",
                                  in.name, with_unit(x, in.unit), with_unit(in.axis.low, in.unit),
                                  with_unit(in.axis.high, in.unit)));
    }
  }
  return notes;
}

nlohmann::json to_json(const Foretold& told, const Cost& cost) {
  const dem::Forecast& f = told.forecast;
  nlohmann::json json{{"spheres", f.spheres},
                      {"mass_kg", f.mass},
                      {"bond_number", told.prepared.derived().bond},
                      {"wall_bond_number", told.prepared.derived().wall_bond},
                      {"time_step_s", told.prepared.derived().time_step},
                      {"steps", cost.steps},
                      {"cpu_seconds_at_most", cost.seconds},
                      {"memory_bytes", cost.bytes},
                      {"particle_steps_per_second", cost.effort.rate},
                      {"bodies", f.bodies},
                      {"warnings", f.warnings}};
  json["fill"] = f.fill ? nlohmann::json(*f.fill) : nlohmann::json();
  json["surface_m"] = f.surface ? nlohmann::json(*f.surface) : nlohmann::json();
  json["gaps"] = nlohmann::json::array();
  for (const dem::NamedGap& gap : f.gaps)
    json["gaps"].push_back({{"between", gap.between}, {"m", gap.width}, {"spheres", gap.in_spheres}});
  return json;
}

}  // namespace campaign
