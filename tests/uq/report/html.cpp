#include "uq/report/html.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <limits>
#include <regex>
#include <set>

#include "data/error.hpp"
#include "tests/temporary.hpp"
#include "tests/uq/findings/report_fixture.hpp"

using namespace uq;
using report_fixture::count;

namespace {

std::string page_of(const CalibrationReport& report) {
  const TemporaryFolder folder;
  write_report_html(report, folder.path());
  return folder.read("report.html");
}

/// The page of the three cases, made once.
const std::string& three_case_page() {
  static const std::string page = page_of(report_fixture::three_cases());
  return page;
}

std::vector<std::string> all(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), expression), end; it != end; ++it) found.push_back((*it)[1]);
  return found;
}

bool has(const std::string& text, const std::string& piece) { return text.find(piece) != std::string::npos; }

}  // namespace

TEST_CASE("the page fetches nothing, runs nothing and names no id twice") {
  const std::string& page = three_case_page();
  CHECK_FALSE(has(page, "<script"));
  CHECK_FALSE(has(page, "<link"));
  CHECK_FALSE(has(page, " src="));
  CHECK_FALSE(has(page, "@import"));
  CHECK_FALSE(has(page, "<?xml"));
  CHECK_FALSE(has(page, "<!DOCTYPE svg"));
  for (const std::string& target : all(page, "href=[\"']([^\"']*)[\"']")) {
    INFO(target);
    CHECK((target.front() == '#' || target.starts_with("figures/")));
  }
  const auto ids = all(page, " id=[\"']([^\"']*)[\"']");
  const std::set<std::string> distinct(ids.begin(), ids.end());
  CHECK(distinct.size() == ids.size());
  for (const std::string& target : all(page, "href=[\"']#([^\"']*)[\"']")) CHECK(distinct.contains(target));
}

TEST_CASE("each case gives its verdict in words before its first figure") {
  const std::string& page = three_case_page();
  const std::size_t section = page.find("<section id=\"case-3-carrier\">");
  REQUIRE(section != std::string::npos);
  const std::size_t finding = page.find("Friction and the Hamaker constant are not identified by torque", section);
  const std::size_t figure = page.find("<svg", section);
  CHECK(finding < figure);
  CHECK(has(page, "\u2717 not identified"));
  CHECK(has(page, "friction * hamaker^0.9"));
  CHECK(has(page, "Sampled jointly with <strong>zirconia-800</strong>"));
}

TEST_CASE("every figure keeps its script and data beside it") {
  const TemporaryFolder folder;
  write_report_html(report_fixture::three_cases(), folder.path());
  std::size_t figures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path("figures"))) {
    if (entry.path().extension() != ".svg") continue;
    ++figures;
    CHECK(std::filesystem::exists(std::filesystem::path(entry.path()).replace_extension(".gp")));
    CHECK(std::filesystem::exists(std::filesystem::path(entry.path()).replace_extension(".dat")));
  }
  // Three against rpm, two joint, five profiles, traces and ranks of five parameters, two for each of two surrogates.
  CHECK(figures == 24);
  const std::string page = folder.read("report.html");
  CHECK(count(page, "<svg") == figures);
  for (const std::string& file : all(page, "href=[\"'](figures/[^\"']*)[\"']")) {
    INFO(file);
    CHECK(std::filesystem::exists(folder.path(file)));
  }
}

TEST_CASE("markup and commands in names appear as text and do nothing") {
  const TemporaryFolder folder;
  const std::string evil = "<script>alert(1)</script>'\"`touch " + folder.path("pwned") + "`@x\\";
  CalibrationReport report = report_fixture::three_cases();
  report.study_name = report.study_description = report.study_file = evil;
  report.warnings = report.notes = {evil};
  report.thresholds = report.provenance = {{evil, evil}};
  for (SurrogateReport& surrogate : report.surrogates) {
    for (auto* field : {&surrogate.output, &surrogate.material, &surrogate.unit, &surrogate.finding,
                        &surrogate.consequence, &surrogate.remedy}) {
      *field = evil;
    }
    surrogate.inputs = {evil, evil, evil};
    surrogate.notes = {evil};
  }
  for (ErrorScan& scan : report.error_scan) {
    scan.case_name = evil;
    for (ParameterAgain& parameter : scan.parameters) parameter.name = evil;
  }
  for (CaseReport& result : report.cases) {
    result.name = result.finding = result.consequence = result.remedy = evil;
    result.observed_sets = result.observed_notes = result.linked = result.warnings = {evil};
    for (ParameterReport& parameter : result.parameters) {
      parameter.name = parameter.unit = parameter.sentence = evil;
    }
    for (TradedPair& traded : result.traded) traded.first = traded.second = traded.combination = evil;
    for (PredictivePoint& point : result.predictive) {
      point.output = point.unit = point.observation_set = evil;
      point.controls = {{evil, point.controls.begin()->second}};
    }
    for (PredictiveCurve& curve : result.curves) {
      curve.output = curve.unit = curve.control = curve.control_unit = curve.observation_set = evil;
    }
  }
  write_report_html(report, folder.path());
  const std::string page = folder.read("report.html");
  CHECK_FALSE(has(page, "<script"));
  CHECK(has(page, "&lt;script&gt;alert(1)&lt;/script&gt;"));
  CHECK_FALSE(std::filesystem::exists(folder.path("pwned")));
}

