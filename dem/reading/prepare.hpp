#pragma once
// Whether a case can be simulated, and what follows from it.
#include <vector>

#include "data/error.hpp"
#include "dem/bed/derived.hpp"

namespace dem {

/// Everything about a case that cannot be simulated.
std::vector<data::Problem> problems(const Case& c);

/// Throws data::InputError (78) with all problems of the case.
PreparedCase prepare(Case c);

}  // namespace dem
