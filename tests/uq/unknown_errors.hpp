#pragma once
// Errors of unknown size, added to cases whose model is a formula (tests/uq/closed_form.hpp).
#include <string>

#include "uq/posterior/case_model.hpp"

namespace unknown_errors {

inline uq::Unknown nuisance(const std::string& name, data::NuisanceKind kind, data::Parameter parameter,
                            data::Prior prior) {
  parameter.name = name;
  prior.low = parameter.low;
  prior.high = parameter.high;
  return {.label = name, .prior = uq::ScaledPrior(parameter, prior), .own = false, .nuisance = kind, .cut = {}};
}

/// One sd of all readings, of which nothing is known but its order of magnitude.
inline void free_noise(uq::CaseModel& model) {
  const data::Parameter parameter{.name = "", .target = "", .low = 1e-3, .high = 1e3, .scale = data::Scale::log};
  const int index = model.dimension();
  model.unknowns.push_back(
      nuisance("noise", data::NuisanceKind::noise_sd, parameter, {.kind = data::PriorKind::log_uniform}));
  uq::RowGroup& group = model.groups[0];
  group.measurement.sets.push_back(
      {.first = 0, .count = group.base.rows(), .factors = {}, .noise = index, .noise_is_sd = true, .settings = {}});
  uq::find_coordinates(group, model.dimension());
}

/// A discrepancy process over x with an unknown sd and length, under the priors that a study has by default.
inline void free_discrepancy(uq::CaseModel& model, double magnitude) {
  const int sd = model.dimension(), length = sd + 1;
  model.unknowns.push_back(nuisance("discrepancy_sd", data::NuisanceKind::discrepancy_sd,
                                    {.name = "", .target = "", .low = 0.0, .high = 0.5},
                                    {.kind = data::PriorKind::truncated_normal, .mean = 0.0, .sd = 0.1}));
  model.unknowns.push_back(nuisance("discrepancy_length", data::NuisanceKind::discrepancy_length,
                                    {.name = "", .target = "", .low = 0.05, .high = 5.0, .scale = data::Scale::log},
                                    {.kind = data::PriorKind::log_normal, .mean = 0.5, .sd = 0.7}));
  uq::RowGroup& group = model.groups[0];
  group.measurement.discrepancies.push_back({.first = 0,
                                             .count = group.base.rows(),
                                             .sd = sd,
                                             .length = length,
                                             .magnitude = magnitude,
                                             .controls = group.base.rightCols(1)});
  uq::find_coordinates(group, model.dimension());
}

}  // namespace unknown_errors
