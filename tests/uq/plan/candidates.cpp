// Candidates that a plan makes itself.
#include "uq/plan/candidates.hpp"

#include "tests/uq/plan/plans.hpp"

using namespace plans;

namespace {

/// The error with which a repeat at speed 0.5 is judged, the readings having these values and errors.
std::string error_of_repeat(const std::vector<double>& values, const std::vector<double>& errors) {
  data::Study study = formula::study({0.0, 0.5, 1.0}, values, 0.1);
  for (std::size_t i = 0; i < errors.size(); ++i) study.observations[0].points[i].standard_errors[0] = errors[i];
  return named(plan_of(study, formula::emulators(), {}, {.about = "a"}), "torque at 0.5").error;
}

}  // namespace

TEST_CASE("a planned reading has the measured ones' error: of a fixed size, or a share of the value", "[plan]") {
  const std::vector<double> values{14.0, 15.0, 18.0};
  CHECK(error_of_repeat(values, {0.2, 0.2, 0.2}) == "0.2");
  CHECK(error_of_repeat(values, {0.14, 0.15, 0.18}) == "1 %");
  // A value near zero has an error of a size, and no share.
  CHECK(error_of_repeat({14.0, 0.0, 18.0}, {0.2, 0.2, 0.2}) == "0.2");
}
