// Which setting parts two values that the data leave open.
#include "uq/verdict/modes.hpp"

#include <catch2/catch.hpp>

#include "tests/uq/formula_study.hpp"

using namespace uq;

TEST_CASE("a setting parts two values only beyond what the meter's own errors let through", "[uq]") {
  // At a = 0.3 and 0.7 the torques are as 6.2 to 7.8 at every speed: a gain of a quarter turns one into the other.
  const formula::Pair scaled{[](double a, double, double x) { return (5.0 + 4.0 * a) * (1.0 + x); }, formula::angle};
  data::Study study = formula::study({0.0, 0.5, 1.0}, {7.0, 10.5, 14.0}, 0.05);
  const auto advice = [&] {
    const CaseModel model = build_case(study, formula::emulators(0.0, scaled), 0);
    const auto at = [&](double a) {
      return Mode{.weight = 0.5,
                  .mean = Eigen::Vector2d(a, 0.5),
                  .sd = Eigen::Vector2d(0.01, 0.1),
                  .point = Eigen::Vector2d(a, 0.5)};
    };
    return parted_by(study, model, {at(0.3), at(0.7)});
  };
  CHECK_THAT(advice(), Catch::Contains("measure torque at speed 1"));
  study.observations[0].common_errors = {{.output = 0, .spread = {.absolute = 0.0, .relative = 0.3}}};
  CHECK_THAT(advice(), Catch::Contains("measure another kind of quantity"));
}
