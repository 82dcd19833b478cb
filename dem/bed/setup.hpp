#pragma once
// A case and its rig, put together for the engine.
#include "dem/bed/derived.hpp"
#include "dem/engine/simulation.hpp"
#include "dem/rig/rig.hpp"

namespace dem {

/// Makes the engine's setup of a whole case. The bodies rest for `rest_steps`.
Setup make_setup(const Case& c, const Derived& d, BuiltRig rig, std::uint64_t rest_steps, int threads);

}  // namespace dem
