// Plans on cases whose model is a formula: what teaches, what does not, what comes true.
#include "uq/plan/plan.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "data/error.hpp"
#include "data/random.hpp"
#include "tests/uq/formula_study.hpp"
#include "tests/uq/plan/plans.hpp"
#include "uq/plan/outlook.hpp"
#include "uq/posterior/posterior.hpp"

using namespace plans;

TEST_CASE("what parts two traded parameters is ranked above more of the same", "[plan]") {
  const data::Study study = measured(0.5, 0.5, 0.1, 1);
  const PlanReport plan = plan_of(study, formula::emulators(), {}, {.about = "a"});
  CHECK(plan.candidates.front().outputs == std::vector<std::string>{"angle"});
  CHECK(plan.candidates.front().assumed_error);
  const PlanCandidate &best = plan.candidates.front(), &again = named(plan, "torque at 0");
  CHECK(again.kind == uq::CandidateKind::repeat);
  CHECK(best.parameters[0].information > 5.0 * again.parameters[0].information);
  CHECK(best.parameters[0].sd_after < best.parameters[0].sd_now);
  CHECK_THAT(plan.sentence, Catch::Contains("Measure angle"));
}

TEST_CASE("a reading made again teaches less where the surrogate's error is what is not known", "[plan]") {
  // One unknown a with prior sd s, one reading with the surrogate's error t and noise e: given it, a repeat knows what
  // t was. Information from the covariance of (a, first, second), all normal.
  const double t = 0.5, e = 0.1;
  data::Study study = formula::study({0.5}, {formula::torque(0.5, 0.5, 0.5)}, e);
  study.cases[0].free = {"a"};
  study.cases[0].fixed = {{"b", 0.5}};
  for (data::Parameter& one : study.parameters)
    one.prior = {.kind = data::PriorKind::normal, .low = 0.0, .high = 1.0, .mean = 0.5, .sd = 0.1};
  const double slope = 5.0 + 0.3 * 0.5, s = 0.1;
  const auto left = [&](double readings) {  // variance of a after a mean of so many readings
    const double noise = t * t + e * e / readings;
    return 1.0 / (1.0 / (s * s) + slope * slope / noise);
  };
  const data::PlanSection section{.about = {},
                                  .cost_unit = {},
                                  .candidates = {{.name = "again",
                                                  .material = {},
                                                  .outputs = {0},
                                                  .settings = {{0.5}},
                                                  .error = {},
                                                  .common_error = {},
                                                  .place = {}},
                                                 {.name = "new meter",
                                                  .material = {},
                                                  .outputs = {0},
                                                  .settings = {{0.5}},
                                                  .error = data::Spread{.absolute = e},
                                                  .common_error = {},
                                                  .place = {}}}};
  const PlanReport plan = plan_of(study, formula::emulators(t), section, {.about = "a", .draws = 1000});
  const auto& about = named(plan, "again").parameters[0];
  const double truth = 0.5 * std::log(left(1.0) / left(2.0));
  CHECK(truth < 0.01);
  CHECK(std::abs(about.information - truth) <= about.information_error + 0.005);
}

