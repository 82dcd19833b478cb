// Readings of one setting that agree too well to be independent, made with errors that are known.
#include "data/repeats.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"

namespace {

constexpr double stated = 0.2;

/// Six settings of ten readings of 10, whose errors are `shared` at a setting and `own` of each.
data::ObservationSet readings(double shared, double own, std::uint64_t seed) {
  data::RandomStream random(seed, data::Purpose::test);
  data::ObservationSet set{.name = "bench", .outputs = {0, 1}};
  for (const double speed : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
    const double common = shared * random.normal();
    for (int i = 0; i < 10; ++i)
      set.points.push_back({.controls = {speed},
                            .values = {10.0 + common + own * random.normal(), 5.0 + stated * random.normal()},
                            .standard_errors = {stated, stated}});
  }
  return set;
}

data::ObservationSet averaged(data::ObservationSet set, const data::Study& study = {}) {
  data::average_shared_errors(set, study);
  return set;
}

}  // namespace

TEST_CASE("repeats that share their error count as one reading, and the other outputs as all of theirs") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const data::ObservationSet set = averaged(readings(stated, 0.1 * stated, seed));
    REQUIRE(set.points.size() == 6);
    REQUIRE(set.repeats.size() == 1);
    CHECK(set.repeats[0].output == 0);
    CHECK(set.repeats[0].readings == 60);
    CHECK(set.repeats[0].settings == 6);
    CHECK(set.repeats[0].scatter == Approx(0.1).epsilon(0.3));
    for (const data::Observation& point : set.points) {
      CHECK(point.standard_errors[0] == Approx(stated));
      CHECK(std::abs(point.values[0] - 10.0) < 4.0 * stated);
      CHECK(point.standard_errors[1] == Approx(stated / std::sqrt(10.0)));
      CHECK(std::abs(point.values[1] - 5.0) < 4.0 * stated / std::sqrt(10.0));
    }
  }
}

TEST_CASE("independent repeats are left as they are, also where their errors are stated somewhat too large") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CHECK(averaged(readings(0.0, stated, seed)).repeats.empty());
    CHECK(averaged(readings(0.0, 0.7 * stated, seed)).points.size() == 60);
  }
}

TEST_CASE("readings whose errors are estimated, and those without a partner, are left as they are") {
  data::Study study;
  study.cases.push_back({.name = "powder", .observe = {"bench"}});
  study.cases[0].nuisances.push_back({.kind = data::NuisanceKind::noise_sd, .output = {}, .parameter = {}});
  CHECK(averaged(readings(stated, 0.1 * stated, 1), study).points.size() == 60);
  data::ObservationSet alone = readings(stated, 0.1 * stated, 1);
  for (std::size_t i = 0; i < alone.points.size(); ++i) alone.points[i].controls[0] = static_cast<double>(i);
  CHECK(averaged(alone).points.size() == 60);
}

TEST_CASE("a partner that lacks an output does not count for it") {
  data::ObservationSet set = readings(stated, 0.01 * stated, 2);
  for (std::size_t i = 0; i < set.points.size(); ++i)
    if (i % 10 != 0) set.points[i].values[1] = set.points[i].standard_errors[1] = std::nan("");
  const data::ObservationSet found = averaged(set);
  REQUIRE(found.points.size() == 6);
  for (const data::Observation& point : found.points) CHECK(point.standard_errors[1] == stated);
}
