#include "uq/calibrate/effort.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/error.hpp"

using Catch::Contains;

namespace {

/// 5,000 runs and 200 readings of one output.
struct Large {
  data::Study study;
  data::RunTable table;
};

Large large() {
  Large large;
  large.study.file = "study.toml";
  large.study.materials = {{}};
  large.study.outputs.resize(1);
  data::ObservationSet set{.name = "bench"};
  set.outputs = {0};
  for (int i = 0; i < 200; ++i) set.points.push_back({.controls = {1.0 * i}, .values = {1.0}});
  large.study.observations = {set};
  data::CalibrationCase one;
  one.name = "powder";
  one.observe = {"bench"};
  large.study.cases = {one};
  large.table.rows.resize(5000);
  return large;
}

}  // namespace

TEST_CASE("a calibration that takes hours is said before it starts, with what to thin") {
  const Large given = large();
  // (200 x 1000^2 + 200^2 x 1000 + 200^3 / 3) x 2e5 evaluations / 5e9 a second = 9700 s.
  const std::vector<std::string> notes = uq::effort_notes(given.study, given.table, {});
  REQUIRE(notes.size() == 1);
  CHECK_THAT(notes.front(), Contains("200 different readings, each predicted from 1000 runs") &&
                                Contains("about 2.7 h ") && Contains("take 16 % of it ([surrogate] runs_most = 333)") &&
                                Contains("a third of the readings 29 %"));
  // A hundredth is not worth a word.
  CHECK(uq::effort_notes(given.study, given.table, {.runs_most = 100}).empty());
}

TEST_CASE("a surrogate larger than the memory is refused with its estimate and the runs that fit") {
  const Large given = large();
  // 56 x 5000^2 = 1.4 GB.
  CHECK_NOTHROW(uq::effort_notes(given.study, given.table, {.runs_most = 100000}, {.memory = 2e9}));
  try {
    uq::effort_notes(given.study, given.table, {.runs_most = 100000}, {.memory = 1e9});
    FAIL("not refused");
  } catch (const data::InputError& error) {
    CHECK(error.status == data::ExitStatus::bad_study);
    CHECK_THAT(error.what(), Contains("study.toml: [surrogate] runs_most: is 100000") && Contains("5000 runs") &&
                                 Contains("1.4 GB") && Contains("this machine has 1 GB") &&
                                 Contains("lower it to 3700"));
  }
}

TEST_CASE("many different settings take long of few runs, too, and readings of one setting again do not") {
  Large given = large();
  given.table.rows.resize(60);
  std::vector<data::Observation>& points = given.study.observations[0].points;
  points.clear();
  for (int i = 0; i < 400; ++i) points.push_back({.controls = {1.0 * i}, .values = {1.0}});
  CHECK(uq::effort_notes(given.study, given.table, {}).size() == 1);
  for (data::Observation& point : points) point.controls = {std::floor(point.controls[0] / 40.0)};
  CHECK(uq::effort_notes(given.study, given.table, {}).empty());
}
