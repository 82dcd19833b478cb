#pragma once
// The visitor of field_list.hpp that writes a finding into report.json. A number becomes a number, a list a list, a
// struct a table. JSON has no infinities, and no NaN.
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "uq/findings/fields.hpp"

namespace uq::fields {

using Json = nlohmann::ordered_json;
using Texts = std::vector<std::pair<std::string, std::string>>;

constexpr const char *infinite = "infinity", *minus_infinite = "-infinity";

// The overloads call each other, so all are declared first.
inline Json save(double value) {
  if (std::isinf(value)) return value > 0.0 ? infinite : minus_infinite;
  return std::isnan(value) ? Json(nullptr) : Json(value);
}
inline Json save(int value) { return value; }
inline Json save(bool value) { return value; }
inline Json save(const std::string& value) { return value; }
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

inline Json save(const std::map<std::string, double>& values) {
  Json object = Json::object();
  for (const auto& [name, value] : values) object[name] = save(value);
  return object;
}

inline Json save(const Texts& values) {
  Json object = Json::object();
  for (const auto& [name, value] : values) object[name] = value;
  return object;
}

/// Writes the fields of one finding (field_list.hpp says what each call means).
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

/// Writes a support report; null where there were no runs to ask.
inline Json save(const SupportReport& support) { return support.known ? save_fields(support) : Json(nullptr); }

template <class T>
requires std::is_aggregate_v<T> Json save(const T& value) { return save_fields(value); }

}  // namespace uq::fields
