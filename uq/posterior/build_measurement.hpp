#pragma once
// What a study knows of a meter and of the settings of one observation set, as part of a group's Measurement.
#include <Eigen/Core>
#include <vector>

#include "data/error.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

/// Rows of one output of one set, the last of their group.
struct SetRows {
  const data::ObservationSet& set;
  std::size_t output = 0;  ///< in Study::outputs
  Eigen::Index first = 0;
  const std::vector<std::size_t>& points;  ///< of the set, by row: those at which the output was measured
};

/// One of the model's unknowns that act on them, of the case or of the set.
struct Acting {
  data::Nuisance nuisance;
  int unknown = -1;
};

/// Adds to group.measurement; says what the study asks and the runs cannot tell.
std::vector<data::Problem> add_measurement(RowGroup& group, const data::Study& study, const SetRows& rows,
                                           const std::vector<Acting>& unknowns);

}  // namespace uq
