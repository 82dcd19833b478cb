#include "uq/findings/report_file.hpp"

#include <fmt/format.h>

#include <algorithm>
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

using Texts = std::vector<std::pair<std::string, std::string>>;

// ---- writing

// What a value becomes. The overloads call each other, so all are declared first.
// JSON has no infinities.
constexpr const char *infinite = "infinity", *minus_infinite = "-infinity";

Json save(double value) {
  if (std::isinf(value)) return value > 0.0 ? infinite : minus_infinite;
  return std::isnan(value) ? Json(nullptr) : Json(value);
}
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
Json save(const Texts& values);
Json save(const SupportReport& support);
template <class T>
requires std::is_aggregate_v<T> Json save(const T& value);

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

Json save(const Texts& values) {
  Json object = Json::object();
  for (const auto& [name, value] : values) object[name] = value;
  return object;
}

/// Writes the fields of one finding (fields.hpp says what each call means).
class Writer {
 public:
  template <class T>
  void operator()(const char* key, const T& field) {
    json[key] = save(field);
  }

  void text(const char* key, const std::string& field) { json[key] = field.empty() ? Json(nullptr) : Json(field); }

  template <class Visit>
  void table(const char* key, Visit visit) {
    Writer inner;
    visit(inner);
    json[key] = std::move(inner.json);
  }

  template <class T>
  void pair(const char* key, const T& first, const T& second) {
    json[key] = Json::array({save(first), save(second)});
  }

  void range(const char* key, double low, double high) {
    json[key] = low == high ? Json(nullptr) : Json::array({save(low), save(high)});
  }

  template <class T, class Visit>
  void each(const char* key, const std::vector<T>& list, Visit visit) {
    Json array = Json::array();
    for (const T& item : list) {
      Writer inner;
      visit(inner, item);
      array.push_back(std::move(inner.json));
    }
    json[key] = std::move(array);
  }

  template <class T, class... Fields>
  void columns(const std::vector<T>& list, FieldColumn<T, Fields>... column) {
    const auto write = [&](const auto& one) {
      Json array = Json::array();
      for (const T& item : list) array.push_back(save(item.*one.field));
      json[one.key] = std::move(array);
    };
    (write(column), ...);
  }

  template <class T, class Name, class Value>
  void keyed(const char* key, const std::vector<T>& list, Name T::*name, Value T::*value) {
    Json object = Json::object();
    for (const T& item : list) object[save(item.*name).template get<std::string>()] = save(item.*value);
    json[key] = std::move(object);
  }

  template <class T, class Field>
  void gathered(const char* key, const std::vector<T>& list, const char* name_key, std::string T::*name,
                std::optional<Field> T::*field) {
    Json array = Json::array();
    for (const T& item : list)
      if (item.*field) {
        Json one = {{name_key, item.*name}};
        one.update(save(*(item.*field)));
        array.push_back(std::move(one));
      }
    json[key] = std::move(array);
  }

  template <class Make>
  void shown(const char* key, Make make) {
    json[key] = save(make());
  }

  Json json = Json::object();
};

template <class T>
Json save_fields(const T& value) {
  Writer writer;
  visit_fields(writer, value);
  return std::move(writer.json);
}

/// Null where there were no runs to ask.
Json save(const SupportReport& support) { return support.known ? save_fields(support) : Json(nullptr); }

template <class T>
requires std::is_aggregate_v<T> Json save(const T& value) { return save_fields(value); }

// ---- reading

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
void load(const Json& json, const std::string& where, Texts& values);
void load(const Json& json, const std::string& where, SupportReport& support);
template <class T>
requires std::is_aggregate_v<T>
void load(const Json& json, const std::string& where, T& value);

