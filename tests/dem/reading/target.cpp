// Quantities of a case by their names.
#include <catch2/catch.hpp>

#include "data/error.hpp"
#include "dem/reading/target.hpp"

TEST_CASE("a quantity is set and read by its full and its short name, and refused out of its range") {
  dem::Case c;
  dem::set_target(c, "friction", 0.25);
  CHECK(dem::get_target(c, "contact.wall_friction") == 0.25);
  dem::set_target(c, "contact.wall_friction", 0.5);
  dem::set_target(c, "friction", 0.3);
  CHECK(dem::get_target(c, "wall_friction") == 0.5);
  CHECK_THROWS_AS(dem::set_target(c, "friction", -1.0), data::InputError);
  CHECK_THROWS_AS(dem::set_target(c, "frikction", 0.1), data::InputError);
  for (const dem::Target& t : dem::targets()) {
    if (!dem::unused_because(c, t.name).empty()) continue;
    const double before = dem::get_target(c, t.name);
    dem::set_target(c, t.name, before);
    CHECK(dem::get_target(c, t.name) == Approx(before));
  }
}
