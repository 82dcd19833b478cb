// Words that a plan forecasts where the errors' size is unknown: they go by the widths that are expected.
#include "uq/plan/forecast.hpp"

#include <catch2/catch.hpp>

#include "tests/uq/plan/plans.hpp"

using namespace plans;

TEST_CASE("under errors of unknown size no word is forecast that the expected width forbids", "[plan]") {
  // A line over the speed, read three times near its middle; its slope is b.
  const formula::Pair line{
      [](double a, double b, double x) { return 5.0 + 10.0 * a + (10.0 * b - 5.0) * 2.0 * (x - 0.5); }, formula::angle};
  data::Study study = formula::study({0.2, 0.4, 0.6}, {9.6, 9.5, 11.0}, 0.3);
  data::Parameter noise{.name = "noise", .target = "", .low = 0.1, .high = 10.0, .scale = data::Scale::log};
  noise.prior = {.kind = data::PriorKind::log_normal, .low = 0.1, .high = 10.0, .mean = 1.0, .sd = 1.0};
  data::Parameter sd{.name = "discrepancy_sd", .target = "", .low = 0.0, .high = 0.5};
  sd.prior = {.kind = data::PriorKind::truncated_normal, .low = 0.0, .high = 0.5, .mean = 0.0, .sd = 0.1};
  data::Parameter length{
      .name = "discrepancy_length", .target = "", .low = 0.05, .high = 5.0, .scale = data::Scale::log};
  length.prior = {.kind = data::PriorKind::log_normal, .low = 0.05, .high = 5.0, .mean = 0.5, .sd = 0.7};
  study.cases[0].nuisances = {{data::NuisanceKind::noise_scale, {}, noise},
                              {data::NuisanceKind::discrepancy_sd, {}, sd},
                              {data::NuisanceKind::discrepancy_length, {}, length}};
  data::PlanEntry slow = reading_of(0, 0.3);
  slow.settings = {{0.0}};
  const PlanCandidate next =
      plan_of(study, formula::emulators(0.0, line), {.candidates = {slow}}, {.about = "b"}).candidates.front();
  // Identified asks for a tenth of the prior's variance, 1/12 here.
  const double left = 12.0 * next.parameters[1].sd_after * next.parameters[1].sd_after;
  REQUIRE(left > 0.13);
  CHECK(chance(next, 1, uq::Verdict::identified) < 0.2);
}

TEST_CASE("words go on from what is known of a gain: a parameter that is identified stays so", "[plan]") {
  // The level of a torque tells a but for a gain of 10 %; the other end of its range asks for a gain of a half.
  const formula::Pair level{[](double a, double b, double x) { return 1.0 + 50.0 * a + 0.2 * b * x; }, formula::angle};
  data::Study study = formula::study({0.2, 0.5, 0.8}, {26.0, 26.0, 26.0}, 0.1);
  data::Parameter gain{.name = "gain", .target = "gain", .low = 0.2, .high = 1.8};
  gain.prior = {.kind = data::PriorKind::normal, .low = 0.2, .high = 1.8, .mean = 1.0, .sd = 0.1};
  study.cases[0].nuisances = {{data::NuisanceKind::gain, {}, gain}};
  const PlanCandidate again =
      plan_of(study, formula::emulators(0.0, level), {.candidates = {reading_of(0, 0.1)}}, {.about = "a"})
          .candidates.front();
  CHECK(chance(again, 0, uq::Verdict::identified) > 0.95);
}

TEST_CASE("of separate values what parts them comes first, not what narrows each", "[plan]") {
  // The torque is the same on both sides of a = 0.5; the angle rises with a. A fine torque narrows each value fourfold.
  const formula::Pair mirror{[](double a, double, double) { return 40.0 * (a - 0.5) * (a - 0.5); },
                             [](double a, double, double) { return a; }};
  const data::Study study = formula::study({0.5}, {1.6}, 0.2);
  const data::PlanEntry fine = reading_of(0, 0.04), coarse = reading_of(1, 0.1);
  const PlanReport plan =
      plan_of(study, formula::emulators(0.0, mirror), {.candidates = {fine, coarse}}, {.about = "a"});
  REQUIRE(plan.candidates.size() == 2);
  CHECK(plan.candidates.front().outputs.front() == "angle");
  CHECK(plan.candidates[0].parameters[0].information < plan.candidates[1].parameters[0].information);
  CHECK_THAT(plan.sentence, Catch::Contains("part the values of a"));
}
