#include "uq/findings/results_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/origin.hpp"
#include "uq/findings/fields.hpp"

namespace uq {
namespace {

using Json = nlohmann::ordered_json;

constexpr int results_format = 2;

// What a value becomes. The overloads call each other, so all are declared first.
Json save(double value);
Json save(int value) { return value; }
Json save(bool value) { return value; }
Json save(const std::string& value) { return value; }
template <data::HasTexts Kind>
Json save(Kind value) {
  return to_text(value);
}
template <class T>
Json save(const std::optional<T>& value);
template <class T>
Json save(const std::vector<T>& values);
Json save(const std::map<std::string, double>& values);
Json save(const std::pair<std::string, std::string>& value) { return Json::array({value.first, value.second}); }
template <class T>
requires std::is_aggregate_v<T> Json save(const T& value);

Json save(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

template <class T>
Json save(const std::optional<T>& value) {
  return value ? save(*value) : Json(nullptr);
}

template <class T>
Json save(const std::vector<T>& values) {
  Json array = Json::array();
  for (const T& value : values) array.push_back(save(value));
  return array;
}

Json save(const std::map<std::string, double>& values) {
  Json object = Json::object();
  for (const auto& [name, value] : values) object[name] = save(value);
  return object;
}

template <class T>
requires std::is_aggregate_v<T> Json save(const T& value) {
  Json object = Json::object();
  visit_fields([&object](const char* name, const auto& field) { object[name] = save(field); }, value);
  return object;
}

/// A value of the wrong kind, and where: found deep inside, told to the user with the file's name.
struct Misfit {
  std::string where, what;
};

void load(const Json& json, const std::string& where, double& value);
void load(const Json& json, const std::string& where, int& value);
void load(const Json& json, const std::string& where, bool& value);
void load(const Json& json, const std::string& where, std::string& value);
template <data::HasTexts Kind>
void load(const Json& json, const std::string& where, Kind& value);
template <class T>
void load(const Json& json, const std::string& where, std::optional<T>& value);
template <class T>
void load(const Json& json, const std::string& where, std::vector<T>& values);
void load(const Json& json, const std::string& where, std::map<std::string, double>& values);
void load(const Json& json, const std::string& where, std::pair<std::string, std::string>& value);
template <class T>
requires std::is_aggregate_v<T>
void load(const Json& json, const std::string& where, T& value);

void load(const Json& json, const std::string& where, double& value) {
  if (json.is_number()) {
    value = json.get<double>();
  } else if (json == "nan") {
    value = std::numeric_limits<double>::quiet_NaN();
  } else if (json == "inf" || json == "-inf") {
    value = json == "inf" ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
  } else {
    throw Misfit{where, "is not a number"};
  }
}

void load(const Json& json, const std::string& where, int& value) {
  if (!json.is_number_integer()) throw Misfit{where, "is not a whole number"};
  value = json.get<int>();
}

void load(const Json& json, const std::string& where, bool& value) {
  if (!json.is_boolean()) throw Misfit{where, "is neither true nor false"};
  value = json.get<bool>();
}

void load(const Json& json, const std::string& where, std::string& value) {
  if (!json.is_string()) throw Misfit{where, "is not text"};
  value = json.get<std::string>();
}

template <data::HasTexts Kind>
void load(const Json& json, const std::string& where, Kind& value) {
  if (json.is_string())
    if (const std::optional<Kind> known = data::from_text<Kind>(json.get_ref<const std::string&>())) {
      value = *known;
      return;
    }
  throw Misfit{where, fmt::format("is none of {}", fmt::join(data::texts_of<Kind>, ", "))};
}

template <class T>
void load(const Json& json, const std::string& where, std::optional<T>& value) {
  value.reset();
  if (json.is_null()) return;
  load(json, where, value.emplace());
}

template <class T>
void load(const Json& json, const std::string& where, std::vector<T>& values) {
  if (!json.is_array()) throw Misfit{where, "is not a list"};
  values.assign(json.size(), T{});
  for (std::size_t i = 0; i < values.size(); ++i) load(json[i], fmt::format("{}[{}]", where, i), values[i]);
}

void load(const Json& json, const std::string& where, std::map<std::string, double>& values) {
  if (!json.is_object()) throw Misfit{where, "is not a table"};
  values.clear();
  for (const auto& [name, value] : json.items()) load(value, where + "." + name, values[name]);
}

void load(const Json& json, const std::string& where, std::pair<std::string, std::string>& value) {
  if (!json.is_array() || json.size() != 2) throw Misfit{where, "is not a pair"};
  load(json[0], where, value.first);
  load(json[1], where, value.second);
}

template <class T>
requires std::is_aggregate_v<T>
void load(const Json& json, const std::string& where, T& value) {
  if (!json.is_object()) throw Misfit{where, "is not a table"};
  visit_fields(
      [&](const char* name, auto& field) {
        if (json.contains(name)) load(json.at(name), where + "." + name, field);
      },
      value);
}

}  // namespace

void save_results(const CalibrationReport& report, const std::string& path) {
  const Json json = {{"format", results_format}, {"results", save(report)}};
  data::write_atomically(path, json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

CalibrationReport load_results(const std::string& path) {
  const char* const remedy = "run demcal calibrate again";
  if (data::origin_of(path) == data::Origin::absent)
    throw data::InputError(data::ExitStatus::missing_input,
                           {path, "there are no saved results", "run demcal calibrate first"});
  const std::string text = data::read_file(path);
  data::require_unchanged(path, remedy);
  try {
    const Json json = Json::parse(text);
    if (!json.is_object() || !json.contains("format") || !json.contains("results"))
      throw Misfit{"", "is not a results file"};
    if (json.at("format") != results_format) {
      throw Misfit{"format", fmt::format("is {}, but this demcal reads {}", json.at("format").dump(), results_format)};
    }
    CalibrationReport report;
    load(json.at("results"), "results", report);
    return report;
  } catch (const Misfit& misfit) {
    const std::string place = misfit.where.empty() ? path : path + ": " + misfit.where;
    throw data::InputError(data::ExitStatus::bad_data, {place, misfit.what, remedy});
  } catch (const Json::exception& damage) {
    throw data::InputError(data::ExitStatus::bad_data, {path, fmt::format("is damaged: {}", damage.what()), remedy});
  }
}

std::string to_text(const PlanReport& plan) { return save(plan).dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string to_text(const SurrogateReport& report) {
  return save(report).dump(-1, ' ', false, Json::error_handler_t::replace);
}

SurrogateReport surrogate_report_from(const std::string& text, const std::string& place) {
  try {
    SurrogateReport report;
    load(Json::parse(text), "surrogate", report);
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
