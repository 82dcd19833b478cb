#include "uq/report/json.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/temporary.hpp"
#include "tests/uq/findings/report_fixture.hpp"

using namespace uq;
using nlohmann::ordered_json;

namespace {

void has_keys(const ordered_json& json, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    INFO(key);
    CHECK(json.contains(key));
  }
}

bool holds_no_text(const ordered_json& json, const std::string& text) {
  return json.dump().find(text) == std::string::npos;
}

}  // namespace

TEST_CASE("report.json holds every key of format 1") {
  const TemporaryFolder folder;
  write_report_json(report_fixture::three_cases(), folder.path("report.json"));
  const auto json = ordered_json::parse(folder.read("report.json"));
  has_keys(json, {"format", "demcal", "status", "study", "surrogates", "cases", "plan", "provenance"});
  CHECK(json["format"] == 1);
  CHECK(json["demcal"] == "0.1.0");
  CHECK(json["status"] == "ok");
  has_keys(json["surrogates"][0], {"output", "material", "q2", "coverage95", "runs", "verdict"});
  CHECK(json["surrogates"][0]["verdict"] == "good");
  const auto& result = json["cases"][2];
  has_keys(result, {"name", "fit", "parameters", "correlation", "log_evidence", "log_evidence_error", "divergences",
                    "traded", "predictive", "finding", "consequence", "remedy"});
  has_keys(result["fit"], {"chi2", "dof", "ppp"});
  has_keys(result["parameters"][0], {"name", "unit", "mean", "sd", "q05", "q50", "q95", "rhat", "ess_bulk", "ess_tail",
                                     "contraction", "profile95", "verdict", "reason", "borderline"});
  has_keys(result["traded"][0], {"pair", "combination", "equivalent"});
  has_keys(result["predictive"][0], {"controls", "output", "mean", "q05", "q95", "observed", "standard_error"});
}

TEST_CASE("numbers in report.json are those of the result to the last bit") {
  const CalibrationReport report = report_fixture::three_cases();
  const auto json = ordered_json::parse(report_json(report).dump());
  const ParameterReport& hamaker = report.cases[1].parameters[1];
  CHECK(json["cases"][1]["parameters"][1]["mean"].get<double>() == hamaker.mean);
  CHECK(json["cases"][1]["parameters"][1]["profile95"][0].get<double>() == *hamaker.profile_low);
  CHECK(json["cases"][2]["traded"][0]["equivalent"][3]["hamaker"].get<double>() ==
        report.cases[2].traded[0].equivalent[3].at("hamaker"));
}

TEST_CASE("an open end, a missing reason, a NaN and an infinity are null in report.json") {
  CalibrationReport report = report_fixture::three_cases();
  report.cases[0].parameters[0].rhat = std::numeric_limits<double>::quiet_NaN();
  report.cases[0].log_evidence = -std::numeric_limits<double>::infinity();
  const auto json = ordered_json::parse(report_json(report).dump());
  CHECK(json["cases"][2]["parameters"][0]["profile95"][1].is_null());
  CHECK(json["cases"][0]["parameters"][0]["reason"].is_null());
  CHECK(json["cases"][0]["parameters"][0]["rhat"].is_null());
  CHECK(json["cases"][0]["log_evidence"].is_null());
}

TEST_CASE("report.json of a case that does not fit says so and calls nothing identified") {
  const auto json = report_json(report_fixture::misfit());
  CHECK(json["status"] == "warning");
  CHECK(json["cases"][0]["parameters"][0]["verdict"] == "model does not fit");
  CHECK(holds_no_text(json["cases"][0]["parameters"], "\"identified\""));
}

TEST_CASE("an empty report is still valid report.json") {
  const auto json = ordered_json::parse(report_json({}).dump());
  CHECK(json["cases"].is_array());
  CHECK(json["cases"].empty());
  CHECK(json["demcal"] == "unknown");
}

TEST_CASE("bytes that are not UTF-8 do not stop report.json") {
  const TemporaryFolder folder;
  CalibrationReport report;
  report.study_name = "caf\xe9";
  write_report_json(report, folder.path("report.json"));
  CHECK(ordered_json::parse(folder.read("report.json"))["study"] == "caf\ufffd");
}
