// What a run costs, measured on a small bed.
#include <catch2/catch.hpp>

#include "dem/bed/derived.hpp"
#include "dem/forecast/effort.hpp"

TEST_CASE("a run's cost is that of spheres which touch, whether anything attracts them or not") {
  dem::Case c;
  c.contact.stiffness = 300.0;
  const double without = dem::measure_effort(c, dem::derive(c)).rate;
  c.contact.hamaker = 9e-18;
  const double with = dem::measure_effort(c, dem::derive(c)).rate;
  // In an open box spheres without attraction flew apart, and three times as many steps seemed to be made.
  CHECK(without < 2.0 * with);
}
