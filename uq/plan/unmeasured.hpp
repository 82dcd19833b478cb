#pragma once
// A study before anything is measured, so that a plan can be made on its priors.
#include <vector>

#include "data/study.hpp"
#include "uq/calibrate/calibrate.hpp"

namespace uq::plan {

/// Gives a study without cases one case per material. The case observes nothing, and frees every parameter that the
/// material does not fix.
data::Study with_cases(const data::Study& study);

/// The model of a case without draws. A case that observes nothing is given one reading to stand on, of the first
/// output in the middle of its material's runs, in `study`; its value is the surrogate's there. Plans on the prior look
/// at no value that was read. Throws data::InputError (65) where no run of its material has that output.
SampledCase unmeasured_case(data::Study& study, const std::vector<Emulator>& emulators, std::size_t case_index);

}  // namespace uq::plan