TEST_CASE("a reading of the same meter shares its common error, whatever else the meter's file holds", "[plan]") {
  // One unknown a with prior sd s, readings with a common offset of sd c and noise e of their own, all normal.
  const double c = 0.3, e = 0.1, s = 0.1, slope = 5.0 + 0.3 * 0.5;
  const auto left = [&](double variance) { return 1.0 / (1.0 / (s * s) + slope * slope / variance); };
  const double truth = 0.5 * std::log(left(c * c + e * e) / left(c * c + e * e / 2.0));
  const formula::Pair pair{formula::torque, [](double, double, double) { return 1.0; }};
  for (const bool named_meter : {false, true})
    for (const bool two_outputs : {false, true}) {
      data::Study study = formula::study({0.5}, {formula::torque(0.5, 0.5, 0.5)}, e);
      study.cases[0].free = {"a"};
      study.cases[0].fixed = {{"b", 0.5}};
      for (data::Parameter& one : study.parameters)
        one.prior = {.kind = data::PriorKind::normal, .low = 0.0, .high = 1.0, .mean = 0.5, .sd = s};
      data::ObservationSet& bench = study.observations[0];
      bench.common_errors = {{0, {.absolute = c}}};
      if (named_meter) bench.meter = "cell";
      if (two_outputs) {
        bench.outputs = {0, 1};
        bench.points[0].values.push_back(1.0);
        bench.points[0].standard_errors.push_back(0.1);
      }
      const PlanReport plan = plan_of(study, formula::emulators(0.0, pair), {}, {.about = "a", .draws = 1000});
      const auto& about = named(plan, "torque at 0.5").parameters[0];
      INFO("named " << named_meter << ", two outputs " << two_outputs);
      CAPTURE(about.information, about.information_error, truth);
      CHECK(std::abs(about.information - truth) <= about.information_error + 0.005);
      CHECK(about.information < 0.1);
    }
}

TEST_CASE(
    "a candidate that names a meter of the observations has its common error, however many outputs the case reads",
    "[plan]") {
  // a normal; torque known with noise e; the angle, 3 a at b = 1/2, read by a camera with a common error c.
  const double c = 0.2, e = 0.1, s = 0.1, slope = 5.0 + 0.3 * 0.5, of_angle = 3.0;
  for (const bool two_outputs : {false, true}) {
    data::Study study = formula::study({0.5}, {formula::torque(0.5, 0.5, 0.5)}, e);
    study.cases[0].free = {"a"};
    study.cases[0].fixed = {{"b", 0.5}};
    for (data::Parameter& one : study.parameters)
      one.prior = {.kind = data::PriorKind::normal, .low = 0.0, .high = 1.0, .mean = 0.5, .sd = s};
    if (two_outputs) {  // a second one that tells nothing
      data::ObservationSet& bench = study.observations[0];
      bench.outputs = {0, 1};
      bench.points[0].values.push_back(formula::angle(0.5, 0.5, 0.5));
      bench.points[0].standard_errors.push_back(1e3);
    }
    study.observations.push_back(
        {.name = "elsewhere", .outputs = {1}, .meter = "camera", .common_errors = {{1, {.absolute = c}}}});
    const data::PlanSection section{.about = {},
                                    .cost_unit = {},
                                    .candidates = {{.name = "picture",
                                                    .material = {},
                                                    .outputs = {1},
                                                    .settings = {{0.5}},
                                                    .error = data::Spread{.absolute = e},
                                                    .common_error = {},
                                                    .meter = "camera",
                                                    .place = {}}}};
    const PlanReport plan = plan_of(study, formula::emulators(), section, {.about = "a", .draws = 1000});
    const double known = 1.0 / (1.0 / (s * s) + slope * slope / (e * e));
    const double truth = 0.5 * std::log(1.0 + of_angle * of_angle * known / (c * c + e * e));
    const auto& about = named(plan, "picture").parameters[0];
    CAPTURE(two_outputs, about.information, about.information_error, truth);
    CHECK(std::abs(about.information - truth) <= about.information_error + 0.002);
  }
}

TEST_CASE("the readings needed for a word have a range, and are no fewer than the width asks for", "[plan]") {
  // One unknown a, uniform on 0 to 1, one reading of error e. "identified" asks for a tenth of the prior's variance, so
  // for 1 + n readings with e / (slope sqrt(1 + n)) at most sqrt(1/120).
  const double e = 1.0, slope = 5.0 + 0.3 * 0.5;
  data::Study study = formula::study({0.5}, {formula::torque(0.5, 0.5, 0.5)}, e);
  study.cases[0].free = {"a"};
  study.cases[0].fixed = {{"b", 0.5}};
  const PlanReport plan = plan_of(study, formula::emulators(), {}, {.about = "a"});
  const auto& about = named(plan, "torque at 0.5").parameters[0];
  REQUIRE(about.repeats_needed);
  REQUIRE(about.repeats_low);
  CAPTURE(*about.repeats_low, *about.repeats_needed, about.repeats_high.value_or(-1));
  CHECK(*about.repeats_needed >= std::ceil(std::pow(e / slope, 2) * 120.0 - 1.0));
  CHECK(*about.repeats_low <= *about.repeats_needed);
  CHECK(about.repeats_high.value_or(1025) >= *about.repeats_needed);
}

