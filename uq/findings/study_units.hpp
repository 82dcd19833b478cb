#pragma once
// Conversion from the numerics to the findings: values in SI, or places on an axis, become values in the study's units,
// in which findings are kept (results.hpp) and said.
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "data/study.hpp"

namespace uq {

/// A place on the axis of a parameter or a control.
template <class Input>
double in_study_unit(const Input& input, double place) {
  return input.unit.from_si(input.axis().from_unit(place));
}

/// SI values of the study's controls, each by its name.
inline std::map<std::string, double> named_controls(const data::Study& study, std::span<const double> controls) {
  std::map<std::string, double> named;
  for (std::size_t c = 0; c < study.controls.size(); ++c)
    named[study.controls[c].name] = study.controls[c].unit.from_si(controls[c]);
  return named;
}

using data::behind_number, data::is_bare;

}  // namespace uq
