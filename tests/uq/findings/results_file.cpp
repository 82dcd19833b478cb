#include "uq/findings/results_file.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <fstream>
#include <limits>

#include "data/error.hpp"
#include "data/random.hpp"
#include "tests/temporary.hpp"
#include "tests/uq/findings/report_fixture.hpp"
#include "uq/findings/fields.hpp"

using namespace uq;

namespace {

// Equality to the bit, field by field; NaN equals NaN.
bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (a != a && b != b);
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
  visit_fields([&](const char*, const auto& field) { fields.push_back(&field); }, b);
  bool equal = true;
  std::size_t next = 0;
  visit_fields(
      [&](const char* name, const auto& field) {
        using Field = std::remove_cvref_t<decltype(field)>;
        const bool equal_field = same(field, *static_cast<const Field*>(fields[next++]));
        if (!equal_field) UNSCOPED_INFO("differs: " << name);
        equal = equal && equal_field;
      },
      a);
  return equal;
}

/// The size of a struct that holds exactly the visited fields in their order.
template <class T>
std::size_t size_of_visited() {
  std::size_t end = 0;
  T value{};
  visit_fields(
      [&](const char*, const auto& field) {
        using Field = std::remove_cvref_t<decltype(field)>;
        end = (end + alignof(Field) - 1) / alignof(Field) * alignof(Field) + sizeof(Field);
      },
      value);
  return (end + alignof(T) - 1) / alignof(T) * alignof(T);
}

data::ExitStatus status_of_loading(const std::string& path, std::string& message) {
  try {
    load_results(path);
  } catch (const data::InputError& error) {
    message = error.what();
    return error.status;
  }
  return data::ExitStatus::done;
}

}  // namespace

TEST_CASE("every field of the results is saved (one added to results.hpp belongs into fields.hpp)") {
  CHECK(size_of_visited<SurrogateReport>() == sizeof(SurrogateReport));
  CHECK(size_of_visited<ParameterReport>() == sizeof(ParameterReport));
  CHECK(size_of_visited<ValueRange>() == sizeof(ValueRange));
  CHECK(size_of_visited<ProfileHole>() == sizeof(ProfileHole));
  CHECK(size_of_visited<WordProbability>() == sizeof(WordProbability));
  CHECK(size_of_visited<ModeReport>() == sizeof(ModeReport));
  CHECK(size_of_visited<TradedPair>() == sizeof(TradedPair));
  CHECK(size_of_visited<PredictivePoint>() == sizeof(PredictivePoint));
  CHECK(size_of_visited<PredictiveCurve>() == sizeof(PredictiveCurve));
  CHECK(size_of_visited<CaseReport>() == sizeof(CaseReport));
  CHECK(size_of_visited<ErrorScan>() == sizeof(ErrorScan));
  CHECK(size_of_visited<CalibrationReport>() == sizeof(CalibrationReport));
}

TEST_CASE("results come back from their file to the last bit") {
  const TemporaryFolder folder;
  for (const CalibrationReport& report : {report_fixture::three_cases(), report_fixture::four_parameters(),
                                          report_fixture::misfit(), CalibrationReport{}}) {
    save_results(report, folder.path("results.json"));
    CHECK(same(load_results(folder.path("results.json")), report));
  }
}

TEST_CASE("any double comes back to the last bit, NaN and the infinities too") {
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
  save_results(report, folder.path("results.json"));
  CHECK(same(load_results(folder.path("results.json")).cases[0].draws_for_plot[0], values));
}

TEST_CASE("a field that an older file lacks keeps its default") {
  const TemporaryFolder folder;
  std::ofstream(folder.path("results.json"))
      << R"({"format": 2, "results": {"study_name": "old", "cases": [{"name": "c"}]}})";
  const CalibrationReport report = load_results(folder.path("results.json"));
  CHECK(report.study_name == "old");
  CHECK(report.cases.at(0).fits);
}

TEST_CASE("missing, damaged and foreign results files are told apart with their place") {
  const TemporaryFolder folder;
  std::string message;
  CHECK(status_of_loading(folder.path("none.json"), message) == data::ExitStatus::missing_input);
  std::ofstream(folder.path("cut.json")) << R"({"format": 2, "results": {"study_na)";
  CHECK(status_of_loading(folder.path("cut.json"), message) == data::ExitStatus::bad_data);
  CHECK(message.find("cut.json") != std::string::npos);
  std::ofstream(folder.path("later.json")) << R"({"format": 9, "results": {}})";
  CHECK(status_of_loading(folder.path("later.json"), message) == data::ExitStatus::bad_data);
  std::ofstream(folder.path("list.json")) << "[]";
  CHECK(status_of_loading(folder.path("list.json"), message) == data::ExitStatus::bad_data);
  std::ofstream(folder.path("kind.json"))
      << R"({"format": 2, "results": {"cases": [{"parameters": [{"mean": "much"}]}]}})";
  CHECK(status_of_loading(folder.path("kind.json"), message) == data::ExitStatus::bad_data);
  CHECK(message.find("results.cases[0].parameters[0].mean") != std::string::npos);
}
