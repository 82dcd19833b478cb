#pragma once
// Fitted processes in HDF5 (surrogate.h5), one group per process:
//   /                          format, kind, study_hash, table_hash, and the names of process0, process1, ...
//   /processN                  kernel, mean, scale, nugget, shift, unit, log_jacobian, converged, jitter,
//                              agreeing_starts
//   /processN/points, z, noise, point_of_run, active, low, high, gaps
//                              the standardised training set (training.hpp)
//   /processN/length_scales, signal_variance, nugget_variance, weight
//                              one row for each setting of the hyper-parameters
//   /processN/starts           one row for each start: objective, gradient norm, evaluations, converged, points,
//                              agrees; start_from and start_to: its logarithms before and after
//   /processN/bound_names, bound_hits
//                              hyper-parameters that are on a bound: upper, value, harmless, input, effect
//   /processN/second_level     where there is a second level (two_level.hpp): x, y, noise_variance, discrepancy_mean,
//                              settings (weight, rho, length factor, discrepancy sd, nugget sd), and the fit's outcome
//   /processN/remarks          a text of the caller's, kept as it is
// Covariances are factorised again when a file is read: the file is small, and the same bits come back.
// A file whose study or table hash is not the one asked for is stale: it is refused and named, never used silently.
#include <map>
#include <optional>
#include <string>

#include "surrogate/two_level.hpp"

namespace surrogate {

/// The identity of what a saved surrogate was made from.
struct SurrogateKey {
  std::string study_hash;  ///< hash of what in the study decides the surrogate
  std::string table_hash;  ///< hash of the run table
};

struct SavedProcess {
  GaussianProcess process;        ///< the process; of the low level where there are two
  std::optional<HighLevel> high;  ///< none: one level
  std::string remarks = {};       ///< the caller's, such as how the process was judged
};

using ProcessSet = std::map<std::string, SavedProcess>;  ///< by name, such as "carrier torque"

/// Writes the file, whole or not at all. Throws data::InputError (73).
void save_processes(const std::string& path, const ProcessSet& processes, const SurrogateKey& key);

struct LoadedProcesses {
  std::optional<ProcessSet> processes;  ///< none: missing, or stale
  std::string reason;                   ///< why none: "no saved surrogate", "the run table has changed since"
};

/// Reads a file. Throws data::InputError (65) for a file that is not a surrogate, or is damaged.
LoadedProcesses load_processes(const std::string& path, const SurrogateKey& key);

}  // namespace surrogate
