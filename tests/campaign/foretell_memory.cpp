#include <catch2/catch.hpp>

#include "campaign/foretell.hpp"

using Catch::Contains;

TEST_CASE("runs that need more memory than there is are refused with the bytes of a sphere and the jobs that fit") {
  const campaign::Cost cost{.bytes = 800.0 * 5e6};  // 4 GB
  CHECK_FALSE(campaign::too_large(cost, 5000000, 2, 8.1e9));
  const auto jobs = campaign::too_large(cost, 5000000, 4, 8.1e9);
  REQUIRE(jobs);
  CHECK_THAT(jobs->what, Contains("5000000 spheres of 800 bytes each") &&
                             Contains("4 runs at a time need about 16 GB") && Contains("this machine has 8.1 GB"));
  CHECK_THAT(jobs->remedy, Contains("--jobs 2 at most"));
  const auto alone = campaign::too_large(cost, 5000000, 1, 2e9);
  REQUIRE(alone);
  CHECK_THAT(alone->remedy, Contains("fewer or larger spheres"));
}
