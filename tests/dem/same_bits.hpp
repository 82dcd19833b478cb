#pragma once
// That a result depends on its case and seed alone: not on the threads, not on where a run was stopped.
#include <catch2/catch.hpp>
#include <vector>

#include "dem/run/run.hpp"
#include "tests/dem/scene.hpp"

namespace scene {

/// Checks that some steps of the case's rig end in the same bits with 1, 2 and 4 threads, particles having been sorted
/// anew meanwhile.
inline void check_threads_agree(const dem::Case& c, int steps, std::uint64_t rest_steps = 0) {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 4}) {
    dem::Simulation s(rig(c, 1, rest_steps, threads));
    for (int k = 0; k < steps; ++k) s.step();
    CHECK(s.state().rebuilds > 3);
    hashes.push_back(hash(s.state()));
  }
  CHECK(hashes[0] == hashes[1]);
  CHECK(hashes[0] == hashes[2]);
}

/// A run, and the same stopped at a checkpoint and gone on from there with two threads.
struct WholeAndResumed {
  dem::RunResult whole, resumed;
};

/// Stops at the given checkpoint (the first is 1); checks that both end in the same state with the same torque.
inline WholeAndResumed check_resumed_agrees(const dem::Case& c, int checkpoint) {
  WholeAndResumed runs{.whole = dem::run(c, 1), .resumed = {}};
  REQUIRE(runs.whole.status == dem::RunStatus::done);
  dem::Checkpoint middle;
  int calls = 0;
  dem::RunOptions first;
  first.checkpoint_interval = 0.0;
  first.checkpoint = [&](const dem::Checkpoint& now) {
    if (++calls == checkpoint) middle = now;
  };
  dem::run(c, 1, first);
  REQUIRE(calls >= checkpoint);
  dem::RunOptions second;
  second.resume = &middle;
  second.threads = 2;
  runs.resumed = dem::run(c, 1, second);
  CHECK(hash(runs.resumed.checkpoint.state) == hash(runs.whole.checkpoint.state));
  CHECK(runs.resumed.series.torque == runs.whole.series.torque);
  CHECK(runs.resumed.summary.mean[0].mean == runs.whole.summary.mean[0].mean);
  return runs;
}

}  // namespace scene
