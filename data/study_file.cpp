// Opening a study, the --set overrides, and the keys that nobody asked for.
#include "data/study_file.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "data/atomic_file.hpp"
#include "data/edit_distance.hpp"
#include "data/study_keys.hpp"
#include "data/study_node.hpp"

namespace data {
namespace {

using Node = Section::Node;

/// Marks all keys that an override has brought, at any depth: a problem in one names the override.
void mark_overridden(StudyFile::State& state, const toml::table* table, const std::string& key,
                     const std::string& text) {
  state.overridden[{table, key}] = text;
  const auto mark_all = [&](const toml::table* inner) {
    if (inner != nullptr)
      for (const auto& [name, value] : *inner) mark_overridden(state, inner, std::string(name.str()), text);
  };
  const toml::node* value = table->get(key);
  mark_all(value->as_table());
  if (const auto* array = value->as_array())
    for (const toml::node& element : *array) mark_all(element.as_table());
}

/// Applies one --set text to the tree.
void apply(StudyFile::State& state, const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto fail = [&](ExitStatus status, std::string what, std::string remedy) {
    throw InputError(status, Problem{fmt::format("--set {}", text), std::move(what), std::move(remedy)});
  };
  std::vector<std::string> path;
  std::stringstream dotted(text.substr(0, equals));
  for (std::string part; std::getline(dotted, part, '.');) {
    part.erase(0, part.find_first_not_of(" \t"));
    part.erase(part.find_last_not_of(" \t") + 1);
    path.push_back(part);
  }
  if (equals == std::string::npos || path.empty() || std::count(path.begin(), path.end(), "") > 0) {
    fail(ExitStatus::usage, "is not KEY=VALUE", "write it like --set training.runs=80");
  }

  toml::node* node = &state.root;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    toml::node* next = nullptr;
    if (auto* table = node->as_table()) {
      if (!table->contains(path[i])) table->insert(path[i], toml::table{});
      next = table->get(path[i]);
    } else if (auto* array = node->as_array()) {  // by place from 0, or by name
      for (std::size_t j = 0; j < array->size() && next == nullptr; ++j) {
        const auto* element = array->get(j)->as_table();
        if (std::to_string(j) == path[i] || (element != nullptr && (*element)["name"].value_or("") == path[i])) {
          next = array->get(j);
        }
      }
    }
    if (next == nullptr) {
      fail(ExitStatus::bad_study,
           fmt::format("'{}' is not in the study", fmt::join(path.begin(), path.begin() + i + 1, ".")),
           "name a key of the study file");
    }
    node = next;
  }
  const std::string above = fmt::format("{}", fmt::join(path.begin(), path.end() - 1, "."));
  if (const auto* entries = node->as_array(); entries != nullptr && !entries->empty()) {
    const auto* first = entries->front().as_table();
    const std::string name = first != nullptr ? (*first)["name"].value_or("0") : "0";
    const bool one = entries->size() == 1;
    fail(ExitStatus::bad_study,
         fmt::format("'{}' has {}", above, one ? "one entry" : fmt::format("{} entries", entries->size())),
         fmt::format("name {}, or its place from 0: {}.{}.{}", one ? "it" : "one of them", above, name, path.back()));
  }
  auto* table = node->as_table();
  if (table == nullptr) {
    fail(ExitStatus::bad_study, fmt::format("'{}' holds no keys", above), "name a key of a section of the study file");
  }

