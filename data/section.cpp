// The getters of a Section: each marks its key as used and records what is wrong with the value. Line numbers are
// toml++'s.
#include <algorithm>
#include <cmath>
#include <optional>

#include "data/edit_distance.hpp"
#include "data/study_node.hpp"
#include "data/study_value.hpp"

namespace data {
namespace {

using Node = Section::Node;

std::string shown_default(const std::optional<double>& fallback) {
  return fallback && std::isfinite(*fallback) ? fmt::format("{:.10g}", *fallback) : "";
}

/// The value at `key`, or the fallback; what is missing or wrong is recorded.
double read_one(const Node& node, std::string_view key, std::string_view si_unit, std::optional<double> fallback,
                const ExpectedQuantity& expected) {
  node.note(key, {"quantity", std::string(si_unit), expected.range, shown_default(fallback), {}});
  const std::string example =
      fmt::format("\"1 {}\"", expected.default_unit != nullptr ? expected.default_unit->symbol : si_unit);
  const toml::node* value = fallback ? node.ask(key) : node.demand(key, convertible(si_unit, "1") ? "0.5" : example);
  if (value == nullptr) return missing_value(expected.range, fallback);
  return read_quantity(node, key, *value, si_unit, expected).value_or(missing_value(expected.range, fallback));
}

Section open_section(const Node& parent, const toml::table* table, std::string name, std::size_t line) {
  if (table != nullptr) parent.state->opened.insert(table);
  return Section(std::make_shared<Node>(Node{parent.state, table, std::move(name), line > 0 ? line : parent.line}));
}

}  // namespace

bool Section::exists() const { return node_->table != nullptr; }
bool Section::has(std::string_view key) const {
  node_->state->looked_for.insert(node_->dotted(key));
  if (node_->table == nullptr) return false;
  node_->state->known[node_->table].emplace(key);
  return node_->table->contains(key);
}
ValueKind Section::kind(std::string_view key) const {
  if (!has(key)) return ValueKind::missing;
  const toml::node& value = *node_->table->get(key);
  if (value.is_number()) return ValueKind::number;
  if (value.is_string()) return ValueKind::text;
  if (value.is_boolean()) return ValueKind::flag;
  return value.is_table() ? ValueKind::table : ValueKind::other;
}
std::string Section::place(std::string_view key) const { return node_->place(key); }
std::string Section::name() const { return node_->name; }

double Section::number(std::string_view key, Range range, std::optional<double> fallback) const {
  node_->note(key, {"number", "", range, shown_default(fallback), {}});
  const toml::node* node = fallback ? node_->ask(key) : node_->demand(key, "0.5");
  if (node == nullptr) return missing_value(range, fallback);
  const std::optional<double> value = bare_number(*node);
  if (!value) {
    node_->problem(key, fmt::format("{} is not a number", shown_value(*node)), "write a number without quotes or unit");
    return missing_value(range, fallback);
  }
  return check_range(*node_, key, *value, range, {shown_value(*node), BoundText{}});
}

std::int64_t Section::integer(std::string_view key, Range range, std::optional<std::int64_t> fallback) const {
  node_->note(key, {"whole number", "", range, fallback ? std::to_string(*fallback) : "", {}});
  const toml::node* node = fallback ? node_->ask(key) : node_->demand(key, "1");
  std::optional<double> real_fallback;
  if (fallback) real_fallback = static_cast<double>(*fallback);
  const auto otherwise = fallback.value_or(static_cast<std::int64_t>(missing_value(range, real_fallback)));
  if (node == nullptr) return otherwise;
  const auto* whole = node->as_integer();
  if (whole == nullptr) {
    node_->problem(key, fmt::format("{} is not a whole number", shown_value(*node)),
                   "write a whole number without quotes");
    return otherwise;
  }
  const auto value = static_cast<double>(whole->get());
  const double inside = check_range(*node_, key, value, range, {shown_value(*node), BoundText{}});
  return inside == value ? whole->get() : static_cast<std::int64_t>(inside);
}

double Section::quantity(std::string_view key, std::string_view si_unit, Range range, std::optional<double> fallback,
                         const Unit* default_unit) const {
  const bool differences = default_unit != nullptr && default_unit->of_differences;
  return read_one(*node_, key, si_unit, fallback, {range, default_unit, differences});
}

double Section::difference(std::string_view key, std::string_view si_unit, Range range, std::optional<double> fallback,
                           const Unit* default_unit) const {
  return read_one(*node_, key, si_unit, fallback, {range, default_unit, true});
}

std::string Section::text(std::string_view key, const std::optional<std::string>& fallback) const {
  node_->note(key, {"text", "", {}, fallback.value_or(""), {}});
  const toml::node* node = fallback ? node_->ask(key) : node_->demand(key, "\"...\"");
  if (node == nullptr) return fallback.value_or("");
  if (const auto* text = node->as_string()) return text->get();
  node_->problem(key, fmt::format("{} is not text", shown_value(*node)), "write it in quotes");
  return fallback.value_or("");
}

std::string Section::choice(std::string_view key, const std::vector<std::string>& options,
                            const std::optional<std::string>& fallback) const {
  node_->note(key, {"choice", "", {}, fallback.value_or(""), options});
  const toml::node* node = fallback ? node_->ask(key) : node_->demand(key, fmt::format("\"{}\"", options.front()));
  std::string otherwise = fallback.value_or(options.front());
  if (node == nullptr) return otherwise;
  const auto* text = node->as_string();
  if (text != nullptr && std::find(options.begin(), options.end(), text->get()) != options.end()) return text->get();
  std::string remedy = fmt::format("choose one of '{}'", fmt::join(options, "', '"));
  if (text != nullptr) {
    if (const auto near = nearest(text->get(), options)) remedy += fmt::format("; did you mean '{}'?", *near);
  }
  node_->problem(key, fmt::format("{} is not one of the choices", shown_value(*node)), remedy);
  return otherwise;
}

bool Section::flag(std::string_view key, bool fallback) const {
  node_->note(key, {"true or false", "", {}, fallback ? "true" : "false", {}});
  const toml::node* node = node_->ask(key);
  if (node == nullptr) return fallback;
  if (const auto* flag = node->as_boolean()) return flag->get();
  node_->problem(key, fmt::format("{} is neither true nor false", shown_value(*node)),
                 "write true or false without quotes");
  return fallback;
}

std::vector<std::string> Section::texts(std::string_view key, bool required) const {
  node_->note(key, {"list of texts", "", {}, "", {}});
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
    node_->problem(key, fmt::format("{} is not a list of texts", shown_value(*node)), "write it like [\"a\", \"b\"]");
  } else if (required && values.empty()) {
    node_->problem(key, "is an empty list", "name at least one");
  }
  return values;
}

