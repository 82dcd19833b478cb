#pragma once
// Plans of studies whose model is a formula (tests/uq/formula_study.hpp), and what is looked up in them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "data/random.hpp"
#include "tests/uq/formula_study.hpp"
#include "uq/calibrate/calibrate.hpp"
#include "uq/plan/plan.hpp"

namespace plans {

using uq::PlanCandidate;
using uq::PlanReport;

inline data::Study measured(double a, double b, double sd, std::uint32_t index) {
  data::RandomStream random(20261126, data::Purpose::test, index);
  const std::vector<double> speeds = {0.0, 0.5, 1.0};
  std::vector<double> values;
  for (const double x : speeds) values.push_back(formula::torque(a, b, x) + sd * random.normal());
  return formula::study(speeds, values, sd);
}

inline PlanReport plan_of(const data::Study& study, const std::vector<uq::Emulator>& emulators,
                          const data::PlanSection& section, uq::plan::PlanOptions options) {
  options.draws = std::min(options.draws, 1000);
  const uq::SampledCase sampled = uq::sample_case(study, emulators, 0, {.seed = 1});
  return uq::plan::make_plan(study, emulators, 0, sampled, section, options);
}

inline const PlanCandidate& named(const PlanReport& plan, const std::string& name) {
  const auto found = std::find_if(plan.candidates.begin(), plan.candidates.end(),
                                  [&](const PlanCandidate& one) { return one.name == name; });
  INFO(name);
  REQUIRE(found != plan.candidates.end());
  return *found;
}

inline double chance(const PlanCandidate& one, std::size_t parameter, uq::Verdict word) {
  for (const uq::WordProbability& each : one.parameters[parameter].words)
    if (each.verdict == word) return each.probability;
  return 0.0;
}

/// One unknown a with prior sd 0.1, the torque read once with an sd of 0.1.
inline data::Study one_unknown() {
  data::Study study = formula::study({0.5}, {formula::torque(0.5, 0.5, 0.5)}, 0.1);
  study.cases[0].free = {"a"};
  study.cases[0].fixed = {{"b", 0.5}};
  for (data::Parameter& one : study.parameters)
    one.prior = {.kind = data::PriorKind::normal, .low = 0.0, .high = 1.0, .mean = 0.5, .sd = 0.1};
  return study;
}

inline data::PlanEntry reading_of(std::size_t output, double sd) {
  return {.name = "next",
          .material = {},
          .outputs = {output},
          .settings = {{0.5}},
          .error = data::Spread{.absolute = sd},
          .common_error = {},
          .place = {}};
}

/// What an angle of this variance teaches after the torque, all laws normal.
inline double taught_by_angle(double variance) {
  const double slope = 5.0 + 0.3 * 0.5, before = 100.0 + slope * slope / 0.01;
  return 0.5 * std::log(1.0 + 9.0 / variance / before);
}

}  // namespace plans
