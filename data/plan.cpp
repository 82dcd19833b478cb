#include "data/plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data/study_parts.hpp"

namespace data {
namespace {

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

/// Index of a name; a problem at `key` where there is none.
std::optional<std::size_t> index_of(const Section& section, std::string_view key, const std::string& name,
                                    const std::vector<std::string>& names, const char* what) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  section.problem(key, fmt::format("the study has no {} '{}'", what, name),
                  names.empty() ? "leave it out" : fmt::format("choose one of: {}", fmt::join(names, ", ")));
  return {};
}

/// The values of a control: one value or a list.
std::vector<double> values_of(const Section& settings, const Control& control) {
  std::vector<double> values;
  if (!settings.has(control.name)) return values;
  const ValueKind kind = settings.kind(control.name);
  if (kind == ValueKind::number || kind == ValueKind::text)
    values.push_back(
        settings.quantity(control.name, control.unit.si_symbol, any_number, control.low, bare_unit(control.unit)));
  else
    values = settings.quantities(control.name, control.unit.si_symbol, any_number, bare_unit(control.unit));
  return values;
}

PlanEntry read_entry(const Section& section, const Study& study) {
  PlanEntry entry{.place = section.place()};
  entry.name = section.text("name", "");
  entry.material = section.text("material", "");
  if (!entry.material.empty()) index_of(section, "material", entry.material, names_of(study.materials), "material");
  for (const std::string& name : section.texts("outputs"))
    if (const auto index = index_of(section, "outputs", name, names_of(study.outputs), "output")) {
      if (std::find(entry.outputs.begin(), entry.outputs.end(), *index) != entry.outputs.end())
        section.problem("outputs", fmt::format("'{}' is named twice", name), "name it once, and repeats as readings");
      entry.outputs.push_back(*index);
    }
  if (entry.outputs.empty()) entry.outputs.push_back(0);
  const Section settings = section.child("settings");
  for (const Control& control : study.controls) entry.settings.push_back(values_of(settings, control));
  entry.together = section.flag("together", false);
  entry.readings = static_cast<int>(section.integer("readings", {.low = 1, .high = 1e6}, 1));
  const Unit& unit = study.outputs.empty() ? Unit{} : study.outputs[entry.outputs.front()].unit;
  if (section.has("error")) entry.error = read_spread(section, "error", unit, BareNumber::share);
  if (section.has("common_error")) entry.common_error = read_spread(section, "common_error", unit, BareNumber::share);
  if (section.has("meter")) {
    entry.meter = section.text("meter");
    std::vector<std::string> meters;
    for (const ObservationSet& set : study.observations)
      if (!set.meter.empty()) meters.push_back(set.meter);
    if (std::find(meters.begin(), meters.end(), entry.meter) == meters.end())
      section.problem("meter", fmt::format("'{}' has read none of the study's measurements", entry.meter),
                      meters.empty()
                          ? "leave it out: a new meter needs no name here"
                          : fmt::format("name one that has ({}), or leave it out: a new meter needs no name here",
                                        fmt::join(meters, ", ")));
    else if (entry.common_error)
      section.problem("common_error",
                      fmt::format("is stated, but that of '{}' stands with its measurements", entry.meter),
                      "leave one of the two out");
  }
  for (const auto& [key, spread] : {std::pair{"error", entry.error}, {"common_error", entry.common_error}})
    if (spread && spread->absolute > 0.0 && entry.outputs.size() > 1)
      section.problem(key, "has a unit, but the candidate reads several outputs",
                      "state it as a percentage, or write a candidate per output");
  entry.cost = section.number("cost", positive, 1.0);
  return entry;
}

}  // namespace

PlanSection read_plan(const StudyFile& file, const Study& study) {
  PlanSection plan;
  if (!file.root().has("plan")) return plan;
  const Section section = file.root().child("plan");
  plan.about = section.text("about", "");
  if (!plan.about.empty()) index_of(section, "about", plan.about, names_of(study.parameters), "parameter");
  plan.cost_unit = section.text("cost_unit", "");
  for (const Section& entry : section.array("candidates")) {
    plan.candidates.push_back(read_entry(entry, study));
    const std::string& name = plan.candidates.back().name;
    const auto same = std::count_if(plan.candidates.begin(), plan.candidates.end(),
                                    [&](const PlanEntry& one) { return !name.empty() && one.name == name; });
    if (same > 1) entry.problem("name", fmt::format("'{}' is the name of another candidate, too", name), "rename one");
  }
  return plan;
}

}  // namespace data
