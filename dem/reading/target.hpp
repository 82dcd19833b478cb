#pragma once
// The names by which a study reaches the fields of a case, to calibrate or control them.
//
//   contact.KEY             all contacts ("wall_" keys: contacts with bodies)
//   contact.A-B.KEY         contacts of two materials, or of a material with a body, its material or "wall"
//   material.KEY, rig.KEY   the bed and the rig
//   material.NAME.KEY       a mixture's component
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/error.hpp"
#include "dem/case/case.hpp"
#include "dem/case/coefficients.hpp"

namespace dem {

struct Target {
  std::string name;     ///< "contact.friction"; the last part alone will do, as no two names share it
  std::string unit;     ///< SI
  double low, high;     ///< SI, values that a simulation can take
  std::string meaning;  ///< one line
};

/// The targets that every case has; the names of other targets depend on the materials.
const std::vector<Target>& targets();
std::optional<Target> find_target(std::string_view name);  ///< none when there is none, whatever the materials
Target target(std::string_view name);                      ///< throws std::out_of_range when there is none

/// Sets the field to `si`. Throws data::InputError (78) for an unknown name, a value out of range, or a quantity that
/// the case does not use.
void set_target(Case& c, std::string_view name, double si);
/// The field's value, or the value of the field that it follows when it is not set.
double get_target(const Case& c, std::string_view name);

/// Why setting the quantity would change nothing in this case; empty where it would.
std::string unused_because(const Case& c, std::string_view name);

/// Why a quantity that the case's laws read has no effect on its runs, as where every wall has a coefficient of its
/// own; empty where it has an effect.
std::string without_effect(const Case& c, std::string_view name);

/// Names of all quantities set in this case: the members of targets() that it uses, its components' and its pairs'.
std::vector<std::string> quantities_of(const Case& c);

/// All resolved settings, one "name = value unit" a line in fixed order: hash it to know whether two runs are alike. A
/// choice at its default is left out where it came after studies were run, so that their rows stay good.
std::string settings_text(const Case& c);

}  // namespace dem
