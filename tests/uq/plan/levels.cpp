// Whether two levels of coarse graining agree on an output: against the difference that formulas have.
#include "uq/plan/levels.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/uq/plan/plans.hpp"
#include "uq/plan/unmeasured.hpp"

using namespace plans;

namespace {

/// Runs of the powder at two enlargements: one angle that the second moves by `shift`, and surrogates of sd `doubt`.
std::vector<uq::Emulator> two_levels(double shift, double doubt) {
  std::vector<uq::Emulator> all = formula::emulators(doubt);
  const formula::Pair other{formula::torque,
                            [shift](double a, double b, double x) { return formula::angle(a, b, x) + shift; }};
  for (uq::Emulator one : formula::emulators(doubt, other)) {
    one.material = "finer";
    all.push_back(std::move(one));
  }
  return all;
}

PlanReport planned(const std::vector<uq::Emulator>& emulators, bool prior = false) {
  uq::plan::PlanOptions options{.about = "a", .prior = prior, .draws = 500};
  options.candidates.coarse_grained = {{"", {"finer"}}};
  data::Study study = one_unknown();
  const data::PlanSection section{.candidates = {reading_of(1, 0.5)}};
  if (!prior) return plan_of(study, emulators, section, options);
  const uq::SampledCase unmeasured = uq::plan::unmeasured_case(study, emulators, 0);
  return uq::plan::make_plan(study, emulators, 0, unmeasured, section, options);
}

}  // namespace

TEST_CASE("an output on which two levels of coarse graining agree counts as the powder's own", "[plan]") {
  // The reading's error is 0.5: the levels differ by shift / 0.5, each surrogate by doubt / 0.5.
  for (const bool prior : {false, true}) {
    const PlanReport agree = planned(two_levels(0.3, 0.2), prior);
    const double expected = std::sqrt(0.3 * 0.3 + 2.0 * 0.2 * 0.2) / 0.5;
    REQUIRE(agree.candidates.front().level_difference);
    CHECK(*agree.candidates.front().level_difference == Approx(expected).epsilon(1e-6));
    CHECK_FALSE(agree.candidates.front().model_only);
  }
  const PlanReport apart = planned(two_levels(0.8, 0.0));
  CHECK(*apart.candidates.front().level_difference == Approx(1.6).epsilon(1e-6));
  CHECK(apart.candidates.front().model_only);
  CHECK_THAT(apart.notes.back(), Catch::Contains("differ by 1.6 of a reading's error"));
}

TEST_CASE("levels that surrogates know too badly, and levels without the output or the setting, do not agree",
          "[plan]") {
  CHECK(planned(two_levels(0.0, 0.4)).candidates.front().model_only);
  std::vector<uq::Emulator> short_reach = two_levels(0.0, 0.0), none = formula::emulators(), fixed = short_reach;
  short_reach.back().control_range[0] = {0.0, 0.2};
  fixed.back().inputs.erase(fixed.back().inputs.begin());
  for (const auto& emulators : {short_reach, none, fixed}) {
    const PlanReport plan = planned(emulators);
    CHECK(plan.candidates.front().model_only);
    CHECK_FALSE(plan.candidates.front().level_difference);
  }
}
