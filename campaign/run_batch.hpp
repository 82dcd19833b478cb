#pragma once
// Several runs at once, one thread each. Every finished run is kept at once: its file in OUT/runs, its row in
// OUT/training.h5 and training.csv. An interrupted run goes on from its checkpoint when the same run is asked for
// again.
#include <cstdint>
#include <stop_token>
#include <vector>

#include "campaign/design.hpp"
#include "campaign/ledger.hpp"

namespace campaign {

struct BatchOptions {
  int jobs = 1;                         ///< runs at the same time
  std::vector<data::RunRow> kept = {};  ///< rows of other settings, which are written back
  std::stop_token stop = {};
  data::Progress* progress = nullptr;  ///< told of each run that ended and of failures; may be none
};

/// Makes the runs. Throws InputError (78) where the rig makes a run nonsense, before any is made.
BatchResult run_batch(const Workspace& workspace, const std::vector<PlannedRun>& runs, data::RunTable table,
                      const BatchOptions& options);

/// Throws InputError (78) where the rig makes the runs of a material nonsense, or where `here` runs at a time need more
/// memory than this machine has. `here` 0: the runs are made elsewhere.
void foretell_materials(const Workspace& workspace, const std::vector<PlannedRun>& runs, int here);

/// Throws data::InputError (73) where a file that is not demcal's stands in the place of one of these runs.
void require_places(const Workspace& workspace, const std::vector<PlannedRun>& runs);

/// The workspace with another seed of the study.
Workspace with_seed(const Workspace& workspace, std::uint64_t seed);

}  // namespace campaign
