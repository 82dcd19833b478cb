// A short run against a hash written down: whatever changes a bit of the physics shows here, also where all threads and
// instruction sets change alike. A change that is meant writes the new hash down, and says so in CHANGELOG.md.
#include <xxhash.h>

#include <catch2/catch.hpp>

#include "dem/run/run.hpp"

namespace {

/// Of the torque series and the last positions.
std::uint64_t hash_of(const dem::RunResult& result) {
  std::uint64_t hash = XXH3_64bits(result.series.torque.data(), result.series.torque.size() * sizeof(double));
  for (const dem::PositionRow& row : result.checkpoint.state.position) {
    const double at[]{row.at.x, row.at.y, row.at.z};
    hash = XXH3_64bits_withSeed(at, sizeof at, hash);
  }
  return hash;
}

dem::Case short_slice() {
  dem::Case c;
  c.rig.fill = 200.0;
  c.run.settle = 0.01;
  c.run.start_up = 0.01;
  c.run.start_up_turns = 0.0;
  c.run.shortest = 0.02;
  c.run.shortest_turns = 0.0;
  c.run.window = 0.002;
  c.run.longest = 0.05;
  return c;
}

}  // namespace

TEST_CASE("a short run of the slice has the bits that were written down") {
  // The C library's sine differs in its last bit between processors with and without fused operations.
  if (!__builtin_cpu_supports("fma")) return;
  const dem::RunResult result = dem::run(short_slice(), 7);
  REQUIRE(result.status == dem::RunStatus::done);
  REQUIRE(result.series.torque.size() > 20);
  CHECK(hash_of(result) == 0x294c661fcc165ac1);
}
