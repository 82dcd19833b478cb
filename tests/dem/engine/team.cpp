// The team of threads between parallel passes.
#include <atomic>
#include <catch2/catch.hpp>
#include <vector>

#include "dem/engine/team.hpp"

TEST_CASE("a team calls each item once in every pass, however many members and items") {
  for (const int members : {1, 2, 5}) {
    dem::Team team(members);
    std::vector<std::atomic<int>> calls(37);
    int expected = 0;
    for (int pass = 0; pass < 200; ++pass) {
      const std::size_t items = pass % 3 == 0 ? calls.size() : static_cast<std::size_t>(pass % 3);
      team.for_each(items, [&](std::size_t item) { ++calls[item]; });
      expected += pass % 3 == 0 ? 1 : 0;
    }
    CHECK(calls[36] == expected);
    CHECK(calls[0] == 200);
  }
}

TEST_CASE("what a team has written in one pass it reads in the next") {
  dem::Team team(3);
  std::vector<long> now(64, 1), next(64);
  for (int pass = 0; pass < 20; ++pass) {
    team.for_each(64, [&](std::size_t i) { next[i] = now[(i + 1) % 64] + now[(i + 63) % 64]; });
    team.for_each(64, [&](std::size_t i) { now[i] = next[i]; });
  }
  for (const long n : now) REQUIRE(n == 1L << 20);
}
