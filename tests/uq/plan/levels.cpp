// Whether two levels of coarse graining agree on an output: against the difference that formulas have.
#include "uq/plan/levels.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

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

PlanReport planned(const std::vector<uq::Emulator>& emulators, bool prior = false,
                   const std::function<void(data::Study&, data::PlanEntry&)>& change = {}) {
  uq::plan::PlanOptions options{.about = "a", .prior = prior, .draws = 500};
  options.candidates.coarse_grained = {{"", {"finer"}}};
  if (emulators.size() > 4) options.candidates.coarse_grained[""].emplace_back("finest");
  data::Study study = one_unknown();
  data::PlanEntry angle = reading_of(1, 0.5);
  if (change) change(study, angle);
  const data::PlanSection section{.candidates = {angle}};
  if (!prior) return plan_of(study, emulators, section, options);
  const uq::SampledCase unmeasured = uq::plan::unmeasured_case(study, emulators, 0);
  return uq::plan::make_plan(study, emulators, 0, unmeasured, section, options);
}

}  // namespace

TEST_CASE("an output on which two levels of coarse graining agree counts as the powder's own", "[plan]") {
  // The reading's error is 0.5: the levels differ by shift / 0.5, known to sqrt(2) doubt / 0.5.
  for (const bool prior : {false, true}) {
    const PlanCandidate agree = planned(two_levels(0.3, 0.2), prior).candidates.front();
    REQUIRE(agree.levels.size() == 1);
    CHECK(*agree.levels[0].difference == Approx(0.6).epsilon(1e-6));
    CHECK(*agree.levels[0].doubt == Approx(std::sqrt(2.0) * 0.4).epsilon(1e-6));
    CHECK_FALSE(agree.model_only);
  }
  const PlanReport apart = planned(two_levels(0.8, 0.0));
  CHECK(*apart.candidates.front().levels[0].difference == Approx(1.6).epsilon(1e-6));
  CHECK(apart.candidates.front().model_only);
  CHECK_THAT(apart.notes.back(), Catch::Contains("'finer' differ by 1.6 of a reading's error; so that it stays"));
}

TEST_CASE("a meter's common error and a discrepancy are no difference between levels", "[plan]") {
  const auto common = [](data::Study&, data::PlanEntry& angle) { angle.common_error = data::Spread{.absolute = 5.0}; };
  const auto discrepancy = [](data::Study& study, data::PlanEntry&) {
    data::Parameter size{.name = "sd", .target = "sd", .low = 0.01, .high = 0.3};
    size.prior = {.low = 0.01, .high = 0.3};
    data::Parameter length = size;
    length.name = length.target = "length";
    study.cases[0].nuisances = {{data::NuisanceKind::discrepancy_sd, {}, size},
                                {data::NuisanceKind::discrepancy_length, {}, length}};
  };
  CHECK_FALSE(planned(two_levels(0.1, 0.0), false, common).candidates.front().model_only);
  CHECK_FALSE(planned(two_levels(0.1, 0.0), false, discrepancy).candidates.front().model_only);
}

TEST_CASE("an output counts as the powder's own only where all levels agree", "[plan]") {
  std::vector<uq::Emulator> three = two_levels(0.1, 0.0);
  for (uq::Emulator one : two_levels(0.8, 0.0))
    if (one.material == "finer") {
      one.material = "finest";
      three.push_back(std::move(one));
    }
  CHECK(planned(three).candidates.front().model_only);
}

TEST_CASE("levels that surrogates know too badly, and levels without the output or the setting, do not agree",
          "[plan]") {
  const PlanReport unsure = planned(two_levels(0.0, 0.4));
  CHECK(unsure.candidates.front().model_only);
  CHECK_THAT(unsure.notes.back(), Catch::Contains("more runs of the two would tell"));
  std::vector<uq::Emulator> short_reach = two_levels(0.0, 0.0), none = formula::emulators(), fixed = short_reach;
  short_reach.back().control_range[0] = {0.0, 0.2};
  fixed.back().inputs.erase(fixed.back().inputs.begin());
  for (const auto& emulators : {short_reach, none, fixed}) {
    const PlanReport plan = planned(emulators);
    CHECK(plan.candidates.front().model_only);
    CHECK_FALSE(plan.candidates.front().levels.at(0).difference);
    CHECK_THAT(plan.notes.back(), Catch::Contains("nothing is compared"));
  }
}
