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

TEST_CASE("a team of more members than any machine has cores ends its passes, full, empty and in a hurry") {
  for (int round = 0; round < 20; ++round) {
    dem::Team team(64);
    std::vector<long> sums(64, 0);  // each item belongs to one member at a time: no atomics
    for (int pass = 0; pass < 100; ++pass) {
      const auto items = static_cast<std::size_t>(pass % 7 == 0 ? 0 : 1 + pass % 64);
      team.for_each(items, [&](std::size_t item) { sums[item] += pass; });
    }
    long sum = 0, expected = 0;
    for (const long each : sums) sum += each;
    for (int pass = 0; pass < 100; ++pass) expected += pass % 7 == 0 ? 0L : long{pass} * (1 + pass % 64);
    REQUIRE(sum == expected);
  }
}