TEST_CASE("before any measurement the information is that of the prior", "[plan]") {
  const data::Study study = measured(0.5, 0.5, 0.1, 2);
  const PlanReport plan = plan_of(study, formula::emulators(), {}, {.about = "a", .prior = true});
  CHECK(plan.prior);
  const PlanCandidate& torque = named(plan, "torque at 0.5");
  // y = 5.15 a + 3.85 b + e: by quadrature of the sum of two uniforms and a normal.
  const double sd = 0.1, wide = 5.15, narrow = 3.85;
  const auto entropy = [&](auto density, double low, double high) {
    double sum = 0.0;
    const int cells = 20000;
    for (int i = 0; i < cells; ++i) {
      const double p = density(low + (high - low) * (i + 0.5) / cells);
      if (p > 0.0) sum -= p * std::log(p) * (high - low) / cells;
    }
    return sum;
  };
  const auto below = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
  const auto of_narrow = [&](double y) { return (below(y / sd) - below((y - narrow) / sd)) / narrow; };
  const auto of_both = [&](double y) {
    double sum = 0.0;
    const int cells = 400;
    for (int i = 0; i < cells; ++i) sum += of_narrow(y - wide * (i + 0.5) / cells) / cells;
    return sum;
  };
  const double truth = entropy(of_both, -1.0, 10.0) - entropy(of_narrow, -1.0, 5.0);
  // The error of a reading is stated in per cent of the torque at the prior's mean, 14.5, from a median reading.
  CHECK(torque.parameters[0].information == Approx(truth).margin(0.03));
}

TEST_CASE("two readings together are worth at least the better of them, and no less than picked one by one", "[plan]") {
  const data::Study study = measured(0.5, 0.5, 0.1, 3);
  const PlanReport plan = plan_of(study, formula::emulators(), {}, {.about = "a", .batch = 2, .draws = 600});
  REQUIRE(plan.batches.size() == 1);
  const uq::PlanBatch& batch = plan.batches.front();
  CHECK(batch.candidates.size() == 2);
  CHECK(batch.information + batch.information_error > plan.candidates.front().parameters[0].information);
  CHECK(batch.information >= batch.greedy);
}

TEST_CASE("candidates cost what the study says, and none is above the budget", "[plan]") {
  const data::Study study = measured(0.5, 0.5, 0.1, 4);
  const data::PlanSection section{.about = "a",
                                  .cost_unit = "h",
                                  .candidates = {{.name = "dear",
                                                  .material = {},
                                                  .outputs = {1},
                                                  .settings = {{0.5}},
                                                  .error = data::Spread{.relative = 0.02},
                                                  .common_error = {},
                                                  .cost = 100.0,
                                                  .place = {}},
                                                 {.name = "cheap",
                                                  .material = {},
                                                  .outputs = {1},
                                                  .settings = {{0.5}},
                                                  .error = data::Spread{.relative = 0.03},
                                                  .common_error = {},
                                                  .cost = 1.0,
                                                  .place = {}}}};
  const PlanReport both = plan_of(study, formula::emulators(), section, {.draws = 600});
  CHECK(both.candidates.front().name == "cheap");
  CHECK(named(both, "dear").parameters[0].information > both.candidates.front().parameters[0].information);
  const PlanReport poor = plan_of(study, formula::emulators(), section, {.budget = 10.0, .draws = 600});
  CHECK(poor.candidates.size() == 1);
}

