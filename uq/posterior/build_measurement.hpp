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
};

/// The model's unknowns that act on them.
struct MeterUnknowns {
  std::vector<int> nuisances;  ///< of the case, in its order
  int scale = -1;              ///< of the rig; -1: none
};

/// Adds to group.measurement; says what the study asks and the runs cannot tell.
std::vector<data::Problem> add_measurement(RowGroup& group, const data::Study& study, const data::CalibrationCase& item,
                                           const SetRows& rows, const MeterUnknowns& unknowns);

}  // namespace uq
