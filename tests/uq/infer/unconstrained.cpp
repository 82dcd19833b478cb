// Bounded coordinates on the whole line, against differences of the map itself.
#include "uq/infer/unconstrained.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "data/random.hpp"

using namespace uq;

namespace {

/// One coordinate of each kind: two ends, a low one, a high one, none.
struct Slanted {
  int dimension() const { return 4; }
  double log_density(const Eigen::VectorXd& x) const { return x[0] - 2.0 * x[1] + 0.5 * x[2] - 0.3 * x[3] * x[3]; }
  Evaluation log_density_gradient(const Eigen::VectorXd& x) const {
    return {.value = log_density(x), .gradient = Eigen::Vector4d(1.0, -2.0, 0.5, -0.6 * x[3])};
  }
};

Target slanted() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Reference reference{.draw = [](data::RandomStream& random) -> Eigen::VectorXd {
    return Eigen::Vector4d(random.uniform(2.0, 5.0), 1.0 + random.uniform(), 3.0 - random.uniform(), random.normal());
  }};
  return make_target(Slanted{}, Eigen::Vector4d(2.0, 1.0, -infinity, -infinity),
                     Eigen::Vector4d(5.0, infinity, 3.0, infinity), reference);
}

}  // namespace

TEST_CASE("a target on the whole line has the density times the map's derivative, and its gradient", "[uq]") {
  const Target bounded = slanted(), whole = unconstrained_target(bounded);
  CHECK_FALSE(whole.lower.array().isFinite().any());
  data::RandomStream random(1, data::Purpose::sampler);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd z = whole.reference.draw(random), x = from_unconstrained(bounded, z);
    CHECK(bounded.contains(x));
    CHECK((to_unconstrained(bounded, x) - z).norm() < 1e-9);
    double log_slopes = 0.0;
    constexpr double step = 1e-5;
    Eigen::VectorXd gradient(4);
    for (int k = 0; k < 4; ++k) {
      const Eigen::VectorXd d = step * Eigen::VectorXd::Unit(4, k);
      log_slopes += std::log(std::abs(from_unconstrained(bounded, z + d)[k] - from_unconstrained(bounded, z - d)[k]) /
                             (2.0 * step));
      gradient[k] = (whole.log_density(z + d) - whole.log_density(z - d)) / (2.0 * step);
    }
    CHECK(whole.log_density(z) == Approx(bounded.log_density(x) + log_slopes).margin(1e-7));
    CHECK((whole.log_density_gradient(z).gradient - gradient).norm() < 1e-6);
    CHECK(whole.log_densities(z.transpose())[0] == Approx(whole.log_density(z)).margin(1e-12));
  }
}
