// A case as text: what decides a run is in it.
#include <catch2/catch.hpp>

#include "dem/reading/target.hpp"

TEST_CASE("two cases have the same settings text only when no setting differs") {
  dem::Case a, b;
  CHECK(dem::settings_text(a) == dem::settings_text(b));
  for (const dem::Target& t : dem::targets()) {
    if (!dem::unused_because(a, t.name).empty()) continue;
    dem::Case changed = a;
    const double x = dem::get_target(a, t.name);
    dem::set_target(changed, t.name, x == 0.0 ? 0.5 * t.high : x * 1.25);
    INFO(t.name);
    CHECK(dem::settings_text(changed) != dem::settings_text(a));
  }
}
