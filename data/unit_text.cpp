#include "data/unit_text.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "data/number_text.hpp"

namespace data {
namespace {

/// One spelling for the signs of micro, product, power and the blank.
std::string normalised(std::string_view given) {
  std::string text(trimmed(given));
  for (const auto& [from, to] :
       std::initializer_list<std::pair<std::string_view, std::string_view>>{{"\xc2\xb5", "u"},
                                                                            {"\xce\xbc", "u"},
                                                                            {"\xc2\xb7", " "},
                                                                            {"\xe2\x8b\x85", " "},
                                                                            {"\xe2\x88\x99", " "},
                                                                            {"\xe2\x80\xa2", " "},
                                                                            {"\xc2\xa0", " "},
                                                                            {"\xe2\x81\xbb", "-"},
                                                                            {"\xe2\x81\xb0", "0"},
                                                                            {"\xc2\xb9", "1"},
                                                                            {"\xc2\xb2", "2"},
                                                                            {"\xc2\xb3", "3"},
                                                                            {"\xe2\x81\xb4", "4"},
                                                                            {"\xe2\x81\xb5", "5"},
                                                                            {"\xe2\x81\xb6", "6"},
                                                                            {"\xe2\x88\x92", "-"},
                                                                            {"^-1", "-1"},
                                                                            {"*", " "}})
    replace_all(text, from, to);
  return std::string(trimmed(text));
}

/// "mNm" -> "mN m", "kgfcm" -> "kgf cm", "in-lb" -> "lbf in": a force and a length in any order, with any sign or none
/// between them. A mass stands for its weight.
std::string torque_spelling(const std::string& text) {
  static constexpr std::array forces{"kgf", "gf", "kp", "ozf", "lbf", "lb", "oz", "kg", "dyn", "N"};
  static constexpr std::array lengths{"mm", "cm", "m", "in", "ft"};
  static constexpr std::array prefixes{"", "u", "m", "c", "k", "n", "M"};
  std::string joined;
  for (const char c : text)
    if (c != ' ' && c != '.' && c != '-') joined += c;
  for (const char* force : forces)
    for (const char* length : lengths)
      for (const char* prefix : prefixes)
        if (joined == std::string(prefix) + force + length || joined == std::string(length) + prefix + force) {
          const std::string name = force;
          const std::string udunits = name == "kp" || name == "kg" ? "kgf"
                                      : name == "lb"               ? "lbf"
                                      : name == "oz"               ? "ozf"
                                      : name == "dyn"              ? "dyne"
                                                                   : name;
          if (name != "N" && *prefix != '\0') continue;
          if (udunits == "gf") return std::string("0.001 kgf ") + length;
          if (udunits == "ozf") return std::string("0.0625 lbf ") + length;
          return prefix + udunits + " " + length;
        }
  return text;
}

std::optional<Unit> known(const std::string& symbol, std::string_view dimension) {
  try {
    if (!symbol.empty() && convertible(symbol, dimension)) return parse_unit(symbol);
  } catch (const std::invalid_argument&) {
  }
  return {};
}

}  // namespace

std::optional<Unit> unit_meant(std::string_view given, std::string_view dimension) {
  if (auto as_written = known(std::string(trimmed(given)), dimension)) return as_written;
  const std::string text = normalised(given);
  if (auto unit = known(text, dimension)) return unit;
  if (auto unit = known(torque_spelling(text), dimension)) return unit;
  if (text == "-" && convertible(dimension, "1")) return parse_unit("1");
  if (convertible(dimension, "rpm")) {
    std::string word = lower_case(text);
    word.erase(std::remove(word.begin(), word.end(), ' '), word.end());
    for (const char* per_minute :
         {"1/min", "min-1", "u/min", "r/min", "rev/min", "u./min", "umdr/min", "rpm", "upm", "r.p.m.", "/min", "cpm"})
      if (word == per_minute) return parse_unit("rpm");
    for (const char* per_second : {"hz", "1/s", "s-1", "rps", "u/s", "r/s", "rev/s", "/s"})
      if (word == per_second) return parse_unit("60 rpm");
  }
  if (convertible(dimension, "s"))
    for (const char* second : {"sec", "secs", "sec.", "sek", "sek.", "seconds"})
      if (lower_case(text) == second) return parse_unit("s");
  if (convertible(dimension, "s") && (lower_case(text) == "msec" || lower_case(text) == "millisec"))
    return parse_unit("ms");
  return {};
}

bool is_unit(std::string_view given) {
  const std::string text = normalised(given);
  if (text == "-" || text == "1" || text == "%") return true;
  if (text.find_first_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ\xc2") == std::string::npos) return false;
  try {
    parse_unit(text);
    return true;
  } catch (const std::invalid_argument&) {
  }
  for (const char* dimension : {"N m", "rpm", "s"})
    if (unit_meant(text, dimension)) return true;
  return false;
}

Heading read_heading(std::string_view given) {
  const std::string text(trimmed(given));
  const auto part = [&](std::size_t from, std::size_t count = std::string::npos) {
    return std::string(trimmed(std::string_view(text).substr(from, count)));
  };
  for (const char* marks : {"[]", "()"}) {
    const auto open = text.rfind(marks[0]);
    if (open == std::string::npos || open == 0 || text.back() != marks[1]) continue;
    const std::string unit = part(open + 1, text.size() - open - 2);
    if (!unit.empty() && (marks[0] == '[' || (is_unit(unit) && unit != "1"))) return {part(0, open), unit};
  }
  for (const char* mark : {" / ", ",", "/"}) {
    // The unit may hold a slash itself: "speed / 1/min", "speed/1/min".
    const auto at = mark[0] == ',' ? text.rfind(mark) : text.find(mark);
    if (at == std::string::npos || at == 0) continue;
    const std::string unit = part(at + std::string_view(mark).size());
    if (is_unit(unit) && unit != "1" && unit != "-") return {part(0, at), unit};
  }
  return {text, ""};
}

}  // namespace data
