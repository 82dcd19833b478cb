#include "campaign/levels.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dem/case/grains.hpp"

namespace campaign {
namespace {

/// A parameter of the study that is a Hamaker constant; none: nullptr.
const data::Parameter* hamaker_parameter(const data::Study& study) {
  const auto found = std::find_if(study.parameters.begin(), study.parameters.end(), [](const data::Parameter& one) {
    return one.target.ends_with(".hamaker") || one.target.ends_with(".wall_hamaker");
  });
  return found == study.parameters.end() ? nullptr : &*found;
}

/// A property that the materials of one powder must have in common: a name, both values and their unit.
struct Property {
  const char* name;
  double one, other;
  const char* unit;
};

/// Finds what keeps two materials from being levels of one powder.
void check_levels(const data::Study& study, const data::Material& one, const dem::Case& own,
                  const data::Material& other, const dem::Case& its, std::vector<data::Problem>& problems) {
  constexpr double same = 0.02;
  const double enlargement = own.material.coarse_graining, others = its.material.coarse_graining;
  if (others == enlargement) {
    problems.push_back({one.place,
                        fmt::format("materials '{}' and '{}' are both powder '{}' at a coarse_graining of {:g}",
                                    one.name, other.name, one.powder, enlargement),
                        "levels of a powder differ in coarse_graining: change one of them"});
    return;
  }
  for (const Property& property :
       {Property{"diameter over coarse_graining", 1e6 * dem::mean_diameter(own.material) / enlargement,
                 1e6 * dem::mean_diameter(its.material) / others, "um"},
        Property{"density", own.material.density, its.material.density, "kg/m3"},
        Property{"fill", 1e3 * dem::summarise_bed(own).mass, 1e3 * dem::summarise_bed(its).mass, "g"}})
    if (std::abs(property.one - property.other) > same * std::max(property.one, property.other))
      problems.push_back({one.place,
                          fmt::format("materials '{}' and '{}' are both powder '{}', and their {} is {:.4g} {} and "
                                      "{:.4g} {}",
                                      one.name, other.name, one.powder, property.name, property.one, property.unit,
                                      property.other, property.unit),
                          "levels of a powder are the same grains in the same bed: correct it, or name two powders"});
  if (const data::Parameter* hamaker = hamaker_parameter(study);
      hamaker != nullptr && own.contact.hamaker_of == dem::HamakerOf::simulation)
    problems.push_back({hamaker->place,
                        fmt::format("{} is the constant of the simulated spheres, which is another one for '{}' than "
                                    "for '{}', levels of one powder",
                                    hamaker->name, one.name, other.name),
                        "write contact.hamaker_of = \"original\""});
}

}  // namespace

std::map<std::string, std::vector<std::string>> coarse_levels(const Workspace& workspace) {
  std::map<std::string, std::vector<std::string>> levels;
  std::vector<data::Problem> problems;
  for (const data::Material& one : workspace.study.materials) {
    const auto own = workspace.cases.find(one.name);
    if (own == workspace.cases.end()) continue;
    const bool enlarged = own->second.material.coarse_graining > 1.0;
    if (enlarged) levels[one.name];
    for (const data::Material& other : workspace.study.materials) {
      const auto its = workspace.cases.find(other.name);
      if (one.powder.empty() || other.powder != one.powder || its == workspace.cases.end() || other.name == one.name)
        continue;
      if (one.name < other.name) check_levels(workspace.study, one, own->second, other, its->second, problems);
      if (enlarged) levels[one.name].push_back(other.name);
    }
  }
  if (!problems.empty()) throw data::InputError(data::ExitStatus::bad_study, problems);
  return levels;
}

}  // namespace campaign
