#pragma once
// The visitor of field_list.hpp that reads a finding from report.json. A key that the file lacks leaves the field at
// its default.
#include <fmt/format.h>

#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "uq/findings/field_writer.hpp"

namespace uq::fields {

/// A value of the wrong kind, and its place. It is found deep inside, and told to the user with the file's name.
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

inline void load(const Json& json, const std::string& where, double& value) {
  if (json == infinite || json == minus_infinite)
    value = (json == infinite ? 1.0 : -1.0) * std::numeric_limits<double>::infinity();
  else if (json.is_null())
    value = std::numeric_limits<double>::quiet_NaN();
  else if (json.is_number())
    value = json.get<double>();
  else
    throw Misfit{where, "is not a number"};
}

inline void load(const Json& json, const std::string& where, int& value) {
  if (!json.is_number_integer()) throw Misfit{where, "is not a whole number"};
  value = json.get<int>();
}

inline void load(const Json& json, const std::string& where, bool& value) {
  if (!json.is_boolean()) throw Misfit{where, "is neither true nor false"};
  value = json.get<bool>();
}

inline void load(const Json& json, const std::string& where, std::string& value) {
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

inline void require_list(const Json& json, const std::string& where) {
  if (!json.is_array()) throw Misfit{where, "is not a list"};
}

inline void require_table(const Json& json, const std::string& where) {
  if (!json.is_object()) throw Misfit{where, "is not a table"};
}

template <class T>
void load(const Json& json, const std::string& where, std::vector<T>& values) {
  require_list(json, where);
  values.assign(json.size(), T{});
  for (std::size_t i = 0; i < values.size(); ++i) load(json[i], fmt::format("{}[{}]", where, i), values[i]);
}

inline void load(const Json& json, const std::string& where, std::map<std::string, double>& values) {
  require_table(json, where);
  values.clear();
  for (const auto& [name, value] : json.items()) load(value, where + "." + name, values[name]);
}

inline void load(const Json& json, const std::string& where, Texts& values) {
  require_table(json, where);
  values.clear();
  for (const auto& [name, value] : json.items()) load(value, where + "." + name, values.emplace_back(name, "").second);
}

/// Reads the fields of one finding; a field that the file lacks keeps its default.
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

inline void load(const Json& json, const std::string& where, SupportReport& support) {
  support = {};
  if (!json.is_null()) visit_fields(Reader(json, where), support);
}

template <class T>
requires std::is_aggregate_v<T>
void load(const Json& json, const std::string& where, T& value) { visit_fields(Reader(json, where), value); }

}  // namespace uq::fields
