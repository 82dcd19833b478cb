#pragma once
// Reads one material's DEM case from a study: [rig], [materials.NAME], [contact] and [run]. data/study_keys_table.cpp
// lists every key with its unit, range and default; rigs from meshes are read by dem/rig/read_stl_rig.hpp.
#include <string>
#include <string_view>
#include <vector>

#include "data/study_file.hpp"
#include "dem/case/case.hpp"

namespace dem {

/// A value [SI] of a quantity (target.hpp) that the runs set.
struct SetValue {
  std::string target;
  double si = 0.0;
};

/// Reads the case. Problems are recorded in the study; `material` "" reads a study without [materials]. The rig is
/// judged at the values of `set`, which the runs give it, and not at those of keys that no run has.
Case read_case(const data::StudyFile& study, std::string_view material, const std::vector<SetValue>& set = {});

}  // namespace dem
