#pragma once
// A study's knowledge of a meter and of the settings of one observation set, made into a part of a group's Measurement.
#include <Eigen/Core>
#include <vector>

#include "data/error.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

/// The rows of one output of one set. They are the last rows of their group.
struct SetRows {
  const data::ObservationSet& set;
  std::size_t output = 0;  ///< index into Study::outputs
  Eigen::Index first = 0;
  const std::vector<std::size_t>& points;  ///< by row, the points of the set at which the output was measured
};

/// One of the model's unknowns, of the case or of the set, that acts on the rows.
struct Acting {
  data::Nuisance nuisance;
  int unknown = -1;
};

/// Adds the rows to group.measurement. Returns what the study asks and the runs cannot tell.
std::vector<data::Problem> add_measurement(RowGroup& group, const data::Study& study, const SetRows& rows,
                                           const std::vector<Acting>& unknowns);

}  // namespace uq
