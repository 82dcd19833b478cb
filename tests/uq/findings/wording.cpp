#include "uq/findings/wording.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/uq/findings/report_fixture.hpp"

using namespace uq;

namespace {
constexpr auto plain = Typography::ascii;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
}  // namespace

TEST_CASE("a value is rounded at the second significant digit of its error") {
  CHECK(format_with_error(0.40231, 0.02143, "", plain) == "0.402 +- 0.021");
  CHECK(format_with_error(74.2149, 2.26, "mN m", plain) == "(74.2 +- 2.3) mN m");
  CHECK(format_with_error(1234.5, 180.0, "", plain) == "1234 +- 180");
  CHECK(format_with_error(34313.0, 11191.0, "J/m3", plain) == "(3.4 +- 1.1)e4 J/m3");
  CHECK(format_with_error(9.04e-18, 4.1e-19, "J", plain) == "(9.04 +- 0.41)e-18 J");
  CHECK(format_with_error(9.04e-18, 4.1e-19, "J", Typography::unicode) ==
        "(9.04\u00a0\u00b1\u00a00.41)\u00a0\u00d7\u00a010\u207b\u00b9\u2078\u00a0J");
}

TEST_CASE("an interval is rounded as the value it belongs to") {
  const Rounding rounding = rounding_of(9.4e-18, 4.2e-18);
  CHECK(format_interval(4.2e-18, 1.72e-17, rounding, "J", plain) == "(4.2 to 17.2)e-18 J");
  CHECK(format_interval(0.367, 0.437, rounding_of(0.4, 0.02), "", plain) == "0.367 to 0.437");
}

TEST_CASE("a value without a usable error keeps four significant digits") {
  CHECK(format_with_error(0.123456, 0.0, "", plain) == "0.1235 +- 0.0000");
  CHECK(format_with_error(0.123456, nan_value, "", plain) == "0.1235");
  CHECK(format_with_error(nan_value, 0.1, "", plain) == "not available");
  CHECK(format_with_error(0.0, 0.0, "", plain) == "0 +- 0");
}

TEST_CASE("a rounded zero carries no minus sign") {
  CHECK(format_with_error(-0.0001, 0.1, "", plain) == "0.00 +- 0.10");
  CHECK(format_with_error(-0.31, 0.1, "", plain) == "-0.31 +- 0.10");
}

TEST_CASE("a profile interval says on which side it is open and why") {
  ParameterReport parameter;
  parameter.mean = 0.4;
  parameter.sd = 0.1;
  CHECK(format_profile_interval(parameter, plain) == "open on both sides");
  parameter.profile_low = 0.25;
  parameter.high_is_bound = true;
  CHECK(format_profile_interval(parameter, plain) == "from 0.25; open above (range ends first)");
  parameter.profile_high = 0.55;
  CHECK(format_profile_interval(parameter, plain) == "0.25 to 0.55");
  parameter.profile_low.reset();
  CHECK(format_profile_interval(parameter, plain) == "up to 0.55; open below");
}

TEST_CASE("a slug is a safe file name for any text") {
  CHECK(slug("../../etc/pass wd") == "etc-pass-wd");
  CHECK(slug("\u03bc") == "x");
  CHECK(slug("") == "x");
  CHECK(slug(std::string(200, 'a')).size() == 60);
}

TEST_CASE("a unit that repeats its quantity's name is left out") {
  CHECK(name_in_unit("rpm", "rpm") == "rpm");
  CHECK(name_in_unit("torque", "mN m") == "torque (mN m)");
  CHECK(name_in_unit("friction", "") == "friction");
}

TEST_CASE("nothing in a case that does not fit is shown as identified") {
  const CalibrationReport report = report_fixture::misfit();
  const CaseReport& result = report.cases.front();
  REQUIRE(result.parameters.front().verdict == Verdict::identified);
  CHECK(shown_verdict(result, result.parameters.front()) == Verdict::does_not_fit);
  CHECK(shown_sentence(result, result.parameters.front()).empty());
  CHECK(has_warning(report));
}

TEST_CASE("the first lines are the warnings of the whole and of each case, each once") {
  CalibrationReport report = report_fixture::three_cases();
  CHECK_FALSE(has_warning(report));
  report.warnings = {"the surrogate is unusable"};
  report.cases[0].warnings = {"case zirconia-800: the prior decides"};
  report.cases[1].warnings = {"the surrogate is unusable", "case carrier: the model does not fit the data"};
  CHECK(first_lines(report) == std::vector<std::string>{"the surrogate is unusable",
                                                        "case zirconia-800: the prior decides",
                                                        "case carrier: the model does not fit the data"});
}