TEST_CASE("warnings stand before everything else on the page") {
  const std::string page = page_of(report_fixture::misfit());
  const std::size_t banner = page.find("<div class=\"warnings\"");
  REQUIRE(banner != std::string::npos);
  CHECK(banner < page.find("<h1>"));
  CHECK(has(page, "! model does not fit"));
  CHECK_FALSE(has(page, "\u2713 identified"));
  CHECK_FALSE(has(page, "friction is identified"));
}

TEST_CASE("four parameters give six joint figures, the traded pair first and wide") {
  const std::string page = page_of(report_fixture::four_parameters());
  CHECK(count(page, "aria-label=\"joint posterior") == 6);
  CHECK(page.find("joint posterior of friction and cohesion") < page.find("joint posterior of friction and rolling"));
}

TEST_CASE("parameters that are not traded, but whose errors hang together, are said to") {
  CalibrationReport report = report_fixture::three_cases();
  CaseReport& first = report.cases.back();
  REQUIRE(first.parameters.size() >= 2);
  const std::size_t count = first.parameters.size();
  first.traded.clear();
  for (const double r : {0.5, -0.96}) {
    first.correlation.assign(count, std::vector<double>(count, 0.0));
    first.correlation[0][1] = first.correlation[1][0] = r;
    CHECK(has(page_of(report), "hang together all the same") == (r < -0.9));
  }
}

TEST_CASE("an empty report and empty cases give a page") {
  CHECK(has(page_of({}), "No case was calibrated."));
  CalibrationReport report;
  report.cases.resize(1);
  report.cases[0].parameters.resize(2);
  report.surrogates.resize(1);
  CHECK(has(page_of(report), "</html>"));
}

TEST_CASE("numbers that are not numbers are named as not available and drawn nowhere") {
  CalibrationReport report = report_fixture::three_cases();
  const double none = std::numeric_limits<double>::quiet_NaN();
  const double endless = std::numeric_limits<double>::infinity();
  ParameterReport& parameter = report.cases[2].parameters[0];
  parameter.mean = parameter.sd = parameter.map = parameter.rhat = parameter.ess_bulk = parameter.mcse = none;
  parameter.prior_low = -endless;
  parameter.prior_high = endless;
  parameter.profile_deviance.assign(parameter.profile_x.size(), none);
  report.cases[2].predictive[0].observed = none;
  report.cases[2].curves[0].mean.assign(report.cases[2].curves[0].x.size(), none);
  report.cases[2].draws_for_plot[0] = {none, endless};
  report.cases[2].chi2 = none;
  report.surrogates[0].standardised.assign(report.surrogates[0].observed.size(), none);
  const std::string page = page_of(report);
  CHECK(has(page, "not available"));
  CHECK_FALSE(std::regex_search(page, std::regex("\\b(nan|NaN|-?inf)\\b")));
}

TEST_CASE("without curves the band is drawn through the predictive points") {
  CalibrationReport report = report_fixture::three_cases();
  for (CaseReport& result : report.cases) result.curves.clear();
  const std::string page = page_of(report);
  CHECK(count(page, "observed points with their errors") == 3);
  CHECK(count(page, "measurement error too") == 3);
}

TEST_CASE("a missing gnuplot is named with what to install") {
  const TemporaryFolder folder;
  HtmlOptions options;
  options.gnuplot.program = "no-such-gnuplot";
  try {
    write_report_html(report_fixture::misfit(), folder.path(), options);
    FAIL("no error");
  } catch (const data::InputError& error) {
    CHECK(error.status == data::ExitStatus::missing_program);
    CHECK(has(error.what(), "gnuplot-nox"));
  }
  CHECK_FALSE(std::filesystem::exists(folder.path("report.html")));
}
