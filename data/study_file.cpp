// The bookkeeping behind a Section: per table, which keys were asked for (known), which of them were there (used), and
// which tables were opened; a key that is there but not used is an error. Line numbers are toml++'s.
#include "data/study_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>

#include "data/edit_distance.hpp"

namespace data {

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

  void add(std::size_t line, Problem problem) {
    for (const Located& old : problems) {  // two readers may ask for one key
      if (old.problem.place == problem.place && old.problem.what == problem.what) return;
    }
    problems.push_back({line, std::move(problem)});
  }
};

struct Section::Node {
  std::shared_ptr<StudyFile::State> state;
  const toml::table* table = nullptr;  ///< null: not in the file
  std::string name;
  std::size_t line = 0;  ///< of the table, or of the nearest table above it that is in the file

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

  /// `ask` for a value that must be there.
  const toml::node* demand(std::string_view key, std::string_view example) const {
    const toml::node* node = ask(key);
    if (node == nullptr) problem(key, "is missing", fmt::format("add a line like {} = {}", key, example));
    return node;
  }
};

namespace {

using Node = Section::Node;

std::string show(const toml::node& node) {
  if (const auto* text = node.as_string()) return fmt::format("'{}'", text->get());
  if (const auto* whole = node.as_integer()) return fmt::format("{}", whole->get());
  if (const auto* real = node.as_floating_point()) return fmt::format("{}", real->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (node.is_array()) return "a list";
  if (node.is_table()) return "a table";
  return "a date or time";
}

std::optional<double> bare_number(const toml::node& node) {
  if (const auto* whole = node.as_integer()) return static_cast<double>(whole->get());
  if (const auto* real = node.as_floating_point()) return real->get();
  return {};
}

/// How the bounds of a range are written, in the unit that the reader used.
struct Display {
  const Unit* unit = nullptr;  ///< null: SI
  std::string_view symbol;
  std::string text(double si) const {
    const double value = unit != nullptr ? unit->from_si(si) : si;
    return symbol.empty() || symbol == "1" ? fmt::format("{:.10g}", value) : fmt::format("{:.10g} {}", value, symbol);
  }
};

double clamp_to(double value, const Range& range) {
  if (std::isnan(value)) value = 0.0;
  return std::min(std::max(value, range.low), range.high);
}

double missing_value(const Range& range, const std::optional<double>& fallback) {
  return fallback.value_or(std::isfinite(range.low) ? range.low : std::isfinite(range.high) ? range.high : 0.0);
}

/// Records a problem when the value is outside; returns the nearest value inside.
double check_range(const Node& node, std::string_view key, double value, const Range& range,
                   const std::pair<std::string, Display>& shown) {
  const auto& [text, display] = shown;
  std::string allowed;
  if (std::isfinite(range.low)) {
    allowed = fmt::format("{} {}", range.open_low ? "above" : "from", display.text(range.low));
  }
  if (std::isfinite(range.high)) {
    allowed += fmt::format("{}{} {}", allowed.empty() ? "" : " ", range.open_high ? "below" : "up to",
                           display.text(range.high));
  }
  const std::string remedy = allowed.empty() ? "choose a finite number" : fmt::format("choose a value {}", allowed);
  if (!std::isfinite(value)) {
    node.problem(key, fmt::format("{} is not a finite number", text), remedy);
  } else if (value < range.low || (range.open_low && value == range.low)) {
    node.problem(key,
                 range.open_low
                     ? fmt::format("{} is not above {}", text, display.text(range.low))
                     : fmt::format("{} is below the smallest value {} allowed", text, display.text(range.low)),
                 remedy);
  } else if (value > range.high || (range.open_high && value == range.high)) {
    node.problem(key,
                 range.open_high
                     ? fmt::format("{} is not below {}", text, display.text(range.high))
                     : fmt::format("{} is above the largest value {} allowed", text, display.text(range.high)),
                 remedy);
  }
  return clamp_to(value, range);
}

/// A number with its unit, in SI; records what is wrong with it.
std::optional<double> read_quantity(const Node& node, std::string_view key, const toml::node& value,
                                    std::string_view si_unit, const std::pair<Range, const Unit*>& expected) {
  const auto& [range, default_unit] = expected;
  const bool dimensionless = convertible(si_unit, "1");
  std::optional<double> number = bare_number(value);
  std::string unit_text;
  if (const auto* text = value.as_string()) {
    const std::string& written = text->get();
    const char* begin = written.data() + std::min(written.find_first_not_of(" \t+"), written.size());
    double parsed = 0.0;
    const auto [rest, failure] = std::from_chars(begin, written.data() + written.size(), parsed);
    if (failure == std::errc{}) {
      number = parsed;
      unit_text.assign(rest, static_cast<std::size_t>(written.data() + written.size() - rest));
      unit_text.erase(0, unit_text.find_first_not_of(" \t"));
      if (const auto last = unit_text.find_last_not_of(" \t"); last != std::string::npos) unit_text.resize(last + 1);
    }
  }
  const std::string example = default_unit != nullptr ? fmt::format("\"1 {}\"", default_unit->symbol)
                              : dimensionless         ? std::string("0.5")
                                                      : fmt::format("\"1 {}\"", si_unit);
  if (!number) {
    node.problem(key, fmt::format("{} is not a quantity", show(value)),
                 fmt::format("write a number with its unit, like {}", example));
    return {};
  }
  if (unit_text.empty()) {
    if (default_unit != nullptr) {
      return check_range(node, key, default_unit->to_si(*number), range,
                         {show(value), Display{default_unit, default_unit->symbol}});
    }
    if (dimensionless) return check_range(node, key, *number, range, {show(value), Display{}});
    node.problem(key, fmt::format("{} has no unit", show(value)),
                 fmt::format("write it with a unit of {}, like \"{:.10g} {}\"", si_unit, *number, si_unit));
    return {};
  }
  try {
    if (!convertible(unit_text, si_unit)) {
      node.problem(key,
                   fmt::format("{} has the wrong unit: '{}' does not measure what {} does", show(value), unit_text,
                               dimensionless ? "a plain number" : fmt::format("'{}'", si_unit)),
                   fmt::format("write it like {}", example));
      return {};
    }
    return check_range(node, key, parse_unit(unit_text).to_si(*number), range,
                       {show(value), Display{nullptr, si_unit}});
  } catch (const std::invalid_argument& unknown) {
    node.problem(key, fmt::format("{} has an unknown unit: {}", show(value), unknown.what()),
                 fmt::format("write it like {}", example));
    return {};
  }
}

Section open_section(const Node& parent, const toml::table* table, std::string name, std::size_t line) {
  if (table != nullptr) parent.state->opened.insert(table);
  return Section(std::make_shared<Node>(Node{parent.state, table, std::move(name), line > 0 ? line : parent.line}));
}

std::size_t line_of(const toml::node& node) { return node.source().begin.line; }

}  // namespace

bool Section::exists() const { return node_->table != nullptr; }
bool Section::has(std::string_view key) const { return node_->table != nullptr && node_->table->contains(key); }
std::string Section::place(std::string_view key) const { return node_->place(key); }
std::string Section::name() const { return node_->name; }

double Section::number(std::string_view key, Range range, std::optional<double> fallback) const {
  const toml::node* node = fallback ? node_->ask(key) : node_->demand(key, "0.5");
  if (node == nullptr) return missing_value(range, fallback);
  const std::optional<double> value = bare_number(*node);
  if (!value) {
    node_->problem(key, fmt::format("{} is not a number", show(*node)), "write a number without quotes or unit");
    return missing_value(range, fallback);
  }
  return check_range(*node_, key, *value, range, {show(*node), Display{}});
}

std::int64_t Section::integer(std::string_view key, Range range, std::optional<std::int64_t> fallback) const {
  const toml::node* node = fallback ? node_->ask(key) : node_->demand(key, "1");
  std::optional<double> real_fallback;
  if (fallback) real_fallback = static_cast<double>(*fallback);
  const auto otherwise = fallback.value_or(static_cast<std::int64_t>(missing_value(range, real_fallback)));
  if (node == nullptr) return otherwise;
  const auto* whole = node->as_integer();
  if (whole == nullptr) {
    node_->problem(key, fmt::format("{} is not a whole number", show(*node)), "write a whole number without quotes");
    return otherwise;
  }
  const auto value = static_cast<double>(whole->get());
  const double inside = check_range(*node_, key, value, range, {show(*node), Display{}});
  return inside == value ? whole->get() : static_cast<std::int64_t>(inside);
}

double Section::quantity(std::string_view key, std::string_view si_unit, Range range, std::optional<double> fallback,
                         const Unit* default_unit) const {
  const std::string example = fmt::format("\"1 {}\"", default_unit != nullptr ? default_unit->symbol : si_unit);
  const toml::node* node = fallback ? node_->ask(key) : node_->demand(key, convertible(si_unit, "1") ? "0.5" : example);
  if (node == nullptr) return missing_value(range, fallback);
  return read_quantity(*node_, key, *node, si_unit, {range, default_unit}).value_or(missing_value(range, fallback));
}

std::string Section::text(std::string_view key, std::optional<std::string> fallback) const {
  const toml::node* node = fallback ? node_->ask(key) : node_->demand(key, "\"...\"");
  if (node == nullptr) return fallback.value_or("");
  if (const auto* text = node->as_string()) return text->get();
  node_->problem(key, fmt::format("{} is not text", show(*node)), "write it in quotes");
  return fallback.value_or("");
}

std::string Section::choice(std::string_view key, const std::vector<std::string>& options,
                            std::optional<std::string> fallback) const {
  const toml::node* node = fallback ? node_->ask(key) : node_->demand(key, fmt::format("\"{}\"", options.front()));
  const std::string otherwise = fallback.value_or(options.front());
  if (node == nullptr) return otherwise;
  const auto* text = node->as_string();
  if (text != nullptr && std::find(options.begin(), options.end(), text->get()) != options.end()) return text->get();
  std::string remedy = fmt::format("choose one of '{}'", fmt::join(options, "', '"));
  if (text != nullptr) {
    if (const auto near = nearest(text->get(), options)) remedy += fmt::format("; did you mean '{}'?", *near);
  }
  node_->problem(key, fmt::format("{} is not one of the choices", show(*node)), remedy);
  return otherwise;
}

bool Section::flag(std::string_view key, bool fallback) const {
  const toml::node* node = node_->ask(key);
  if (node == nullptr) return fallback;
  if (const auto* flag = node->as_boolean()) return flag->get();
  node_->problem(key, fmt::format("{} is neither true nor false", show(*node)), "write true or false without quotes");
  return fallback;
}

std::vector<std::string> Section::texts(std::string_view key, bool required) const {
  const toml::node* node = required ? node_->demand(key, "[\"...\"]") : node_->ask(key);
  std::vector<std::string> values;
  if (node == nullptr) return values;
  const auto* array = node->as_array();
  bool all_text = array != nullptr;
  if (array != nullptr) {
    for (const toml::node& element : *array) {
      if (const auto* text = element.as_string())
        values.push_back(text->get());
      else
        all_text = false;
    }
  }
  if (!all_text) {
    node_->problem(key, fmt::format("{} is not a list of texts", show(*node)), "write it like [\"a\", \"b\"]");
  } else if (required && values.empty()) {
    node_->problem(key, "is an empty list", "name at least one");
  }
  return values;
}

std::vector<double> Section::quantities(std::string_view key, std::string_view si_unit, Range range,
                                        const Unit* default_unit) const {
  const toml::node* node = node_->ask(key);
  std::vector<double> values;
  if (node == nullptr) return values;
  const auto* array = node->as_array();
  if (array == nullptr) {
    node_->problem(key, fmt::format("{} is not a list", show(*node)), "write the values in [ ]");
    return values;
  }
  for (const toml::node& element : *array) {
    if (const auto value = read_quantity(*node_, key, element, si_unit, {range, default_unit}))
      values.push_back(*value);
  }
  return values;
}

Section Section::child(std::string_view key) const {
  const toml::node* node = node_->ask(key);
  const toml::table* table = node != nullptr ? node->as_table() : nullptr;
  if (node != nullptr && table == nullptr) {
    node_->problem(key, fmt::format("{} is not a table", show(*node)),
                   fmt::format("write [{}] above its keys, or {} = {{ ... }}", node_->dotted(key), key));
  }
  return open_section(*node_, table, node_->dotted(key), node_->line_of(key));
}

std::vector<std::pair<std::string, Section>> Section::children() const {
  std::vector<std::pair<std::string, Section>> sections;
  if (node_->table == nullptr) return sections;
  std::vector<std::pair<toml::source_position, std::string>> order;  // toml++ iterates by name
  for (const auto& [key, value] : *node_->table) {
    if (value.is_table()) order.emplace_back(key.source().begin, std::string(key.str()));
  }
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [position, key] : order) sections.emplace_back(key, child(key));
  return sections;
}