void load(const Json& json, const std::string& where, double& value) {
  if (json == infinite || json == minus_infinite)
    value = (json == infinite ? 1.0 : -1.0) * std::numeric_limits<double>::infinity();
  else if (json.is_null())
    value = std::numeric_limits<double>::quiet_NaN();
  else if (json.is_number())
    value = json.get<double>();
  else
    throw Misfit{where, "is not a number"};
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

void require_list(const Json& json, const std::string& where) {
  if (!json.is_array()) throw Misfit{where, "is not a list"};
}

void require_table(const Json& json, const std::string& where) {
  if (!json.is_object()) throw Misfit{where, "is not a table"};
}

template <class T>
void load(const Json& json, const std::string& where, std::vector<T>& values) {
  require_list(json, where);
  values.assign(json.size(), T{});
  for (std::size_t i = 0; i < values.size(); ++i) load(json[i], fmt::format("{}[{}]", where, i), values[i]);
}

void load(const Json& json, const std::string& where, std::map<std::string, double>& values) {
  require_table(json, where);
  values.clear();
  for (const auto& [name, value] : json.items()) load(value, where + "." + name, values[name]);
}

void load(const Json& json, const std::string& where, Texts& values) {
  require_table(json, where);
  values.clear();
  for (const auto& [name, value] : json.items()) load(value, where + "." + name, values.emplace_back(name, "").second);
}

/// Reads the fields of one finding; one that the file lacks keeps its default.
class Reader {
 public:
  Reader(const Json& json, std::string where) : json_(json), where_(std::move(where)) { require_table(json_, where_); }

  template <class T>
  void operator()(const char* key, T& field) const {
    if (const Json* const found = find(key)) load(*found, at(key), field);
  }

  void text(const char* key, std::string& field) const {
    if (const Json* const found = find(key); found && !found->is_null()) load(*found, at(key), field);
  }

  template <class Visit>
  void table(const char* key, Visit visit) const {
    if (const Json* const found = find(key)) {
      Reader inner(*found, at(key));
      visit(inner);
    }
  }

  template <class T>
  void pair(const char* key, T& first, T& second) const {
    const Json* const found = find(key);
    if (!found) return;
    if (!found->is_array() || found->size() != 2) throw Misfit{at(key), "is not a pair"};
    load((*found)[0], at(key), first);
    load((*found)[1], at(key), second);
  }

  void range(const char* key, double& low, double& high) const {
    if (const Json* const found = find(key); found && !found->is_null()) pair(key, low, high);
  }

  template <class T, class Visit>
  void each(const char* key, std::vector<T>& list, Visit visit) const {
    const Json* const found = find(key);
    if (!found) return;
    require_list(*found, at(key));
    list.assign(found->size(), T{});
    for (std::size_t i = 0; i < list.size(); ++i) {
      Reader inner((*found)[i], fmt::format("{}[{}]", at(key), i));
      visit(inner, list[i]);
    }
  }

  template <class T, class... Fields>
  void columns(std::vector<T>& list, FieldColumn<T, Fields>... column) const {
    list.clear();
    const auto read = [&](const auto& one) {
      const Json* const found = find(one.key);
      if (!found) return;
      require_list(*found, at(one.key));
      if (list.empty()) list.resize(found->size());
      if (list.size() != found->size())
        throw Misfit{at(one.key), fmt::format("has {} values, the list beside it {}", found->size(), list.size())};
      for (std::size_t i = 0; i < list.size(); ++i)
        load((*found)[i], fmt::format("{}[{}]", at(one.key), i), list[i].*one.field);
    };
    (read(column), ...);
  }

  template <class T, class Name, class Value>
  void keyed(const char* key, std::vector<T>& list, Name T::*name, Value T::*value) const {
    const Json* const found = find(key);
    if (!found) return;
    require_table(*found, at(key));
    list.clear();
    for (const auto& [text, number] : found->items()) {
      T& item = list.emplace_back();
      load(Json(text), at(key), item.*name);
      load(number, at(key) + "." + text, item.*value);
    }
  }

  template <class T, class Field>
  void gathered(const char* key, std::vector<T>& list, const char* name_key, std::string T::*name,
                std::optional<Field> T::*field) const {
    const Json* const found = find(key);
    if (!found) return;
    require_list(*found, at(key));
    for (std::size_t i = 0; i < found->size(); ++i) {
      const Reader one((*found)[i], fmt::format("{}[{}]", at(key), i));
      std::string of;
      one(name_key, of);
      for (T& item : list)
        if (item.*name == of) load(one.json_, one.where_, (item.*field).emplace());
    }
  }

  template <class Make>
  void shown(const char*, Make) const {}

 private:
  const Json* find(const char* key) const {
    const auto found = json_.find(key);
    return found == json_.end() ? nullptr : &*found;
  }
  std::string at(const char* key) const { return where_.empty() ? key : where_ + "." + key; }

  const Json& json_;
  std::string where_;
};

void load(const Json& json, const std::string& where, SupportReport& support) {
  support = {};
  if (!json.is_null()) visit_fields(Reader(json, where), support);
}

template <class T>
requires std::is_aggregate_v<T>
void load(const Json& json, const std::string& where, T& value) { visit_fields(Reader(json, where), value); }

// ---- layout

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
  json.update(save(report));
  return json;
}

nlohmann::ordered_json plans_json(const std::vector<CaseReport>& cases) {
  Writer writer;
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
    load(json, "", report);
    return report;
  } catch (const Misfit& misfit) {
    const std::string place = misfit.where.empty() ? path : path + ": " + misfit.where;
    throw data::InputError(data::ExitStatus::bad_data, {place, misfit.what, remedy});
  } catch (const Json::exception& damage) {
    throw data::InputError(data::ExitStatus::bad_data, {path, fmt::format("is damaged: {}", damage.what()), remedy});
  }
}

std::string to_text(const SurrogateReport& report) { return compact(save(report)); }

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
