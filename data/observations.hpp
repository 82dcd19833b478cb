#pragma once
// Measured points from a CSV: one column per control, one per output, and OUTPUT_se beside each, in the study's units.
// Other columns are left alone.
#include <map>
#include <string>

#include "data/study.hpp"

namespace data {

/// Reads the points of `path`; `settings` (SI) gives the controls that it has no column of. Name, material and place
/// are the caller's. Throws InputError: 66 missing; 65 missing column, no rows, text or nothing for a number, a
/// standard error that is not above 0.
ObservationSet read_observations(const std::string& path, const Study& study,
                                 const std::map<std::string, double>& settings = {});

}  // namespace data
