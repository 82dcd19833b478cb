#pragma once
// The inside of the study reader, shared by section.cpp, study_value.cpp and study_file.cpp only. It notes for each
// table which keys were asked for (known), which of these were there (used), and which tables were opened. A key that
// is there but not used is an error.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "data/study_file.hpp"

namespace data {

/// The line of a value in its file; 0 for a value that no file holds.
inline std::size_t line_of(const toml::node& node) { return node.source().begin.line; }

struct StudyFile::State {
  struct Located {
    std::size_t line;
    Problem problem;
  };
  toml::table root;
  std::string shown;  ///< path as the user gave it, for messages
  std::string absolute;
  std::string folder;
  std::map<std::pair<const toml::table*, std::string>, std::string> overridden;  ///< the --set text of a key
  std::map<const toml::table*, std::set<std::string>> known, used;
  std::set<const toml::table*> opened;
  std::vector<Located> problems;
  std::set<std::pair<std::string, std::string>> told;
  std::map<std::string, AskedKey> asked;
  std::set<std::string> looked_for;

  void add(std::size_t line, Problem problem) {
    if (!told.emplace(problem.place, problem.what).second) return;  // two readers may ask for one key
    problems.push_back({line, std::move(problem)});
  }
};

struct Section::Node {
  std::shared_ptr<StudyFile::State> state;
  const toml::table* table = nullptr;  ///< null: not in the file
  std::string name;
  std::size_t line = 0;  ///< line of the table, or of the nearest table above it that is in the file

  std::string dotted(std::string_view key) const {
    if (key.empty()) return name;
    return name.empty() ? std::string(key) : fmt::format("{}.{}", name, key);
  }

  std::size_t line_of(std::string_view key) const {
    if (table != nullptr) {
      if (const auto found = table->find(key); found != table->cend() && found->first.source().begin.line > 0) {
        return found->first.source().begin.line;
      }
    }
    return line;
  }

  std::string place(std::string_view key) const {
    const auto set = state->overridden.find({table, std::string(key)});
    if (set != state->overridden.end()) return fmt::format("--set {}: {}", set->second, dotted(key));
    const std::size_t at = line_of(key);
    std::string text = at > 0 ? fmt::format("{}:{}", state->shown, at) : state->shown;
    if (const std::string full = dotted(key); !full.empty()) text += ": " + full;
    return text;
  }

  void problem(std::string_view key, std::string what, std::string remedy) const {
    state->add(line_of(key), {place(key), std::move(what), std::move(remedy)});
  }

  /// The value of a key, marked as used; null when missing.
  const toml::node* ask(std::string_view key) const {
    if (table == nullptr) return nullptr;
    state->known[table].emplace(key);
    const toml::node* node = table->get(key);
    if (node != nullptr) state->used[table].emplace(key);
    return node;
  }

  /// Notes how a key is read. Some keys are read in several ways: a number, or a table. Text that is read first is a
  /// look at what stands there.
  void note(std::string_view key, const AskedKey& how) const {
    const auto [known, is_new] = state->asked.emplace(dotted(key), how);
    std::string& type = known->second.type;
    if (is_new || type.find(how.type) != std::string::npos || how.type == "text") return;
    if (type == "text")
      known->second = how;
    else
      type += " or " + how.type;
  }

  /// Asks for a value that must be there: a missing one is a problem.
  const toml::node* demand(std::string_view key, std::string_view example) const {
    const toml::node* node = ask(key);
    if (node == nullptr) problem(key, "is missing", fmt::format("add a line like {} = {}", key, example));
    return node;
  }
};

}  // namespace data
