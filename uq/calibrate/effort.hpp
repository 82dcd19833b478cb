#pragma once
// The memory and time that a calibration will take, known before anything is fitted, with n training runs and readings
// at r settings:
//
//   memory of a surrogate's fit     56 n^2 bytes: seven matrices of n by n (measured: 45 MB of 1,000 runs, 215 MB of
//                                   2,000)
//   processor time of a sampling    E (r n^2 + r^2 n + r^3 / 3) / F: E evaluations of the likelihood, at F operations a
//                                   second. Each is a triangular product of n by n with r columns, the readings'
//                                   covariance, and its factor. E depends on the posterior; a case of ten free
//                                   parameters asks some hundred thousand times.
#include <string>
#include <vector>

#include "uq/emulate/surrogates.hpp"

namespace uq {

struct EffortLimits {
  double memory = 0.0;     ///< memory of this machine, bytes; 0: as the system says
  double seconds = 600.0;  ///< time of a case's sampling above which it is reported
};

/// The processor time [s] that the sampling of a case takes, by the formula above.
double sampling_seconds(const data::Study& study, const data::CalibrationCase& one, const data::RunTable& table,
                        const SurrogateOptions& options);

/// A sentence for each case whose sampling takes long: how long, why, and what to thin. Throws data::InputError (78)
/// where a surrogate's fit needs more memory than this machine has.
std::vector<std::string> effort_notes(const data::Study& study, const data::RunTable& table,
                                      const SurrogateOptions& options, const EffortLimits& limits = {});

}  // namespace uq