TEST_CASE("nobody is sent to measure for a parameter that no candidate teaches of", "[plan]") {
  // Nothing changes with b, so that b is known least; the data leave a to +- 0.03, and a repeat narrows that.
  const formula::Pair of_a{[](double a, double, double) { return 10.0 + 5.0 * a; },
                           [](double a, double, double) { return 10.0 + 3.0 * a; }};
  const data::Study study = formula::study({0.5}, {12.5}, 0.2);
  const data::PlanSection section{.candidates = {reading_of(0, 0.2), reading_of(1, 0.2)}};
  const PlanReport open = plan_of(study, formula::emulators(0.0, of_a), section, {});
  CHECK(open.about == "a");
  CHECK(open.candidates.front().teaches);
  CHECK_THAT(open.notes.front(),
             Catch::Contains("No candidate teaches anything of b") && Catch::Contains("asks about a"));
  const PlanReport stated = plan_of(study, formula::emulators(0.0, of_a), section, {.about = "b"});
  CHECK(stated.about == "b");
  CHECK_FALSE(stated.candidates.front().teaches);
  CHECK_THAT(stated.sentence, Catch::Contains("No candidate teaches anything of b") &&
                                  Catch::Contains("a can be learnt") && Catch::Contains("--about a plans for it"));
  CHECK_THAT(stated.candidates.front().parameters[1].floor, Catch::Contains("neither it nor the data change"));
}

TEST_CASE("a plan that cannot be is refused with its place and remedy", "[plan]") {
  const data::Study study = measured(0.5, 0.5, 0.1, 5);
  const auto entry = [](std::size_t output, double speed, std::optional<data::Spread> error) {
    return data::PlanSection{.about = {},
                             .cost_unit = {},
                             .candidates = {{.name = {},
                                             .material = {},
                                             .outputs = {output},
                                             .settings = {{speed}},
                                             .error = error,
                                             .common_error = {},
                                             .place = "study.toml:40: plan.candidates"}}};
  };
  CHECK_THROWS_WITH(plan_of(study, formula::emulators(), entry(1, 0.5, {}), {}), Catch::Contains("no error of angle"));
  CHECK_THROWS_WITH(plan_of(study, formula::emulators(), entry(0, 1.5, {}), {}), Catch::Contains("outside the runs"));
  CHECK_THROWS_WITH(plan_of(study, {formula::emulators()[0]}, entry(1, 0.5, data::Spread{.relative = 0.1}), {}),
                    Catch::Contains("there are no runs"));
  CHECK_THROWS_WITH(plan_of(study, formula::emulators(), {}, {.about = "c"}), Catch::Contains("no free parameter 'c'"));
  data::Study misfit = study;
  misfit.observations[0].points[0].values[0] += 10.0;
  CHECK_THROWS_WITH(plan_of(misfit, formula::emulators(), {}, {}), Catch::Contains("does not fit"));
}

TEST_CASE("a narrow prior takes part in the words that a plan forecasts", "[plan]") {
  // The prior's sd is 0.5 in torque. A reading of sd 1.3 and one of 0.4 leave a contraction of 0.6.
  data::Study study = one_unknown();
  study.observations[0].points[0].standard_errors = {1.3};
  const PlanReport plan = plan_of(study, formula::emulators(), {.candidates = {reading_of(0, 0.4)}}, {.about = "a"});
  const PlanCandidate& next = plan.candidates.front();
  const double left = next.parameters[0].sd_after / 0.1;
  CHECK(1.0 - left * left == Approx(0.6).margin(0.05));
  CHECK(chance(next, 0, uq::Verdict::identified) == 0.0);
}

