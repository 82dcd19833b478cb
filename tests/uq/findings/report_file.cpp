#include "uq/findings/report_file.hpp"

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "data/error.hpp"
#include "data/random.hpp"
#include "tests/temporary.hpp"
#include "tests/uq/findings/report_fixture.hpp"
#include "uq/findings/fields.hpp"

using namespace uq;
using nlohmann::ordered_json;

namespace {

/// Calls `visit(field)` for each stored field of a finding, whatever its place in the file.
template <class Visit>
class EachField {
 public:
  explicit EachField(Visit visit) : visit_(visit) {}

  void operator()(const char* key, const auto& field) { visit_(key, field); }
  void text(const char* key, const auto& field) { visit_(key, field); }
  void table(const char*, auto inner) { inner(*this); }
  void pair(const char* key, const auto& first, const auto& second) {
    visit_(key, first);
    visit_(key, second);
  }
  void range(const char* key, const auto& low, const auto& high) { pair(key, low, high); }
  void each(const char* key, const auto& list, const auto&) { visit_(key, list); }
  void columns(const auto& list, auto first, auto...) { visit_(first.key, list); }
  void keyed(const char* key, const auto& list, auto, auto) { visit_(key, list); }
  void gathered(const char* key, const auto& list, const char*, auto, auto field) {
    for (const auto& item : list) visit_(key, item.*field);
  }
  void shown(const char*, const auto&) {}

 private:
  Visit visit_;
};

// Equality to the bit, field by field. A number that is not finite equals any other such.
bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}
bool same(const ParameterAgain& a, const ParameterAgain& b) {
  return a.name == b.name && a.verdict == b.verdict && a.reason == b.reason && a.borderline == b.borderline &&
         same(a.mean, b.mean) && same(a.sd, b.sd);
}
template <class T>
requires std::is_aggregate_v<T>
bool same(const T& a, const T& b);
template <class T>
requires(!std::is_aggregate_v<T>) bool same(const T& a, const T& b) { return a == b; }
template <class T>
bool same(const std::optional<T>& a, const std::optional<T>& b) {
  return a.has_value() == b.has_value() && (!a || same(*a, *b));
}
template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!same(a[i], b[i])) return false;
  }
  return true;
}
template <class T>
requires std::is_aggregate_v<T>
bool same(const T& a, const T& b) {
  std::vector<const void*> fields;
  visit_fields(EachField([&](const char*, const auto& field) { fields.push_back(&field); }), b);
  bool equal = true;
  std::size_t next = 0;
  visit_fields(EachField([&](const char* key, const auto& field) {
                 using Field = std::remove_cvref_t<decltype(field)>;
                 if (next >= fields.size()) return;  // lists of other lengths, which differ already
                 const bool equal_field = same(field, *static_cast<const Field*>(fields[next++]));
                 if (!equal_field) UNSCOPED_INFO("differs: " << key);
                 equal = equal && equal_field;
               }),
               a);
  return equal && next == fields.size();
}

/// The size of a struct that holds exactly the visited fields and, of fields that are written elsewhere, `extra` bytes:
/// each field at its place, so that one between two others that nobody visits shows as well.
template <class T>
std::size_t size_of_visited(std::size_t extra = 0) {
  struct Part {
    std::size_t offset, size, alignment;
  };
  std::vector<Part> parts;
  T value{};
  visit_fields(EachField([&](const char*, const auto& field) {
                 const auto* const at = reinterpret_cast<const std::byte*>(&field);
                 parts.push_back({static_cast<std::size_t>(at - reinterpret_cast<const std::byte*>(&value)),
                                  sizeof(field), alignof(std::remove_cvref_t<decltype(field)>)});
               }),
               value);
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.offset < b.offset; });
  std::size_t end = 0;
  for (const Part& part : parts) end = (end + part.alignment - 1) / part.alignment * part.alignment + part.size;
  return (end + extra + alignof(T) - 1) / alignof(T) * alignof(T);
}

void has_keys(const ordered_json& json, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    INFO(key);
    CHECK(json.contains(key));
  }
}

bool holds_no_text(const ordered_json& json, const std::string& text) {
  return json.dump().find(text) == std::string::npos;
}

data::ExitStatus status_of_loading(const std::string& path, std::string& message) {
  try {
    load_report(path);
  } catch (const data::InputError& error) {
    message = error.what();
    return error.status;
  }
  return data::ExitStatus::done;
}

}  // namespace

