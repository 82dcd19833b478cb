// [[calibrate]] and [[predict]]: what each case names must exist, and together `free`, `fixed` and what the observed
// materials fix themselves must give every parameter exactly one role.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "data/edit_distance.hpp"
#include "data/study_parts.hpp"

namespace data {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Records names that are not among `known`, or that come twice.
void check_names(const Section& section, std::string_view key, const std::vector<std::string>& names,
                 const std::pair<std::string, std::vector<std::string>>& known) {
  const auto& [what, candidates] = known;
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (!contains(candidates, name)) {
      const auto near = nearest(name, candidates);
      section.problem(key, fmt::format("'{}' is not {}", name, what),
                      near                 ? fmt::format("did you mean '{}'?", *near)
                      : candidates.empty() ? "the study has none"
                                           : fmt::format("there are {}", fmt::join(candidates, ", ")));
    } else if (!seen.insert(name).second) {
      section.problem(key, fmt::format("'{}' is named twice", name), "name it once");
    }
  }
}

/// Every parameter must be free, fixed by the case, or fixed by each material that the case is about.
void check_roles(const Section& section, const CalibrationCase& item, const Study& study) {
  std::vector<std::string> names = {item.material};
  for (const std::string& name : item.observe)
    if (const auto index = study.observation_index(name)) names.push_back(study.observations[*index].material);
  if (!item.observe.empty()) names.erase(names.begin());
  std::vector<const Material*> materials;
  for (const std::string& name : names)
    for (const Material& candidate : study.materials)
      if (candidate.name == name) materials.push_back(&candidate);
  if (materials.empty()) return;
  for (const Parameter& parameter : study.parameters) {
    const std::string& name = parameter.name;
    const bool is_free = contains(item.free, name);
    const auto fixed = item.fixed.find(name);
    int open = 0;
    for (const Material* material : materials) {
      const auto own = material->fixed.find(name);
      if (own == material->fixed.end()) {
        ++open;
      } else if (fixed != item.fixed.end() && fixed->second != own->second) {
        section.problem("fixed", fmt::format("{} is fixed at another value by the material '{}'", name, material->name),
                        "leave it out here; the material's value counts");
      }
    }
    if (is_free && fixed != item.fixed.end()) {
      section.problem("free", fmt::format("'{}' is both free and fixed", name), "name it in one of them");
    } else if (is_free && open == 0) {
      section.problem("free", fmt::format("'{}' is free, but fixed in every material observed", name),
                      "leave it out, or let the material's runs vary it");
    } else if (!is_free && fixed == item.fixed.end() && open > 0) {
      section.problem("free", fmt::format("leaves out '{}', which is not fixed either", name),
                      fmt::format("add it to free, or write fixed = {{ {} = VALUE }}", name));
    } else if (fixed != item.fixed.end() && open > 0) {
      const double slack = 1e-12 * (parameter.high - parameter.low);
      if (fixed->second < parameter.low - slack || fixed->second > parameter.high + slack) {
        const Unit& unit = parameter.unit;
        section.problem(
            "fixed",
            fmt::format("{} = {:.10g}{} is outside its range, {:.10g} to {:.10g}", name, unit.from_si(fixed->second),
                        behind_number(unit.symbol), unit.from_si(parameter.low), unit.from_si(parameter.high)),
            "choose a value inside, where there are runs");
      }
    }
  }
}

/// Checks that the case is compared with itself with fewer free parameters, held inside their ranges.
void check_comparison(const Section& section, const CalibrationCase& item, const Study& study) {
  for (const auto& [name, value] : item.held) {
    const Parameter& parameter = study.parameters[*study.parameter_index(name)];
    if (!contains(item.free, name))
      section.problem("compare", fmt::format("holds {}, which the case does not free", name),
                      "compare with a free parameter held at a value");
    if (value < parameter.low || value > parameter.high)
      section.problem("compare",
                      fmt::format("{} = {:.10g}{} is outside its range, {:.10g} to {:.10g}", name,
                                  parameter.unit.from_si(value), behind_number(parameter.unit.symbol),
                                  parameter.unit.from_si(parameter.low), parameter.unit.from_si(parameter.high)),
                      "choose a value inside, where there are runs");
  }
  if (!item.held.empty() && item.held.size() >= item.free.size())
    section.problem("compare", "leaves no parameter free", "leave at least one out");
}

