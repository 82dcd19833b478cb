// Plans before anything is measured: they need neither data nor a case, and equal those that ignore data.
#include "uq/plan/unmeasured.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/error.hpp"
#include "tests/uq/formula_study.hpp"
#include "uq/plan/plan.hpp"

namespace {

data::Study without_data() {
  data::Study study = formula::study({}, {}, 1.0);
  study.observations.clear();
  study.cases.clear();
  return study;
}

/// One reading of each output at two speeds, with a stated error.
data::PlanSection readings(double error) {
  data::PlanSection section;
  for (const std::size_t output : {0, 1})
    section.candidates.push_back({.name = {},
                                  .material = {},
                                  .outputs = {output},
                                  .settings = {{0.0, 1.0}},
                                  .error = data::Spread{.absolute = error},
                                  .common_error = {},
                                  .place = {}});
  return section;
}

uq::PlanReport prior_plan(data::Study study, const data::PlanSection& section) {
  study = uq::plan::with_cases(study);
  const std::vector<uq::Emulator> emulators = formula::emulators();
  const uq::SampledCase model = uq::plan::unmeasured_case(study, emulators, 0);
  return uq::plan::make_plan(study, emulators, 0, model, section, {.about = "a", .prior = true, .draws = 800});
}

}  // namespace

TEST_CASE("a plan without data is the plan that ignores them", "[plan]") {
  const data::PlanSection section = readings(0.1);
  const uq::PlanReport without = prior_plan(without_data(), section);
  const uq::PlanReport ignored = prior_plan(formula::study({0.2, 0.7}, {3.0, 400.0}, 0.01), section);
  REQUIRE(without.candidates.size() == 4);
  REQUIRE(ignored.candidates.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(without.candidates[i].name == ignored.candidates[i].name);
    for (std::size_t k = 0; k < 2; ++k)
      CHECK(without.candidates[i].parameters[k].information ==
            Approx(ignored.candidates[i].parameters[k].information).margin(1e-9));
  }
}

TEST_CASE("without data a reading of one unknown teaches what the closed form says", "[plan]") {
  // y = 10 + 5 a + 4 b + 0.3 x (a - b) at x = 0 with b fixed: the information is that of a normal law, ln(1 +
  // s^2/e^2)/2.
  data::Study study = uq::plan::with_cases(without_data());
  study.cases[0].free = {"a"};
  study.cases[0].fixed = {{"b", 0.5}};
  for (data::Parameter& one : study.parameters)
    one.prior = {.kind = data::PriorKind::normal, .low = 0.0, .high = 1.0, .mean = 0.5, .sd = 0.1};
  data::PlanSection section = readings(0.25);
  section.candidates.resize(1);
  section.candidates[0].settings = {{0.0}};
  const uq::PlanReport plan = prior_plan(study, section);
  const uq::PlannedParameter& about = plan.candidates.front().parameters.front();
  CHECK(about.information == Approx(0.5 * std::log(1.0 + 4.0)).margin(2.0 * about.information_error + 0.003));
}

TEST_CASE("without data the error of a setting is in what a reading teaches", "[plan]") {
  // The angle goes with the speed by 2 and with a by 3: a speed known to +- 0.2 adds 0.4 to the reading's error.
  data::Study study = uq::plan::with_cases(without_data());
  study.cases[0].free = {"a"};
  study.cases[0].fixed = {{"b", 0.5}};
  study.controls[0].uncertainty = data::SettingError{.control = 0, .spread = {.absolute = 0.2}};
  for (data::Parameter& one : study.parameters)
    one.prior = {.kind = data::PriorKind::normal, .low = 0.0, .high = 1.0, .mean = 0.5, .sd = 0.1};
  data::PlanSection section = readings(0.1);
  section.candidates.erase(section.candidates.begin());
  section.candidates[0].settings = {{0.5}};
  const uq::PlanReport plan = prior_plan(study, section);
  const uq::PlannedParameter& about = plan.candidates.front().parameters.front();
  CHECK(about.information ==
        Approx(0.5 * std::log(1.0 + 9.0 * 0.01 / (0.01 + 0.16))).margin(2.0 * about.information_error + 0.003));
}

TEST_CASE("a study without cases has one per material, which frees what the material does not fix", "[plan]") {
  data::Study study = without_data();
  study.materials = {{.name = "glass", .fixed = {{"b", 0.3}}, .runs = {}, .place = {}},
                     {.name = "sand", .fixed = {}, .runs = {}, .place = {}}};
  const data::Study wider = uq::plan::with_cases(study);
  REQUIRE(wider.cases.size() == 2);
  CHECK(wider.cases[0].free == std::vector<std::string>{"a"});
  CHECK(wider.cases[1].free == std::vector<std::string>{"a", "b"});
  CHECK(wider.cases[1].material == "sand");
  data::Study of_no_run = wider;
  CHECK_THROWS_AS(uq::plan::unmeasured_case(of_no_run, formula::emulators(), 1), data::InputError);
}
