#include "uq/report/terminal.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>

#include "tests/uq/findings/report_fixture.hpp"

using namespace uq;

namespace {
bool has(const std::string& text, const std::string& piece) { return text.find(piece) != std::string::npos; }
}  // namespace

TEST_CASE("the terminal summary names each verdict, what is traded, and the report") {
  const std::string text = terminal_summary(report_fixture::three_cases(), {.report_file = "developer/report.html"});
  CHECK(has(text, "friction  0.402 +- 0.021  identified"));
  CHECK(has(text, "not identified (practical)"));
  CHECK(has(text, "friction * hamaker^0.9"));
  CHECK(has(text, "Report: developer/report.html\n"));
  CHECK_FALSE(has(text, "\x1b"));
}

TEST_CASE("lines of the terminal summary are no longer than asked") {
  for (const int columns : {80, 100}) {
    std::istringstream lines(
        terminal_summary(report_fixture::three_cases(), {.report_file = "r.html", .columns = columns}));
    for (std::string line; std::getline(lines, line);) {
      INFO(line);
      const auto width = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
      CHECK(width <= columns);
    }
  }
}

TEST_CASE("the terminal summary starts with the warnings and calls nothing identified in a misfit") {
  const std::string text = terminal_summary(report_fixture::misfit());
  CHECK(text.rfind("warning: ", 0) == 0);
  CHECK_FALSE(has(text, "0.021  identified"));
  CHECK(has(text, "model does not fit"));
}

TEST_CASE("names cannot steer the terminal") {
  CalibrationReport report = report_fixture::misfit();
  report.cases[0].name = "a\x1b[31m";
  report.cases[0].parameters[0].name = "b\x1b[2J";
  CHECK_FALSE(has(terminal_summary(report, {.report_file = "c\x1b"}), "\x1b"));
}

TEST_CASE("a combination is said once, by the finding, and of a curve the summary says what hangs together") {
  CalibrationReport report = report_fixture::three_cases();
  const std::string combination = "friction * hamaker^0.9";
  CHECK(report_fixture::count(terminal_summary(report, {.columns = 1000}), combination) == 1);
  for (CaseReport& result : report.cases)
    for (TradedPair& traded : result.traded) {
      traded.form = CombinationForm::curved;
      traded.combination = traded.statement = "a curved relation of friction and hamaker";
    }
  CHECK(has(terminal_summary(report, {.columns = 1000}),
            "known together: a curved relation of friction and hamaker (correlation -0.947)"));
}