/// Checks that what a nuisance acts on is measured, and that its name is not a parameter's.
void check_nuisances(const Section& section, const CalibrationCase& item, const Study& study) {
  for (const Nuisance& nuisance : item.nuisances) {
    const std::string& name = nuisance.parameter.name;
    if (study.parameter_index(name))
      section.problem(name, "is also the name of a parameter, and the report could not tell them apart",
                      "give the parameter another name (its target can stay)");
    if (!nuisance.output || item.observe.empty()) continue;
    const bool measured = std::any_of(item.observe.begin(), item.observe.end(), [&](const std::string& set) {
      const auto index = study.observation_index(set);
      return index && std::count(study.observations[*index].outputs.begin(), study.observations[*index].outputs.end(),
                                 *nuisance.output) > 0;
    });
    if (!measured)
      section.problem(name,
                      fmt::format("acts on {}, which the case does not observe", study.outputs[*nuisance.output].name),
                      "name another output, or leave it out");
  }
}

/// A prior that is another case's posterior: the case must exist, leave the parameter free, and not lead back here.
void check_posteriors(const Section& section, const CalibrationCase& item, const Study& study) {
  const auto find = [&](const std::string& name) {
    return std::find_if(study.cases.begin(), study.cases.end(), [&](const auto& other) { return other.name == name; });
  };
  std::vector<std::string> names;
  for (const CalibrationCase& other : study.cases) names.push_back(other.name);
  for (const auto& [parameter, prior] : item.priors) {
    if (prior.kind != PriorKind::posterior) continue;
    const auto source = find(prior.posterior_of);
    if (source == study.cases.end()) {
      check_names(section, "priors", {prior.posterior_of}, {"a case", names});
      continue;
    }
    if (!contains(source->free, parameter)) {
      section.problem(
          "priors", fmt::format("the case '{}' has no posterior of {}: it is not free there", source->name, parameter),
          "choose a case that calibrates it");
    }
    std::set<std::string> visited;
    std::vector<std::string> ahead{source->name};
    while (!ahead.empty()) {
      const std::string name = ahead.back();
      ahead.pop_back();
      if (name == item.name) {
        section.problem("priors", fmt::format("the prior of {} leads back to this case", parameter),
                        "break the circle");
        break;
      }
      const auto next = find(name);
      if (next == study.cases.end() || !visited.insert(name).second) continue;
      for (const auto& [unused, other] : next->priors) {
        if (other.kind == PriorKind::posterior) ahead.push_back(other.posterior_of);
      }
    }
  }
}

/// The sets that inform a case's posterior: its own, and those of the cases whose posteriors are its priors.
std::set<std::string> informing(const CalibrationCase& item, const Study& study) {
  std::set<std::string> sets, visited;
  std::vector<std::string> ahead{item.name};
  while (!ahead.empty()) {
    const std::string name = ahead.back();
    ahead.pop_back();
    if (!visited.insert(name).second) continue;
    for (const CalibrationCase& one : study.cases) {
      if (one.name != name) continue;
      sets.insert(one.observe.begin(), one.observe.end());
      for (const auto& [unused, prior] : one.priors)
        if (prior.kind == PriorKind::posterior) ahead.push_back(prior.posterior_of);
    }
  }
  return sets;
}

