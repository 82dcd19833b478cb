#include "data/unit_text.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "data/number_text.hpp"

namespace data {
namespace {

/// Units as Russian, Chinese, Japanese and Korean instruments write them, and ours; what holds another stands before
/// it.
constexpr std::array<std::pair<std::string_view, std::string_view>, 18> units_of_other_scripts{{{"об/мин", "r/min"},
                                                                                                {"转/分钟", "r/min"},
                                                                                                {"转/分", "r/min"},
                                                                                                {"回転/分", "r/min"},
                                                                                                {"回/分", "r/min"},
                                                                                                {"회/분", "r/min"},
                                                                                                {"сек", "s"},
                                                                                                {"с", "s"},
                                                                                                {"秒", "s"},
                                                                                                {"초", "s"},
                                                                                                {"мин", "min"},
                                                                                                {"分钟", "min"},
                                                                                                {"分", "min"},
                                                                                                {"Н", "N"},
                                                                                                {"м", "m"},
                                                                                                {"毫", "m"},
                                                                                                {"牛", "N"},
                                                                                                {"米", "m"}}};

/// The text with one spelling for the signs of micro, product, power and the blank, and in our script.
std::string normalised(std::string_view given) {
  std::string text(trimmed(given));
  for (const auto& [from, to] : std::initializer_list<std::pair<std::string_view, std::string_view>>{
           {"\xc2\xb5", "u"},     {"\xce\xbc", "u"},     {"\xc2\xb7", " "},
           {"\xe2\x8b\x85", " "}, {"\xe2\x88\x99", " "}, {"\xe3\x83\xbb", " "},  // of Japanese keyboards
           {"\xef\xbd\xa5", " "}, {"\xe2\x80\xa2", " "}, {"\xc3\x97", " "},
           {"\xc2\xa0", " "},     {"\xe2\x81\xbb", "-"}, {"\xe2\x81\xb0", "0"},
           {"\xc2\xb9", "1"},     {"\xc2\xb2", "2"},     {"\xc2\xb3", "3"},
           {"\xe2\x81\xb4", "4"}, {"\xe2\x81\xb5", "5"}, {"\xe2\x81\xb6", "6"},
           {"\xe2\x88\x92", "-"}, {"^-1", "-1"},         {"*", " "}})
    replace_all(text, from, to);
  for (const auto& [from, to] : units_of_other_scripts) replace_all(text, from, to);
  return std::string(trimmed(text));
}

/// Words for the units of a force and a length as their short signs: "Newton-Meter", "inch-pounds", "ft-lbs".
std::string short_words(const std::string& text) {
  std::string small = lower_case(text);
  for (const auto& [from, to] : std::initializer_list<std::pair<std::string_view, std::string_view>>{{"newton", "N"},
                                                                                                     {"meters", "m"},
                                                                                                     {"meter", "m"},
                                                                                                     {"metres", "m"},
                                                                                                     {"metre", "m"},
                                                                                                     {"inches", "in"},
                                                                                                     {"inch", "in"},
                                                                                                     {"foot", "ft"},
                                                                                                     {"feet", "ft"},
                                                                                                     {"pounds", "lb"},
                                                                                                     {"pound", "lb"},
                                                                                                     {"ounces", "oz"},
                                                                                                     {"ounce", "oz"},
                                                                                                     {"lbs", "lb"}})
    replace_all(small, from, to);
  return small == lower_case(text) ? text : small;
}

/// What stands before the force in a text of a force and a length, in either order: "m" in "mNm". Empty where the text
/// is no such pair, or has before the force what is no prefix of SI.
std::optional<std::string_view> prefix_of_force(std::string_view text, std::string_view force,
                                                std::string_view length) {
  static constexpr std::array<std::string_view, 9> prefixes{"", "u", "m", "c", "d", "da", "k", "n", "M"};
  const auto before_force = [&](std::string_view part) -> std::optional<std::string_view> {
    if (!part.ends_with(force)) return {};
    part.remove_suffix(force.size());
    if (std::find(prefixes.begin(), prefixes.end(), part) == prefixes.end()) return {};
    return part;
  };
  if (text.ends_with(length))
    if (const auto prefix = before_force(text.substr(0, text.size() - length.size()))) return prefix;
  if (text.starts_with(length)) return before_force(text.substr(length.size()));
  return {};
}

/// "mNm" -> "mN m", "kgfcm" -> "kgf cm", "in-lb" -> "lbf in": a force and a length in any order, with any sign or none
/// between them. A mass stands for its weight; grams do so beside mm and cm alone, as "gm" may be grams. "NM" is no
/// other unit than Nm.
std::string torque_spelling(const std::string& text) {
  /// A force as instruments write it, and its weight's name or its number of them in UDUNITS.
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 11> forces{{{"kgf", "kgf"},
                                                                                         {"gf", "0.001 kgf"},
                                                                                         {"kp", "kgf"},
                                                                                         {"ozf", "0.0625 lbf"},
                                                                                         {"lbf", "lbf"},
                                                                                         {"lb", "lbf"},
                                                                                         {"oz", "0.0625 lbf"},
                                                                                         {"kg", "kgf"},
                                                                                         {"dyn", "dyne"},
                                                                                         {"N", "N"},
                                                                                         {"g", "0.001 kgf"}}};
  static constexpr std::array<std::string_view, 5> lengths{"mm", "cm", "m", "in", "ft"};
  std::string joined;
  for (const char c : short_words(text))
    if (c != ' ' && c != '.' && c != '-') joined += c;
  if (joined == "NM") return "N m";
  for (const auto& [force, udunits] : forces)
    for (const std::string_view length : lengths) {
      const auto prefix = prefix_of_force(joined, force, length);
      if (!prefix || (force != "N" && !prefix->empty())) continue;
      if (force == "g" && joined != "gcm" && joined != "gmm") continue;
      return std::string(*prefix).append(udunits).append(" ").append(length);
    }
  return text;
}

/// Revolutions per minute and per second in several languages; a speed that is neither stays empty.
std::string rotation_spelling(const std::string& text) {
  if (text == "mHz") return "0.06 rpm";
  std::string word = lower_case(text);
  word.erase(std::remove_if(word.begin(), word.end(), [](char c) { return c == ' ' || c == '.'; }), word.end());
  for (const char* per_minute : {"1/min", "min-1",  "u/min",   "r/min",     "rev/min",  "umdr/min",   "rpm",
                                 "upm",   "/min",   "cpm",     "tr/min",    "tpm",      "revs/min",   "rot/min",
                                 "umin",  "ob/min", "obr/min", "tours/min", "giri/min", "rounds/min", "ot/min"})
    if (word == per_minute) return "rpm";
  for (const char* per_second : {"hz", "1/s", "s-1", "rps", "u/s", "r/s", "rev/s", "revs/s", "tr/s", "/s"})
    if (word == per_second) return "60 rpm";
  if (word == "khz") return "60000 rpm";
  if (word == "deg/s" || word == "degs-1" || word == "\xc2\xb0/s") return "degree/s";
  return {};
}

std::string time_spelling(const std::string& text) {
  std::string word = lower_case(text);
  if (word.ends_with('.')) word.pop_back();
  static const std::map<std::string, std::vector<std::string>> words{
      {"s", {"sec", "secs", "sek", "second", "seconds", "sekunden"}},
      {"ms", {"msec", "msecs", "millisec", "milliseconds"}},
      {"us", {"usec", "usecs", "microseconds"}},
      {"min", {"min", "mins", "minute", "minutes", "minuten"}},
      {"h", {"hr", "hrs", "hour", "hours", "std", "stunden"}}};
  for (const auto& [unit, names] : words)
    if (std::find(names.begin(), names.end(), word) != names.end()) return unit;
  return {};
}

std::string angle_spelling(const std::string& text) {
  const std::string word = lower_case(text);
  return word == "deg" || word == "deg." || word == "degs" ? "degree" : std::string();
}

/// "hh:mm:ss", "dd.mm.yyyy hh:mm": the form of a clock's times, which stands where a unit would.
bool is_form_of_times(std::string_view text) {
  return text.find("mm") != std::string_view::npos && text.find(':') != std::string_view::npos &&
         lower_case(text).find_first_not_of("hmsdyf:.,/- tz") == std::string::npos;
}

/// Whether the text is what instruments write for a number without unit.
bool is_word_for_none(const std::string& text) {
  const std::string word = lower_case(text);
  return word == "dimensionless" || word == "unitless" || word == "dimless";
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
  if ((text == "-" || lower_case(text) == "none" || is_word_for_none(text)) && convertible(dimension, "1"))
    return parse_unit("1");
  if (convertible(dimension, "rpm"))
    if (auto unit = known(rotation_spelling(text), dimension)) return unit;
  if (convertible(dimension, "s"))
    if (auto unit = known(time_spelling(text), dimension)) return unit;
  if (convertible(dimension, "degree"))
    if (auto unit = known(angle_spelling(text), dimension)) return unit;
  return {};
}

bool is_unit(std::string_view given) {
  const std::string text = normalised(given);
  if (text == "-" || text == "1" || text == "%" || is_form_of_times(text) || is_word_for_none(text)) return true;
  if (plain_number(text, DecimalMark::point) || plain_number(text, DecimalMark::comma)) return false;  // "5.00E+01"
  if (text.find_first_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ\xc2") == std::string::npos) return false;
  try {
    parse_unit(text);
    return true;
  } catch (const std::invalid_argument&) {
  }
  for (const char* dimension : {"N m", "rpm", "s", "degree"})
    if (unit_meant(text, dimension)) return true;
  return false;
}

namespace {

/// Brackets, slash and per cent as Japanese and Chinese keyboards write them, as wide as a letter of theirs.
std::string half_width(std::string text) {
  for (const auto& [from, to] :
       std::initializer_list<std::pair<std::string_view, std::string_view>>{{"\xef\xbc\x88", "("},
                                                                            {"\xef\xbc\x89", ")"},
                                                                            {"\xef\xbc\xbb", "["},
                                                                            {"\xef\xbc\xbd", "]"},
                                                                            {"\xef\xbc\x8f", "/"},
                                                                            {"\xef\xbc\x85", "%"}})
    replace_all(text, from, to);
  return text;
}

}  // namespace

Heading read_heading(std::string_view given) {
  const std::string text = half_width(std::string(trimmed(given)));
  const auto part = [&](std::size_t from, std::size_t count = std::string::npos) {
    return std::string(trimmed(std::string_view(text).substr(from, count)));
  };
  for (const char* marks : {"[]", "()", "{}"}) {
    const auto open = text.rfind(marks[0]);
    if (open == std::string::npos || open == 0 || text.back() != marks[1]) continue;
    const std::string unit = part(open + 1, text.size() - open - 2);
    std::string name = part(0, open);
    if (marks[0] == '(' && name.size() > 1 && name.ends_with('/'))  // "omega/(rad/s)", as ISO 80000-1 has it
      name = trimmed(name.substr(0, name.size() - 1));
    if (!unit.empty() && (marks[0] == '[' || (is_unit(unit) && unit != "1"))) return {name, unit};
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

std::optional<Heading> heading_with_unit(std::string_view given, std::string_view dimension) {
  const std::string text(trimmed(given));
  const auto parted = [&](std::size_t at, std::string unit) -> std::optional<Heading> {
    if (!unit_meant(unit, dimension)) return {};
    return Heading{std::string(trimmed(std::string_view(text).substr(0, at))), std::move(unit)};
  };
  for (const std::string_view mark : {" in ", "_", ":", "<", " "}) {
    const auto at = mark == " in " ? text.find(mark) : text.rfind(mark);
    if (at == std::string::npos || at == 0) continue;
    std::string unit(trimmed(std::string_view(text).substr(at + mark.size())));
    if (mark == "<" && unit.ends_with('>')) unit.pop_back();
    if (auto found = parted(at, unit)) return found;
  }
  // A name that may hold no other sign writes rad/s and N m with the same: "omega_rad_s", "torque_N_m".
  for (auto at = text.find('_', 1); at != std::string::npos; at = text.find('_', at + 1))
    for (const char between : {'/', ' '}) {
      std::string unit = text.substr(at + 1);
      if (const auto per = unit.find("_per_"); per != std::string::npos) unit.replace(per, 5, "_");
      std::replace(unit.begin(), unit.end(), '_', between);
      if (auto found = parted(at, unit)) return found;
    }
  return {};
}

}  // namespace data
