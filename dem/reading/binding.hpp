#pragma once
// How a target (target.hpp) is read from a case and written into it.
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dem/reading/target.hpp"

namespace dem {

struct Binding {
  Target target;
  std::function<double(const Case&)> get;
  std::function<void(Case&, double)> set;
  std::function<std::string(const Case&)> unused;  ///< why the case has no use for it
};

/// The targets "contact.A-B.KEY" of a pair of materials and "material.NAME.KEY" of a component, which are not listed.
std::optional<Binding> find_part(std::string_view name);

/// Those of them that a run of the case depends on: of its components all that are read, of its pairs those given.
std::vector<std::string> part_quantities(const Case& c);

/// Why a value of all walls, "contact.wall_KEY", has no effect: contact.pair gives another to each. Empty where it has,
/// and of any other target.
std::string walls_without_effect(const Case& c, const std::string& name);

}  // namespace dem
