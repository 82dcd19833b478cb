// Systematic resampling: how often a point is drawn.
#include "uq/infer/resample.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

TEST_CASE("a point is drawn as often as its share says, rounded up or down, wherever the draws begin", "[resample]") {
  Eigen::ArrayXd weights(5);
  weights << 0.3, 0.0, 1.2, 2.5, 1e-9;
  for (int step = 0; step < 50; ++step) {
    const double offset = step / 50.0;
    const std::vector<Eigen::Index> kept = uq::resample(weights, 40, offset);
    REQUIRE(kept.size() == 40);
    REQUIRE(std::is_sorted(kept.begin(), kept.end()));
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      const double expected = 40.0 * weights[i] / weights.sum();
      const auto drawn = static_cast<double>(std::count(kept.begin(), kept.end(), i));
      CHECK(std::abs(drawn - expected) < 1.0);
    }
  }
}
