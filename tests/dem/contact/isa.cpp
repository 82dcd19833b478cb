// Which instruction set the contact forces are computed with.
#include <catch2/catch.hpp>

#include "data/error.hpp"
#include "dem/contact/isa.hpp"

TEST_CASE("the widest instruction set is taken, and one that is not there is refused with those that are") {
  const std::vector<std::string> all = dem::isas();
  REQUIRE(!all.empty());
  CHECK(all.front() == "x86-64");
  CHECK(dem::isa() == all.back());
  for (const std::string isa : {"x86-64-v4", "x86-64-v9"}) {
    if (isa == all.back()) continue;
    try {
      dem::pin_isa(isa);
      FAIL("taken: " << isa);
    } catch (const data::InputError& error) {
      CHECK(error.status == data::ExitStatus::missing_program);
      CHECK_THAT(error.what(),
                 Catch::Contains("--isa") && Catch::Contains(isa) && Catch::Contains("choose one of: x86-64"));
    }
  }
  CHECK(dem::isa() == all.back());
}