/// Checks that predicted data have not been used, and that the case knows what they are read by.
void check_unused_data(const Section& section, const UnusedData& wanted, const Study& study) {
  const CalibrationCase& item = study.cases[wanted.case_index];
  const std::set<std::string> used = informing(item, study);
  for (const std::string& name : wanted.observe) {
    if (used.count(name) > 0)
      section.problem("observe",
                      fmt::format("'{}' informs the case '{}' itself, so nothing is foretold", name, item.name),
                      "name a set that the case does not observe");
    const auto index = study.observation_index(name);
    if (!index) continue;
    for (const SettingError& error : study.observations[*index].setting_errors)
      if (error.as == SettingErrorAs::unknown)
        section.problem("observe",
                        fmt::format("'{}' has a setting error that is an unknown of its own ({})", name,
                                    study.controls[error.control].name),
                        "set as = \"covariance\" in its uncertainty");
  }
}

/// Which measurements a case has. One that has none yet names the material whose runs it is planned on.
void read_measured(const Section& section, const Study& study, CalibrationCase& item) {
  std::vector<std::string> observations;
  for (const ObservationSet& set : study.observations) observations.push_back(set.name);
  item.observe = section.texts("observe", section.has("observe"));
  check_names(section, "observe", item.observe, {"the name of an [[observe]]", observations});
  if (!section.has("observe")) {
    item.material = material_of(section, study);
  } else if (section.has("material")) {
    section.problem("material", "is said by what the case observes", "leave it out, or leave out observe");
  }
}

}  // namespace

void read_cases(const Section& root, Study& study) {
  std::vector<std::string> parameters;
  for (const Parameter& parameter : study.parameters) parameters.push_back(parameter.name);

  const std::vector<Section> sections = root.array("calibrate");
  for (const Section& section : sections) {
    CalibrationCase item{.name = section.text("name"), .place = section.place()};
    read_measured(section, study, item);
    item.free = section.texts("free", true);
    item.fixed = read_fixed(section.child("fixed"), study);
    item.held = read_fixed(section.child("compare"), study);
    check_names(section, "free", item.free, {"a parameter", parameters});
    const Section priors = section.child("priors");
    for (const Parameter& parameter : study.parameters) {
      if (!priors.has(parameter.name)) continue;
      item.priors[parameter.name] = read_prior(priors.child(parameter.name), parameter, PriorOf::case_);
      if (!contains(item.free, parameter.name)) {
        section.problem("priors", fmt::format("'{}' has a prior but is not free", parameter.name),
                        "add it to free, or remove its prior");
      }
    }
    item.nuisances = read_nuisances(section, study);
    check_comparison(section, item, study);
    check_nuisances(section, item, study);
    item.sampler = section.choice("sampler", item.sampler);
    for (const CalibrationCase& other : study.cases) {
      if (other.name == item.name)
        section.problem("name", fmt::format("'{}' is taken", item.name), "give each case its own name");
    }
    study.cases.push_back(std::move(item));
  }
  for (std::size_t i = 0; i < sections.size(); ++i) {
    check_roles(sections[i], study.cases[i], study);
    check_posteriors(sections[i], study.cases[i], study);
  }
}

void read_unused_data(const Section& root, Study& study) {
  std::vector<std::string> cases, observations;
  for (const CalibrationCase& item : study.cases) cases.push_back(item.name);
  for (const ObservationSet& set : study.observations) observations.push_back(set.name);
  for (const Section& section : root.array("predict")) {
    UnusedData wanted{
        .name = section.text("name"), .observe = section.texts("observe", true), .place = section.place()};
    check_names(section, "observe", wanted.observe, {"the name of an [[observe]]", observations});
    const std::string of = cases.size() == 1 ? section.text("case", cases.front()) : section.text("case");
    check_names(section, "case", {of}, {"the name of a [[calibrate]]", cases});
    const auto found = std::find(cases.begin(), cases.end(), of);
    for (const UnusedData& other : study.unused_data)
      if (other.name == wanted.name)
        section.problem("name", fmt::format("'{}' is taken", wanted.name), "give each prediction its own name");
    if (found == cases.end()) continue;
    wanted.case_index = static_cast<std::size_t>(found - cases.begin());
    check_unused_data(section, wanted, study);
    study.unused_data.push_back(std::move(wanted));
  }
}

}  // namespace data
