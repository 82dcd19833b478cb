// Candidates that a plan makes itself.
#include "uq/plan/candidates.hpp"

#include <memory>

#include "surrogate/design.hpp"
#include "tests/uq/plan/plans.hpp"

using namespace plans;

namespace {

/// The error with which a repeat at speed 0.5 is judged, the readings lying on the model and having these errors.
std::string error_of_repeat(double scale, const std::vector<double>& errors) {
  const std::vector<double> speeds{0.0, 0.5, 1.0};
  std::vector<double> values;
  for (const double x : speeds) values.push_back(formula::torque(0.2, 0.9, scale * x));
  data::Study study = formula::study(speeds, values, 0.1);
  for (std::size_t i = 0; i < errors.size(); ++i) study.observations[0].points[i].standard_errors[0] = errors[i];
  const formula::Pair stretched{[scale](double a, double b, double x) { return formula::torque(a, b, scale * x); },
                                formula::angle};
  return named(plan_of(study, formula::emulators(0.0, stretched), {}, {.about = "a"}), "torque at 0.5").error;
}

}  // namespace

TEST_CASE("a planned reading has the measured ones' error: of a fixed size, or a share of the value", "[plan]") {
  // At a = 0.2, b = 0.9 the torque is 14.6 - 0.21 x.
  CHECK(error_of_repeat(20.0, {0.2, 0.2, 0.2}) == "0.2");
  CHECK(error_of_repeat(20.0, {0.146, 0.125, 0.104}) == "1 %");
  // 14.6, 0 and -14.6: a value near zero has an error of a size, and no share.
  CHECK(error_of_repeat(14.6 / 0.105, {0.2, 0.2, 0.2}) == "0.2");
}

TEST_CASE("a candidate where no run speaks comes last, and is no part of a batch", "[plan]") {
  auto emulators = formula::emulators(0.0);
  auto cloud = std::make_shared<uq::RunCloud>();
  cloud->points = surrogate::scrambled_sobol(80, 3, 1, 0);
  for (double& speed : cloud->points.col(2)) speed = speed < 0.6 ? speed : 0.9 + 0.25 * (speed - 0.6);
  cloud->length_scales = Eigen::Vector3d::Ones();
  cloud->prior_variance = 100.0;
  for (uq::Emulator& one : emulators) one.runs = cloud;
  for (const bool prior : {false, true}) {
    const PlanReport plan =
        plan_of(measured(0.4, 0.6, 0.1, 1), emulators, {}, {.about = "a", .batch = 2, .prior = prior});
    CHECK(named(plan, "torque at 0.75").no_runs);  // amid the gap from 0.6 to 0.9
    CHECK_FALSE(named(plan, "torque at 0.25").no_runs);
    CHECK(std::is_partitioned(plan.candidates.begin(), plan.candidates.end(),
                              [](const PlanCandidate& one) { return !one.doubtful(); }));
    for (const uq::PlanBatch& batch : plan.batches)
      for (const std::string& name : batch.candidates) CHECK_FALSE(named(plan, name).no_runs);
    CHECK(std::any_of(plan.notes.begin(), plan.notes.end(),
                      [](const std::string& note) { return note.starts_with("No run speaks"); }));
  }
}
