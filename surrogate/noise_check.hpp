#pragma once
// A check whether the runs scatter by their stated errors. It takes two statistics of a fitted process, with
// D = diag(v) the stated variances and a = P m, P as in likelihood.hpp:
//   too small   the nugget takes up what the errors leave unexplained, be it scatter or structure finer than the runs:
//               2 log(likelihood with the nugget / without), the other hyper-parameters fitted again. Where there is
//               no nugget it is about chi-squared of one degree of freedom, halved.
//   too large   S = a' D a, the residuals D a in units of their errors; where all is right S has mean tr(D P) and
//               variance 2 tr(D P D P).
#include "surrogate/validation.hpp"

namespace surrogate {

/// Checks the stated errors; finds nothing where one is not stated. The fit options are those of the process.
NoiseCheck check_noise(const TrainingSet& training, const FitOptions& options, const GaussianProcess& process);

/// What the check found, as a sentence that begins with "the runs' errors"; empty: nothing.
std::string noise_note(const NoiseCheck& check);

}  // namespace surrogate
