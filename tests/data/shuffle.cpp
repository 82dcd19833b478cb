// data/shuffle.hpp
#include "data/shuffle.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <map>
#include <vector>

TEST_CASE("every order of four things comes out equally often", "[data]") {
  data::RandomStream random(11, data::Purpose::test);
  std::map<std::array<int, 4>, int> times;
  const int draws = 24000;
  for (int i = 0; i < draws; ++i) {
    std::array<int, 4> items{0, 1, 2, 3};
    data::shuffle(std::span<int>(items), random);
    ++times[items];
  }
  REQUIRE(times.size() == 24);
  double chi2 = 0.0;
  for (const auto& [order, count] : times) chi2 += (count - 1000.0) * (count - 1000.0) / 1000.0;
  CHECK(chi2 < 49.7);  // 23 degrees of freedom, 0.1 % above (R: qchisq(0.999, 23) = 49.73)
}

TEST_CASE("one thing, or none, stays as it is and draws nothing", "[data]") {
  data::RandomStream random(3, data::Purpose::test), fresh(3, data::Purpose::test);
  std::vector<int> one{7}, none;
  data::shuffle(std::span(one), random);
  data::shuffle(std::span(none), random);
  CHECK(one == std::vector<int>{7});
  CHECK(random() == fresh());
}