std::vector<std::string> Section::labels(std::string_view key) const {
  node_->note(key, {"list of lines", "", {}, "", {}});
  const toml::node* node = node_->ask(key);
  std::vector<std::string> values;
  if (node == nullptr) return values;
  const auto* array = node->as_array();
  bool all = array != nullptr;
  if (array != nullptr) {
    for (const toml::node& element : *array) {
      if (const auto* text = element.as_string())
        values.push_back(text->get());
      else if (const auto* number = element.as_integer())
        values.push_back(std::to_string(number->get()));
      else
        all = false;
    }
  }
  if (!all)
    node_->problem(key, fmt::format("{} is not a list of lines", shown_value(*node)),
                   "write it like [31, \"training.csv:44\"]");
  return values;
}

std::vector<double> Section::quantities(std::string_view key, std::string_view si_unit, Range range,
                                        const Unit* default_unit) const {
  node_->note(key, {"list of quantities", std::string(si_unit), range, "", {}});
  const toml::node* node = node_->ask(key);
  std::vector<double> values;
  if (node == nullptr) return values;
  const auto* array = node->as_array();
  if (array == nullptr) {
    node_->problem(key, fmt::format("{} is not a list", shown_value(*node)), "write the values in [ ]");
    return values;
  }
  for (const toml::node& element : *array) {
    // A problem of one value is recorded. A stand-in takes its place, so that nobody says that there are too few
    // values.
    values.push_back(
        read_quantity(*node_, key, element, si_unit, {range, default_unit}).value_or(missing_value(range, {})));
  }
  return values;
}

Section Section::child(std::string_view key) const {
  node_->note(key, {"table", "", {}, "", {}});
  const toml::node* node = node_->ask(key);
  const toml::table* table = node != nullptr ? node->as_table() : nullptr;
  if (node != nullptr && table == nullptr) {
    node_->problem(key, fmt::format("{} is not a table", shown_value(*node)),
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
  node_->note(key, {"tables", "", {}, "", {}});
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
    node_->problem(key, fmt::format("{} is not a list of tables", shown_value(*node)),
                   fmt::format("write [[{}]], with two brackets, above each", node_->dotted(key)));
  }
  return sections;
}

void Section::pass_over(const std::vector<std::string>& keys) const {
  if (node_->table != nullptr) node_->state->used[node_->table].insert(keys.begin(), keys.end());
}

void Section::problem(std::string_view key, std::string what, std::string remedy) const {
  node_->problem(key, std::move(what), std::move(remedy));
}

}  // namespace data