TEST_CASE("every field of the results is saved (one added to results.hpp belongs into the list of its fields)") {
  CHECK(size_of_visited<SurrogateReport>() == sizeof(SurrogateReport));
  CHECK(size_of_visited<ParameterReport>() == sizeof(ParameterReport));
  CHECK(size_of_visited<ValueRange>() == sizeof(ValueRange));
  CHECK(size_of_visited<ProfileHole>() == sizeof(ProfileHole));
  CHECK(size_of_visited<WordProbability>() == sizeof(WordProbability));
  CHECK(size_of_visited<ModeReport>() == sizeof(ModeReport));
  CHECK(size_of_visited<TradedPair>() == sizeof(TradedPair));
  CHECK(size_of_visited<PredictivePoint>() == sizeof(PredictivePoint));
  CHECK(size_of_visited<PredictiveCurve>() == sizeof(PredictiveCurve));
  CHECK(size_of_visited<CaseReport>(sizeof(CaseReport::plan)) == sizeof(CaseReport));
  CHECK(size_of_visited<ErrorScan>() == sizeof(ErrorScan));
  CHECK(size_of_visited<CalibrationReport>() == sizeof(CalibrationReport));
}

TEST_CASE("a report comes back from its file to the last bit") {
  const TemporaryFolder folder;
  for (const CalibrationReport& report : {report_fixture::three_cases(), report_fixture::four_parameters(),
                                          report_fixture::misfit(), CalibrationReport{}}) {
    save_report(report, folder.path("report.json"));
    CalibrationReport shown = report;
    for (CaseReport& one : shown.cases)
      for (ParameterReport& parameter : one.parameters)
        if (shown_verdict(one, parameter) != parameter.verdict) {
          parameter.verdict = shown_verdict(one, parameter);
          parameter.reason.reset();
          parameter.sentence.clear();
        }
    CHECK(same(load_report(folder.path("report.json")), shown));
  }
}

TEST_CASE("any number comes back to the last bit, an infinity with its sign") {
  const TemporaryFolder folder;
  CalibrationReport report;
  report.cases.resize(1);
  std::vector<double> values = {0.0,
                                -0.0,
                                std::numeric_limits<double>::denorm_min(),
                                std::numeric_limits<double>::max(),
                                std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::quiet_NaN(),
                                1.0 / 3.0,
                                1e22,
                                1e15};
  data::RandomStream random(5, data::Purpose::test);
  while (values.size() < 5000) values.push_back(std::bit_cast<double>(random()));
  report.cases[0].draws_for_plot = {values};
  save_report(report, folder.path("report.json"));
  CHECK(same(load_report(folder.path("report.json")).cases[0].draws_for_plot[0], values));
}

TEST_CASE("a field that an older file lacks keeps its default") {
  const TemporaryFolder folder;
  std::ofstream(folder.path("report.json"))
      << R"({"format": 1, "edition": 7, "study": "old", "cases": [{"name": "c"}]})";
  const CalibrationReport report = load_report(folder.path("report.json"));
  CHECK(report.study_name == "old");
  CHECK(report.cases.at(0).fits);
}

TEST_CASE("missing, damaged and foreign reports are told apart with their place") {
  const TemporaryFolder folder;
  std::string message;
  CHECK(status_of_loading(folder.path("none.json"), message) == data::ExitStatus::missing_input);
  std::ofstream(folder.path("cut.json")) << R"({"format": 1, "edition": 7, "stud)";
  CHECK(status_of_loading(folder.path("cut.json"), message) == data::ExitStatus::bad_data);
  CHECK(message.find("cut.json") != std::string::npos);
  std::ofstream(folder.path("later.json")) << R"({"format": 9, "edition": 7, "cases": []})";
  CHECK(status_of_loading(folder.path("later.json"), message) == data::ExitStatus::bad_data);
  std::ofstream(folder.path("list.json")) << "[]";
  CHECK(status_of_loading(folder.path("list.json"), message) == data::ExitStatus::bad_data);
  std::ofstream(folder.path("kind.json"))
      << R"({"format": 1, "edition": 7, "cases": [{"parameters": [{"mean": "much"}]}]})";
  CHECK(status_of_loading(folder.path("kind.json"), message) == data::ExitStatus::bad_data);
  CHECK(message.find("kind.json: cases[0].parameters[0].mean") != std::string::npos);
}

TEST_CASE("report.json holds every key of format 1") {
  const TemporaryFolder folder;
  save_report(report_fixture::three_cases(), folder.path("report.json"));
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

TEST_CASE("an open end, a missing reason and a NaN are null in report.json, and an infinity says its sign") {
  CalibrationReport report = report_fixture::three_cases();
  report.cases[0].parameters[0].rhat = std::numeric_limits<double>::quiet_NaN();
  report.cases[0].log_evidence = -std::numeric_limits<double>::infinity();
  const auto json = ordered_json::parse(report_json(report).dump());
  CHECK(json["cases"][2]["parameters"][0]["profile95"][1].is_null());
  CHECK(json["cases"][0]["parameters"][0]["reason"].is_null());
  CHECK(json["cases"][0]["parameters"][0]["rhat"].is_null());
  CHECK(json["cases"][0]["log_evidence"] == "-infinity");
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
  save_report(report, folder.path("report.json"));
  CHECK(ordered_json::parse(folder.read("report.json"))["study"] == "caf\ufffd");
}
