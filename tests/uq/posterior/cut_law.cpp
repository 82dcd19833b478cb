// The law that stands for the data of a case from which an unknown was cut.
#include "uq/posterior/cut_law.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using uq::cut_law;
using uq::CutLaw;

namespace {

/// Draws of normal laws about 0.3 and `other`, half each.
Eigen::VectorXd draws_about(double other, double sd) {
  data::RandomStream random(1, data::Purpose::test, 7);
  Eigen::VectorXd draws(4000);
  for (Eigen::Index i = 0; i < draws.size(); ++i) draws[i] = (i % 2 == 0 ? 0.3 : other) + sd * random.normal();
  return draws;
}

}  // namespace

TEST_CASE("draws of one hill have the normal law of their mean and sd") {
  const CutLaw law = cut_law(draws_about(0.3, 0.02), 1);
  CHECK(law.hills.components.empty());
  CHECK(law.mean == Approx(0.3).margin(0.002));
  CHECK(law.sd == Approx(0.02).epsilon(0.05));
  CHECK(law.log_density(law.mean) == 0.0);
  CHECK(law.log_density(law.mean + 2.0 * law.sd) == Approx(-2.0));
  CHECK(law.precision(0.9) == Approx(std::pow(law.sd, -2)));
}

TEST_CASE("between two hills the law is not likely, where a normal law would be likeliest") {
  const CutLaw law = cut_law(draws_about(0.6, 0.02), 1);
  CHECK(law.hills.components.size() >= 2);
  CHECK(law.log_density(0.3) > -1.0);
  CHECK(law.log_density(0.6) > -1.0);
  CHECK(law.log_density(0.45) < -8.0);
  CHECK(law.precision(0.3) == Approx(std::pow(0.02, -2)).epsilon(0.3));
}

TEST_CASE("the slope is the density's own") {
  for (const double other : {0.3, 0.6}) {
    const CutLaw law = cut_law(draws_about(other, 0.02), 1);
    for (const double u : {0.28, 0.31, 0.45, 0.59}) {
      const double h = 1e-6;
      CHECK(law.slope(u) ==
            Approx((law.log_density(u + h) - law.log_density(u - h)) / (2.0 * h)).epsilon(1e-3).margin(1e-3));
    }
  }
}
