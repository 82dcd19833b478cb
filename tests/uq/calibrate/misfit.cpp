#include "uq/calibrate/misfit.hpp"

#include <catch2/catch.hpp>

using Catch::Matchers::Contains;

TEST_CASE("what a model is farthest from is named, the worst first, and what it fits is not") {
  const auto point = [](std::string output, double observed, double mean, double sd) {
    uq::PredictivePoint p{.output = std::move(output), .unit = "", .mean = mean, .observed = observed};
    p.q05 = mean - 1.6448536 * sd;
    p.q95 = mean + 1.6448536 * sd;
    p.observation_set = "drum";
    return p;
  };
  CHECK(uq::farthest_off({}).empty());
  CHECK(uq::farthest_off({point("angle", 12.0, 10.0, 1.0), point("index", 5.0, 5.1, 0.1)}).empty());
  const std::string text = uq::farthest_off(
      {point("angle", 12.0, 10.0, 1.0), point("torque", 1.5, 1.0, 0.1), point("index", 2.25, 5.1, 0.1)});
  CHECK_THAT(text, Contains("index 2.25 of drum, where the model gives 5.1 (29 sd); torque 1.5 of drum"));
  CHECK_THAT(text, !Contains("angle"));
}
