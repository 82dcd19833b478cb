#pragma once
// Reads one material's DEM case from a study: [rig], [materials.NAME], [contact] and [run]. data/study_keys_table.cpp
// lists every key with its unit, range and default; rigs from meshes are read by dem/rig/read_stl_rig.hpp.
#include <string_view>

#include "data/study_file.hpp"
#include "dem/case/case.hpp"

namespace dem {

/// Reads the case. Problems are recorded in the study; `material` "" reads a study without [materials].
Case read_case(const data::StudyFile& study, std::string_view material);

}  // namespace dem