TEST_CASE("a batch within a budget is found where the best single reading would take all of it", "[plan]") {
  const data::Study study = one_unknown();
  data::PlanEntry dear = reading_of(1, 0.30), cheap = reading_of(1, 0.32);
  dear.name = "dear";
  dear.cost = 10.0;
  cheap.cost = 2.0;
  const PlanReport plan =
      plan_of(study, formula::emulators(), {.candidates = {dear, cheap}}, {.about = "a", .budget = 10.0, .batch = 3});
  REQUIRE(plan.batches.size() == 2);
  CHECK(plan.batches[1].candidates == std::vector<std::string>{"next", "next", "next"});
  CHECK(plan.batches[1].cost == 6.0);
}

TEST_CASE("a plan for a case of a cut parameter is refused", "[plan]") {
  const data::Study study = one_unknown();
  const std::vector<uq::Emulator> emulators = formula::emulators();
  uq::SampledCase sampled = uq::sample_case(study, emulators, 0, {.seed = 1});
  uq::CaseModel model = *sampled.model;
  model.unknowns[0].cut_from = "other";
  sampled.model = std::make_shared<const uq::CaseModel>(model);
  CHECK_THROWS_WITH(uq::plan::make_plan(study, emulators, 0, sampled, {}, {}),
                    Catch::Contains("takes a cut from case 'other'") && Catch::Contains("plan for case 'other'"));
}

TEST_CASE("widths and words that a plan forecasts come true", "[plan][slow]") {
  // Closed loops: a truth from the prior, three torques, a plan, its first choice read at the truth, and all again.
  constexpr int loops = 60;
  double expected = 0.0, found = 0.0, brier = 0.0, base = 0.0;
  std::vector<double> chances, outcomes;
  for (int loop = 0; loop < loops; ++loop) {
    data::RandomStream random(20261127, data::Purpose::test, static_cast<std::uint32_t>(loop));
    const double a = random.uniform(), b = random.uniform();
    data::Study study = measured(a, b, 0.15, 1000 + static_cast<std::uint32_t>(loop));
    const data::PlanSection section{.about = "a",
                                    .cost_unit = {},
                                    .candidates = {{.name = "angle",
                                                    .material = {},
                                                    .outputs = {1},
                                                    .settings = {{0.5}},
                                                    .error = data::Spread{.absolute = 0.8},
                                                    .common_error = {},
                                                    .place = {}}}};
    const PlanReport plan = plan_of(study, formula::emulators(), section, {.draws = 500});
    const PlanCandidate& first = plan.candidates.front();
    data::ObservationSet more{.name = "more", .file = "more.csv", .outputs = {1}};
    more.points.push_back({.controls = {0.5},
                           .values = {formula::angle(a, b, 0.5) + 0.8 * random.normal()},
                           .standard_errors = {0.8},
                           .line = 2});
    study.observations.push_back(more);
    study.cases[0].observe.push_back("more");
    const uq::SampledCase after = uq::sample_case(study, formula::emulators(), 0, {.seed = 1});
    const uq::Identification told = uq::identify(*after.model, after.draws.pooled());
    expected += first.parameters[0].sd_after;
    found += told.parameters[0].sd;
    chances.push_back(chance(first, 0, uq::Verdict::identified) + chance(first, 0, uq::Verdict::weakly_identified));
    outcomes.push_back(told.parameters[0].verdict == uq::Verdict::identified ||
                               told.parameters[0].verdict == uq::Verdict::weakly_identified
                           ? 1.0
                           : 0.0);
  }
  double rate = 0.0, mean_chance = 0.0;
  for (const double outcome : outcomes) rate += outcome / loops;
  for (std::size_t i = 0; i < chances.size(); ++i) {
    brier += std::pow(chances[i] - outcomes[i], 2) / loops;
    base += std::pow(rate - outcomes[i], 2) / loops;
    mean_chance += chances[i] / loops;
  }
  WARN("sd expected " << expected / loops << ", found " << found / loops << "; a word forecast with " << mean_chance
                      << " came in " << rate << "; Brier " << brier << ", of the base rate " << base);
  CHECK(found == Approx(expected).epsilon(0.1));
  CHECK(mean_chance == Approx(rate).margin(0.12));
  CHECK(brier < base + 0.02);
}

