#include "uq/findings/report_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/origin.hpp"
#include "uq/findings/field_reader.hpp"
#include "uq/findings/field_writer.hpp"

namespace uq {
namespace {

using fields::Json;
using fields::Misfit;

std::string compact(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

bool is_plain(const Json& json) { return !json.is_structured() || json.empty(); }

void append(std::string& text, const Json& json, std::size_t depth) {
  if (is_plain(json) || (json.is_array() && std::all_of(json.begin(), json.end(), is_plain))) {
    text += compact(json);
    return;
  }
  text += json.is_array() ? "[" : "{";
  const char* between = "\n";
  for (const auto& [key, value] : json.items()) {
    text += between + std::string(depth + 1, ' ');
    if (json.is_object()) text += compact(key) + ": ";
    append(text, value, depth + 1);
    between = ",\n";
  }
  text += "\n" + std::string(depth, ' ') + (json.is_array() ? "]" : "}");
}

}  // namespace

nlohmann::ordered_json report_json(const CalibrationReport& report) {
  Json json = {{"format", report_format}, {"edition", report_edition}};
  json.update(fields::save(report));
  return json;
}

nlohmann::ordered_json plans_json(const std::vector<CaseReport>& cases) {
  fields::Writer writer;
  writer.gathered("plan", cases, "case", &CaseReport::name, &CaseReport::plan);
  return writer.json["plan"];
}

std::string text_of(const nlohmann::ordered_json& json) {
  std::string text;
  append(text, json, 0);
  return text + "\n";
}

void save_report(const CalibrationReport& report, const std::string& path) {
  data::write_atomically(path, text_of(report_json(report)));
}

CalibrationReport load_report(const std::string& path) {
  const char* const remedy = "run demcal calibrate again";
  if (data::origin_of(path) == data::Origin::absent)
    throw data::InputError(data::ExitStatus::missing_input, {path, "there is no report", "run demcal calibrate first"});
  const std::string text = data::read_file(path);
  data::require_unchanged(path, remedy);
  try {
    const Json json = Json::parse(text);
    if (!json.is_object() || !json.contains("format") || !json.contains("cases")) throw Misfit{"", "is not a report"};
    if (json.at("format") != report_format)
      throw Misfit{"format", fmt::format("is {}, but this demcal reads {}", json.at("format").dump(), report_format)};
    if (json.value("edition", 0) != report_edition)
      throw Misfit{"edition", fmt::format("is not {}: another demcal wrote the report", report_edition)};
    CalibrationReport report;
    fields::load(json, "", report);
    return report;
  } catch (const Misfit& misfit) {
    const std::string place = misfit.where.empty() ? path : path + ": " + misfit.where;
    throw data::InputError(data::ExitStatus::bad_data, {place, misfit.what, remedy});
  } catch (const Json::exception& damage) {
    throw data::InputError(data::ExitStatus::bad_data, {path, fmt::format("is damaged: {}", damage.what()), remedy});
  }
}

std::string to_text(const SurrogateReport& report) { return compact(fields::save(report)); }

SurrogateReport surrogate_report_from(const std::string& text, const std::string& place) {
  try {
    SurrogateReport report;
    fields::load(Json::parse(text), "surrogate", report);
    return report;
  } catch (const Misfit& misfit) {
    throw data::InputError(data::ExitStatus::bad_data,
                           {place + ": " + misfit.where, misfit.what, "delete the file, it is made again"});
  } catch (const Json::exception& damage) {
    throw data::InputError(data::ExitStatus::bad_data,
                           {place, fmt::format("is damaged: {}", damage.what()), "delete the file, it is made again"});
  }
}

}  // namespace uq
