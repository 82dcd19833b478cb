#pragma once
// run.h5: one run with its series, summary, diagnostics, settings and checkpoint.
//
// /            attributes: format, demcal, isa, seed, status, reason, settings (text of settings_text), material,
//              rule (look_rule_version), cpu_seconds, ...; warnings
// /series      time and one dataset per sampled output, each with a `unit`
// /summary     per output: mean, standard_error, sd, integrated_time, effective_samples, dropped, reliable, drifts
//              (columns), `names`, `units`; attributes state ("steady", "drifting" or "short"), why, ordering,
//              measured_from_s, turns; drift_p of torque, coordination and kinetic energy
// /diagnostics attributes, SI
// /checkpoint  the state, to go on from; bytes as they are in memory, so only for the same build
#include <string>

#include "dem/run/run.hpp"

namespace dem {

/// Writes the file, whole or not at all. Throws data::InputError (73).
void write_run(const std::string& path, const Case& c, const RunResult& result);

/// A run read back: all but the derived diagnostics, which follow from the case.
struct SavedRun {
  RunResult result;
  std::string settings;  ///< settings_text of the case that was run
  int rule = 0;          ///< look_rule_version by which it was judged
  /// The outputs that the file has, by name. Of outputs that came after the file was written, series and means are not
  /// numbers. The run is then not gone on from: its checkpoint has no state.
  std::vector<std::string> outputs;
};

/// Reads a run's file. Throws data::InputError: 66 missing, 65 not such a file.
SavedRun read_run(const std::string& path);

}  // namespace dem