namespace {

/// Dakota's regression test of its Bayesian experimental design (test/dakota_bayes_expdesign, its second set of
/// settings): a quadratic A x^2 + B x + C stands in for a heated rod, of which two temperatures are known; where to
/// take the third?
constexpr double rod_x[] = {10.581408334, 68.993623252}, rod_y[] = {94.604886616, 25.878269041};

data::Study heated_rod(double sd) {
  data::Study made;
  made.name = "rod";
  made.file = "study.toml";
  for (const auto& [name, low, high] : {std::tuple{"A", 0.0, 0.06}, {"B", -8.0, 0.0}, {"C", 0.0, 260.0}}) {
    data::Parameter parameter{.name = name, .target = name, .low = low, .high = high};
    parameter.prior.low = low;
    parameter.prior.high = high;
    made.parameters.push_back(parameter);
  }
  made.controls.push_back({.name = "x", .target = "x", .low = 10.0, .high = 70.0});
  data::Output temperature;
  temperature.name = "temperature";
  made.outputs.push_back(temperature);
  made.materials.emplace_back();
  data::ObservationSet rod{.name = "rod", .file = "rod.csv", .outputs = {0}};
  for (int i = 0; i < 2; ++i)
    rod.points.push_back({.controls = {rod_x[i]}, .values = {rod_y[i]}, .standard_errors = {sd}, .line = i + 2});
  made.observations.push_back(rod);
  data::CalibrationCase one;
  one.name = "coefficients";
  one.observe = {"rod"};
  one.free = {"A", "B", "C"};
  made.cases.push_back(one);
  return made;
}

std::vector<uq::Emulator> quadratic() {
  uq::Emulator one{.material = "",
                   .output = 0,
                   .inputs = {{uq::InputKind::parameter, 0},
                              {uq::InputKind::parameter, 1},
                              {uq::InputKind::parameter, 2},
                              {uq::InputKind::control, 0}},
                   .constants = {},
                   .control_range = {{0, {10.0, 70.0}}},
                   .predict = {}};
  one.predict = [](const Eigen::MatrixXd& u) -> surrogate::Prediction {
    const Eigen::ArrayXd x = 10.0 + 60.0 * u.col(3).array();
    return {.mean = 0.06 * u.col(0).array() * x * x + (8.0 * u.col(1).array() - 8.0) * x + 260.0 * u.col(2).array(),
            .covariance = Eigen::MatrixXd::Zero(u.rows(), u.rows())};
  };
  return {one};
}

/// Information of a reading at x, with errors of `sd`: given A, the two temperatures fix B and C but for their errors,
/// so that A is uniform and the reading the sum of a uniform and a normal number. By quadrature of its entropy.
double rod_information(double x, double sd) {
  const double w = (x - rod_x[0]) / (rod_x[1] - rod_x[0]);
  const double width = 0.06 * std::abs((x - rod_x[0]) * (x - rod_x[1]));
  const double spread = sd * std::sqrt(1.0 + w * w + (1.0 - w) * (1.0 - w));
  const auto below = [&](double y) { return 0.5 * std::erfc(-y / (spread * std::sqrt(2.0))); };
  const double low = -8.0 * spread, high = width + 8.0 * spread;
  const int cells = 20000;
  double entropy = 0.0;
  for (int i = 0; i < cells; ++i) {
    const double y = low + (high - low) * (i + 0.5) / cells;
    const double p = (below(y) - below(y - width)) / width;
    if (p > 0.0) entropy -= p * std::log(p) * (high - low) / cells;
  }
  return entropy - 0.5 * std::log(2.0 * M_PI * std::exp(1.0) * sd * sd);
}

}  // namespace

