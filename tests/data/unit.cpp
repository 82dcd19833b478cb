#include "data/unit.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <numbers>
#include <stdexcept>

TEST_CASE("units map to SI by their definition") {
  CHECK(data::parse_unit("mN m").to_si(12.0) == Approx(0.012));
  CHECK(data::parse_unit("um").to_si(800.0) == Approx(800e-6));
  CHECK(data::parse_unit("mJ/m2").to_si(10.0) == Approx(0.010));
  CHECK(data::parse_unit("rpm").to_si(150.0) == Approx(150.0 * 2.0 * std::numbers::pi / 60.0));
  CHECK(data::parse_unit("degC").to_si(20.0) == Approx(293.15));
  CHECK(data::parse_unit("").to_si(0.4) == 0.4);
  CHECK(data::parse_unit("1").to_si(0.4) == 0.4);
  CHECK(data::parse_unit("%").to_si(3.0) == Approx(0.03));
}

TEST_CASE("a unit converts back what it converted") {
  for (const char* symbol : {"mN m", "rpm", "degC", "mJ/m2", "aJ", "kg/m3", ""}) {
    const data::Unit unit = data::parse_unit(symbol);
    CHECK(unit.symbol == symbol);
    CHECK(unit.from_si(unit.to_si(7.25)) == Approx(7.25).epsilon(1e-13));
  }
}

TEST_CASE("a value's digits are those that a person would write") {
  const data::Unit rpm = data::parse_unit("rpm"), joule = data::parse_unit("J");
  for (const char* text : {"300", "50", "1200.5", "0", "0.05"})
    CHECK(rpm.digits(rpm.to_si(std::string_view(text))) == text);
  CHECK(joule.digits(2e-18) == "2e-18");
  CHECK(joule.digits(1.0 / 3.0) == "0.3333333333333333");
}

TEST_CASE("the SI unit of a unit is itself a unit that maps to itself") {
  for (const char* symbol : {"mN m", "rpm", "degC", "mJ/m2", "kg/m3", "", "%"}) {
    const data::Unit si = data::parse_unit(data::parse_unit(symbol).si_symbol);
    CHECK(si.factor == 1.0);
    CHECK(si.offset == 0.0);
    CHECK(data::convertible(symbol, si.symbol));
  }
}

TEST_CASE("only units of one dimension are convertible") {
  CHECK(data::convertible("mN m", "J"));
  CHECK(data::convertible("rpm", "rad/s"));
  CHECK_FALSE(data::convertible("rpm", "Hz"));
  CHECK_FALSE(data::convertible("s", "Hz"));
  CHECK_FALSE(data::convertible("m", "kg"));
  CHECK(data::convertible("", "1"));
}

TEST_CASE("a line's end in a unit is a blank, and nothing of it reaches stdout") {
  std::fflush(stdout);
  std::FILE* const into = std::tmpfile();
  const int before = ::dup(STDOUT_FILENO);
  ::dup2(::fileno(into), STDOUT_FILENO);
  const data::Unit broken = data::parse_unit("N\n m");
  CHECK_THROWS_AS(data::parse_unit("\x01\n\n?"), std::invalid_argument);
  std::fflush(stdout);
  ::dup2(before, STDOUT_FILENO);
  ::close(before);
  CHECK(std::ftell(into) == 0);
  std::fclose(into);
  CHECK(broken.si_symbol == data::parse_unit("N m").si_symbol);
  CHECK(broken.factor == 1.0);
}

TEST_CASE("what UDUNITS-2 does not know is refused") {
  CHECK_THROWS_AS(data::parse_unit("furlongs per fortnite"), std::invalid_argument);
  CHECK_THROWS_AS(data::parse_unit("seconds since 2000-01-01"), std::invalid_argument);
  CHECK_THROWS_AS(data::convertible("m", "qqq"), std::invalid_argument);
}