  const std::string value = text.substr(equals + 1);
  toml::table parsed;
  try {
    if (value.find_first_of("\r\n") == std::string::npos)
      parsed = toml::parse(std::string_view(fmt::format("v = {}", value)));
  } catch (const toml::parse_error&) {  // not a TOML value: text
  }
  if (parsed.size() == 1 && parsed.contains("v")) {
    parsed["v"].visit([&](const auto& leaf) { table->insert_or_assign(path.back(), leaf); });
  } else {
    table->insert_or_assign(path.back(), value);
  }
  mark_overridden(state, table, path.back(), text);
}

/// Adds a problem for each key below an opened table that nobody asked for.
void find_unknown(StudyFile::State& state, const Node& node) {
  const std::set<std::string>& used = state.used[node.table];
  const std::set<std::string>& known = state.known[node.table];
  for (const auto& [key, value] : *node.table) {
    const std::string name(key.str());
    if (used.count(name) == 0) {
      if (!state.root.contains("rig") && !find_study_keys(node.dotted(name)).empty()) {
        node.problem(name, "is read of a study that has a [rig], and this one has none", "remove it, or give a [rig]");
        continue;
      }
      const std::vector<std::string> candidates(known.begin(), known.end());
      const auto near = nearest(name, candidates);
      std::string remedy = "remove the line";
      if (near) {
        remedy = fmt::format("did you mean '{}'?", *near);
      } else if (!candidates.empty()) {
        remedy = fmt::format("known here: {}", fmt::join(candidates, ", "));
        const std::size_t point = node.name.rfind('.');
        if (value.is_table() && point != std::string::npos)  // [materials.sand-0.5]: TOML reads a table of a table
          remedy += fmt::format("; a name with a point stands in quotes: [{}.\"{}.{}\"]", node.name.substr(0, point),
                                node.name.substr(point + 1), name);
      }
      node.problem(name, "is not a key that demcal knows", remedy);
      continue;
    }
    const auto descend = [&](const toml::node& child, const std::string& label) {
      const toml::table* table = child.as_table();
      if (table == nullptr || state.opened.count(table) == 0) return;
      const std::size_t line = line_of(child) > 0 ? line_of(child) : node.line;
      find_unknown(state, Node{node.state, table, label, line});
    };
    descend(value, node.dotted(name));
    if (const auto* array = value.as_array()) {
      for (std::size_t i = 0; i < array->size(); ++i) {
        const auto* table = array->get(i)->as_table();
        if (table == nullptr) continue;
        descend(*table, fmt::format("{}.{}", node.dotted(name), (*table)["name"].value_or(std::to_string(i))));
      }
    }
  }
}

}  // namespace

StudyFile StudyFile::open(const std::string& path, const std::vector<std::string>& overrides) {
  namespace fs = std::filesystem;
  auto state = std::make_shared<State>();
  fs::path file(path);
  std::error_code ignored;
  const bool folder = fs::is_directory(file, ignored);
  if (folder) file /= "study.toml";
  state->shown = file.lexically_normal().string();
  std::string text;
  try {
    text = read_file(file.string());
  } catch (const InputError& error) {
    throw InputError(ExitStatus::missing_input,
                     Problem{state->shown, error.problems.front().what,
                             folder ? "the folder must hold a study.toml; `demcal new FOLDER` writes one"
                                    : "give a study file, or a folder that holds study.toml"});
  }
  state->absolute = fs::absolute(file).lexically_normal().string();
  state->folder = fs::path(state->absolute).parent_path().string();
  try {
    state->root = toml::parse(std::string_view(text), std::string_view(state->shown));
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    throw InputError(ExitStatus::bad_study, Problem{fmt::format("{}:{}:{}", state->shown, at.line, at.column),
                                                    std::string(error.description()), "correct the TOML syntax there"});
  }
  for (const std::string& assignment : overrides) apply(*state, assignment);
  state->opened.insert(&state->root);
  StudyFile study;
  study.state_ = std::move(state);
  return study;
}

Section StudyFile::root() const {
  return Section(std::make_shared<Section::Node>(Section::Node{state_, &state_->root, "", 0}));
}
std::string StudyFile::path() const { return state_->absolute; }
std::string StudyFile::folder() const { return state_->folder; }

const std::map<std::string, AskedKey>& StudyFile::asked() const { return state_->asked; }
const std::set<std::string>& StudyFile::looked_for() const { return state_->looked_for; }

std::vector<Problem> StudyFile::recorded() const {
  std::vector<State::Located> located = state_->problems;
  std::stable_sort(located.begin(), located.end(), [](const auto& a, const auto& b) { return a.line < b.line; });
  std::vector<Problem> problems;
  for (State::Located& item : located) problems.push_back(std::move(item.problem));
  return problems;
}

void StudyFile::finish() const {
  find_unknown(*state_, Section::Node{state_, &state_->root, "", 0});
  if (!state_->problems.empty()) throw InputError(ExitStatus::bad_study, recorded());
}

}  // namespace data
