#pragma once
// What a study says of its surrogates: the section
//   [surrogate]
//   kernel = "matern 5/2"               # also "matern 3/2", "squared exponential"
//   mean = "constant"                   # also "zero", "linear", "quadratic", "trend" (surrogate/mean_basis.hpp)
//   stretch = true                      # also false: inputs are learnt on the scales that the study gives them
//   log_outputs = ["torque"]            # outputs that are learnt as logarithms; they must be positive
//   nugget = true                       # run-to-run scatter beyond the stated standard errors
//   estimate = "maximum a posteriori"   # also "maximum likelihood"
//   hyper_parameters = "integrated if few"  # runs, fewer than five per input; also "plugged in", "integrated"
//   between_runs = "doubted"            # also "trusted": what gaps.hpp adds where few values of an input were run
//   runs_most = 1000                    # of a table with more runs, so many train
//   starts = 8
// all of it optional. The cheaper level's rows are [training] low (data/study.hpp).
#include "data/study.hpp"
#include "data/study_file.hpp"
#include "uq/emulate/surrogates.hpp"

namespace uq {

/// Records problems in the file. The seed is the study's.
SurrogateOptions read_surrogate_options(const data::StudyFile& file, const data::Study& study);

}  // namespace uq
