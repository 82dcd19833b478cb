#pragma once
// The check whether a case can be simulated, and what follows from the case.
#include <vector>

#include "data/error.hpp"
#include "dem/bed/derived.hpp"

namespace dem {

/// Everything about a case that cannot be simulated.
std::vector<data::Problem> problems(const Case& c);

/// Checks the case and works out what follows from it. Throws data::InputError (78) with all problems of the case.
PreparedCase prepare(Case c);

}  // namespace dem
