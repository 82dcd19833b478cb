// The getters of a Section: each marks its key as used and records what is wrong with the value. Line numbers are
// toml++'s.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "data/edit_distance.hpp"
#include "data/study_node.hpp"
#include "data/unit_text.hpp"

namespace data {
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
    return fmt::format("{:.10g}{}", value, behind_number(symbol));
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

struct Expected {
  Range range;
  const Unit* default_unit = nullptr;  ///< unit of a bare number
  bool difference = false;             ///< units count without their offset
};

/// A number with its unit, in SI; records what is wrong with it.
std::optional<double> read_quantity(const Node& node, std::string_view key, const toml::node& value,
                                    std::string_view si_unit, const Expected& expected) {
  const auto& [range, default_unit, difference] = expected;
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
    if (const auto meant = unit_meant(unit_text, si_unit))
      return check_range(node, key, (difference ? meant->differences() : *meant).to_si(*number), range,
                         {show(value), Display{nullptr, si_unit}});
    parse_unit(unit_text);  // throws where it is none
    node.problem(key,
                 fmt::format("{} has the wrong unit: '{}' does not measure what {} does", show(value), unit_text,
                             dimensionless ? "a plain number" : fmt::format("'{}'", si_unit)),
                 fmt::format("write it like {}", example));
    return {};
  } catch (const std::invalid_argument& unknown) {
    node.problem(key, fmt::format("{} has an unknown unit: {}", show(value), unknown.what()),
                 fmt::format("write it like {}", example));
    return {};
  }
}

std::string shown_default(const std::optional<double>& fallback) {
  return fallback && std::isfinite(*fallback) ? fmt::format("{:.10g}", *fallback) : "";
}

/// The value at `key`, or the fallback; what is missing or wrong is recorded.
double read_one(const Node& node, std::string_view key, std::string_view si_unit, std::optional<double> fallback,
                const Expected& expected) {
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
    node_->problem(key, fmt::format("{} is not a number", show(*node)), "write a number without quotes or unit");
    return missing_value(range, fallback);
  }
  return check_range(*node_, key, *value, range, {show(*node), Display{}});
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
    node_->problem(key, fmt::format("{} is not a whole number", show(*node)), "write a whole number without quotes");
    return otherwise;
  }
  const auto value = static_cast<double>(whole->get());
  const double inside = check_range(*node_, key, value, range, {show(*node), Display{}});
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
  node_->problem(key, fmt::format("{} is not text", show(*node)), "write it in quotes");
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
  node_->problem(key, fmt::format("{} is not one of the choices", show(*node)), remedy);
  return otherwise;
}

bool Section::flag(std::string_view key, bool fallback) const {
  node_->note(key, {"true or false", "", {}, fallback ? "true" : "false", {}});
  const toml::node* node = node_->ask(key);
  if (node == nullptr) return fallback;
  if (const auto* flag = node->as_boolean()) return flag->get();
  node_->problem(key, fmt::format("{} is neither true nor false", show(*node)), "write true or false without quotes");
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
    node_->problem(key, fmt::format("{} is not a list of texts", show(*node)), "write it like [\"a\", \"b\"]");
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
    node_->problem(key, fmt::format("{} is not a list of lines", show(*node)),
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
    node_->problem(key, fmt::format("{} is not a list", show(*node)), "write the values in [ ]");
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
    node_->problem(key, fmt::format("{} is not a list of tables", show(*node)),
                   fmt::format("write [[{}]], with two brackets, above each", node_->dotted(key)));
  }
  return sections;
}

void Section::problem(std::string_view key, std::string what, std::string remedy) const {
  node_->problem(key, std::move(what), std::move(remedy));
}

}  // namespace data
