#pragma once
// Materials that stand for one powder at several sizes of its grains: its levels of coarse graining. `plan` asks them
// whether an output of enlarged grains means the same in the powder (uq/plan/levels.hpp).
#include <map>
#include <string>
#include <vector>

#include "campaign/workspace.hpp"

namespace campaign {

/// Each material with enlarged grains, and the others of the same materials.NAME.powder. Throws InputError (78) for two
/// of one powder with the same coarse_graining, or of other grains (diameter over coarse_graining, density) or another
/// fill, and where a parameter is the Hamaker constant of the simulated spheres, which is another one at every level.
std::map<std::string, std::vector<std::string>> coarse_levels(const Workspace& workspace);

}  // namespace campaign
