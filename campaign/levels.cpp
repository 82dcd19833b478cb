#include "campaign/levels.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace campaign {
namespace {

/// A parameter of the study that is a Hamaker constant; none: nullptr.
const data::Parameter* hamaker_parameter(const data::Study& study) {
  const auto found = std::find_if(study.parameters.begin(), study.parameters.end(), [](const data::Parameter& one) {
    return one.target.ends_with(".hamaker") || one.target.ends_with(".wall_hamaker");
  });
  return found == study.parameters.end() ? nullptr : &*found;
}

}  // namespace

std::map<std::string, std::vector<std::string>> coarse_levels(const Workspace& workspace) {
  const data::Study& study = workspace.study;
  std::map<std::string, std::vector<std::string>> levels;
  std::vector<data::Problem> problems;
  for (const data::Material& one : study.materials) {
    const auto own = workspace.cases.find(one.name);
    if (own == workspace.cases.end()) continue;
    const double enlargement = own->second.material.coarse_graining;
    if (enlargement > 1.0) levels[one.name];
    for (const data::Material& other : study.materials) {
      const auto its = workspace.cases.find(other.name);
      if (one.powder.empty() || other.name == one.name || other.powder != one.powder || its == workspace.cases.end())
        continue;
      if (its->second.material.coarse_graining == enlargement && one.name < other.name)
        problems.push_back({one.place,
                            fmt::format("materials '{}' and '{}' are both powder '{}' at a coarse_graining of {:g}",
                                        one.name, other.name, one.powder, enlargement),
                            "levels of a powder differ in coarse_graining: change one of them"});
      const data::Parameter* hamaker = hamaker_parameter(study);
      if (hamaker != nullptr && own->second.contact.hamaker_of == dem::HamakerOf::simulation && one.name < other.name)
        problems.push_back({hamaker->place,
                            fmt::format("{} is the constant of the simulated spheres, which is another one for "
                                        "'{}' than for '{}', levels of one powder",
                                        hamaker->name, one.name, other.name),
                            "write contact.hamaker_of = \"original\""});
      if (enlargement > 1.0) levels[one.name].push_back(other.name);
    }
  }
  if (!problems.empty()) throw data::InputError(data::ExitStatus::bad_study, problems);
  return levels;
}

}  // namespace campaign
