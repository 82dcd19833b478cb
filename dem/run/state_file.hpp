#pragma once
// The checkpoint of a run in its file (dem/run/run_file.hpp): the rows of the state as bytes, as they are in memory,
// and the sample under way.
#include "data/hdf5.hpp"
#include "dem/run/run.hpp"

namespace dem {

void write_checkpoint(const data::Hdf5Group& group, const Checkpoint& now);

/// The checkpoint without its series. It has no state where the file is of before there was one of the outputs. Throws
/// data::InputError (65) when another build wrote it.
Checkpoint read_checkpoint(const data::Hdf5Group& group);

}  // namespace dem
