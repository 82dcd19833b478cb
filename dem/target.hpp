#pragma once
// The names by which a study reaches the fields of a case, to calibrate or control them.
#include <string>
#include <string_view>
#include <vector>

#include "data/error.hpp"
#include "dem/case.hpp"

namespace dem {

struct Target {
  std::string name;     ///< "contact.friction"; the last part alone will do, as no two names share it
  std::string unit;     ///< SI
  double low, high;     ///< SI, values that a simulation can take
  std::string meaning;  ///< one line
};

const std::vector<Target>& targets();
const Target* find_target(std::string_view name);  ///< null when there is none
const Target& target(std::string_view name);       ///< throws std::out_of_range when there is none

/// Sets the field to `si`. Throws data::InputError (78) for an unknown name or a value out of range.
void set_target(Case& c, std::string_view name, double si);
/// The field's value, or what it follows when it is not set.
double get_target(const Case& c, std::string_view name);

/// Everything about a case that cannot be simulated.
std::vector<data::Problem> problems(const Case& c);

/// All resolved settings, one "name = value unit" a line in fixed order: hash it to know whether two runs are alike.
std::string settings_text(const Case& c);

}  // namespace dem