TEST_CASE("of Dakota's heated rod the reading in the middle teaches most, by as much as quadrature says", "[plan]") {
  const double sd = 1.0;
  const std::vector<double> places = {20.0, 40.0, 60.0};
  const data::PlanSection section{.about = {},
                                  .cost_unit = {},
                                  .candidates = {{.name = "third",
                                                  .material = {},
                                                  .outputs = {0},
                                                  .settings = {places},
                                                  .error = data::Spread{.absolute = sd},
                                                  .common_error = {},
                                                  .place = {}}}};
  const PlanReport plan = plan_of(heated_rod(sd), quadratic(), section, {.about = "A"});
  CHECK(plan.candidates.front().settings.front().at("x") == Approx(40.0));
  for (const PlanCandidate& one : plan.candidates) {
    const double x = one.settings.front().at("x"), truth = rod_information(x, sd);
    CAPTURE(x, truth, one.information, one.information_error);
    CHECK(std::abs(one.information - truth) <= one.information_error + 0.01);
  }
}

TEST_CASE("without a budget a batch is the best per cost, as single candidates are ranked", "[plan]") {
  // The dear reading teaches more than two cheap ones, and costs twenty of them.
  const data::Study study = one_unknown();
  data::PlanEntry dear = reading_of(1, 0.05), cheap = reading_of(1, 0.12);
  dear.name = "dear";
  dear.cost = 20.0;
  const PlanReport plan =
      plan_of(study, formula::emulators(), {.candidates = {dear, cheap}}, {.about = "a", .batch = 2});
  REQUIRE(plan.batches.size() == 1);
  CHECK(plan.batches[0].candidates == std::vector<std::string>{"next", "next"});
  CHECK(plan.batches[0].information < named(plan, "dear").parameters[0].information);
}

namespace {

/// a and b with normal priors of sd 0.1 about 0.5.
data::Study two_normal() {
  data::Study study = measured(0.5, 0.5, 0.15, 1);
  for (data::Parameter& one : study.parameters)
    one.prior = {.kind = data::PriorKind::normal, .low = 0.0, .high = 1.0, .mean = 0.5, .sd = 0.1};
  return study;
}

/// What these readings at speed 0.5, torques or angles of one sd, teach of a, from the normal law.
double taught_of_a(const std::vector<std::string>& readings, double sd) {
  Eigen::Matrix2d precision = Eigen::Matrix2d::Identity() * 100.0;
  for (const std::string& one : readings) {
    const Eigen::Vector2d slope = one == "angle" ? Eigen::Vector2d(3.0, -3.0) : Eigen::Vector2d(5.15, 3.85);
    precision += slope * slope.transpose() / (sd * sd);
  }
  return 0.5 * std::log(0.01 / precision.inverse()(0, 0));
}

}  // namespace

TEST_CASE("before any measurement the stated error of a batch's information holds what the normal law says",
          "[plan][slow]") {
  constexpr int seeds = 20;
  constexpr double sd = 0.1;
  data::PlanEntry torque = reading_of(0, sd), angle = reading_of(1, sd);
  torque.name = "torque";
  angle.name = "angle";
  const data::Study study = two_normal();
  const std::vector<uq::Emulator> emulators = formula::emulators();
  const uq::SampledCase sampled = uq::sample_case(study, emulators, 0, {.seed = 1});
  std::vector<int> held(2, 0);
  double largest = 0.0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const PlanReport plan = uq::plan::make_plan(study, emulators, 0, sampled, {.candidates = {torque, angle}},
                                                {.about = "a", .batch = 3, .prior = true, .draws = 1000, .seed = seed});
    REQUIRE(plan.batches.size() == 2);
    for (std::size_t k = 0; k < held.size(); ++k) {
      const double off = plan.batches[k].information - taught_of_a(plan.batches[k].candidates, sd);
      held[k] += std::abs(off) <= plan.batches[k].information_error ? 1 : 0;
      largest = std::max(largest, std::abs(off));
    }
  }
  INFO("two readings " << held[0] << ", three " << held[1] << " of " << seeds << ", largest " << largest);
  CHECK(held[0] >= 17);
  CHECK(held[1] >= 17);
  CHECK(largest < 0.04);
}