std::vector<Section> Section::array(std::string_view key) const {
  std::vector<Section> sections;
  const toml::node* node = node_->ask(key);
  if (node == nullptr) return sections;
  const auto* array = node->as_array();
  std::size_t index = 0;
  if (array != nullptr) {
    for (const toml::node& element : *array) {
      const toml::table* table = element.as_table();
      if (table == nullptr) break;
      const std::string label = (*table)["name"].value_or(std::to_string(index));
      sections.push_back(
          open_section(*node_, table, fmt::format("{}.{}", node_->dotted(key), label), line_of(element)));
      ++index;
    }
  }
  if (array == nullptr || index < array->size()) {
    node_->problem(key, fmt::format("{} is not a list of tables", show(*node)),
                   fmt::format("write [[{}]], with two brackets, above each", node_->dotted(key)));
  }
  return sections;
}

void Section::problem(std::string_view key, std::string what, std::string remedy) const {
  node_->problem(key, std::move(what), std::move(remedy));
}

namespace {

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
  auto* table = node->as_table();
  if (table == nullptr) {
    fail(ExitStatus::bad_study, fmt::format("'{}' holds no keys", fmt::join(path.begin(), path.end() - 1, ".")),
         "name a key of a section of the study file");
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
  state.overridden[{table, path.back()}] = text;
}

/// Adds a problem for each key below an opened table that nobody asked for.
void find_unknown(StudyFile::State& state, const Node& node) {
  const std::set<std::string>& used = state.used[node.table];
  const std::set<std::string>& known = state.known[node.table];
  for (const auto& [key, value] : *node.table) {
    const std::string name(key.str());
    if (used.count(name) == 0) {
      const std::vector<std::string> candidates(known.begin(), known.end());
      const auto near = nearest(name, candidates);
      std::string remedy = "remove the line";
      if (near) {
        remedy = fmt::format("did you mean '{}'?", *near);
      } else if (!candidates.empty()) {
        remedy = fmt::format("known here: {}", fmt::join(candidates, ", "));
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
  std::ifstream stream(file, std::ios::binary);
  if (fs::is_directory(file, ignored) || !stream) {
    const bool there = fs::exists(file, ignored);
    throw InputError(ExitStatus::missing_input,
                     Problem{state->shown, there ? "cannot be read" : "there is no such file",
                             folder ? "the folder must hold a study.toml; `demcal new FOLDER` writes one"
                                    : "give a study file, or a folder that holds study.toml"});
  }
  std::ostringstream content;
  content << stream.rdbuf();
  state->absolute = fs::absolute(file).lexically_normal().string();
  state->folder = fs::path(state->absolute).parent_path().string();
  try {
    const std::string text = content.str();
    state->root = toml::parse(std::string_view(text), std::string_view(state->shown));
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    throw InputError(ExitStatus::bad_study, Problem{fmt::format("{}:{}:{}", state->shown, at.line, at.column),
                                                    std::string(error.description()), "correct the TOML syntax there"});
  }
  for (const std::string& text : overrides) apply(*state, text);
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

void StudyFile::finish() const {
  find_unknown(*state_, Section::Node{state_, &state_->root, "", 0});
  if (state_->problems.empty()) return;
  std::vector<State::Located> located = state_->problems;
  std::stable_sort(located.begin(), located.end(), [](const auto& a, const auto& b) { return a.line < b.line; });
  std::vector<Problem> problems;
  for (State::Located& item : located) problems.push_back(std::move(item.problem));
  throw InputError(ExitStatus::bad_study, std::move(problems));
}

}  // namespace data
