#include "data/number_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace data {
namespace {

bool digit(char c) { return c >= '0' && c <= '9'; }

std::string without_plus(std::string_view text) { return std::string(text.substr(text.starts_with('+') ? 1 : 0)); }

bool reads_as_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return !text.empty() && rest == text.data() + text.size() && error != std::errc::invalid_argument;
}

/// Whether what stands before `end` is digits in groups of three behind `mark`, the first group shorter.
bool in_groups(std::string_view text, char mark, std::size_t end) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) {
    text.remove_prefix(1);
    --end;
  }
  std::size_t run = 0;
  bool first = true;
  for (std::size_t i = 0; i < end; ++i) {
    if (digit(text[i])) {
      ++run;
    } else if (text[i] == mark) {
      if (first ? run < 1 || run > 3 : run != 3) return false;
      first = false;
      run = 0;
    } else {
      return false;
    }
  }
  return !first && run == 3;
}

/// Digits, sign, exponent and the two marks alone.
bool only_number_signs(std::string_view text) {
  return std::any_of(text.begin(), text.end(), digit) &&
         text.find_first_not_of("0123456789+-.,eEdD") == std::string_view::npos;
}

/// "1.0D+00" and "1.0-100" of Fortran with an E.
void fortran_exponent(std::string& text) {
  const auto mark = text.find_first_of("dD");
  const bool has_point = text.find('.') != std::string::npos;
  if (mark != std::string::npos && mark > 0 && mark + 1 < text.size() &&
      (has_point || text[mark + 1] == '+' || text[mark + 1] == '-')) {
    text[mark] = 'E';
    return;
  }
  const auto sign = text.find_first_of("+-", 1);
  if (has_point && sign != std::string::npos && digit(text[sign - 1]) && text.size() - sign == 4)
    text.insert(sign, "E");
}

}  // namespace

std::string counted(std::size_t count, std::string_view what) {
  return std::to_string(count).append(" ").append(what).append(count == 1 ? "" : "s");
}

std::string_view trimmed(std::string_view text) {
  for (;;) {
    const std::size_t before = text.size();
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    text = text.substr(first, text.find_last_not_of(" \t") - first + 1);
    if (text.starts_with("\xc2\xa0")) text.remove_prefix(2);
    if (text.ends_with("\xc2\xa0")) text.remove_suffix(2);
    if (text.size() == before) return text;
  }
}

std::optional<std::string> plain_number(std::string_view given, DecimalMark mark) {
  if (mark == DecimalMark::point && reads_as_number(given)) return without_plus(given);
  if (given.empty() || given.size() > 64) return {};
  std::string text(given);
  replace_all(text, "\xe2\x88\x92", "-");  // U+2212
  // A sign in a column of its own: "+  1.74".
  if (text.front() == '+' || text.front() == '-')
    text.erase(1, std::min(text.find_first_not_of(' ', 1), text.size()) - 1);
  for (const std::string_view gap : {"\xc2\xa0", "\xe2\x80\xaf", "\xe2\x80\x89", "\xe2\x80\x99", " ", "'"}) {
    std::string marked = text;
    replace_all(marked, gap, "'");
    const std::size_t end = std::min(marked.find_first_of(".,eE"), marked.size());
    if (marked != text || gap == "'")
      if (in_groups(marked, '\'', end)) {
        marked.erase(std::remove(marked.begin(), marked.end(), '\''), marked.end());
        text = marked;
        break;
      }
  }
  if (!only_number_signs(text)) return reads_as_number(text) ? std::optional(without_plus(text)) : std::nullopt;
  const char decimal = mark == DecimalMark::comma ? ',' : '.', other = mark == DecimalMark::comma ? '.' : ',';
  if (text.find(other) != std::string::npos) {
    const std::size_t end = std::min(text.find_first_of(std::string{decimal, 'e', 'E'}), text.size());
    if (!in_groups(text, other, end)) return {};
    text.erase(std::remove(text.begin(), text.end(), other), text.end());
  }
  if (mark == DecimalMark::comma) {
    if (std::count(text.begin(), text.end(), ',') > 1) return {};
    std::replace(text.begin(), text.end(), ',', '.');
  }
  fortran_exponent(text);
  return reads_as_number(text) ? std::optional(without_plus(text)) : std::nullopt;
}

std::optional<NumberWithUnit> number_with_unit(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  NumberWithUnit found;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), found.value);
  if (error != std::errc{}) return {};
  const auto length = static_cast<std::size_t>(rest - text.data());
  found.digits = text.substr(0, length);
  found.unit = trimmed(text.substr(length));
  return found;
}

std::string lower_case(std::string_view text) {
  std::string small(text);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return small;
}

bool is_missing(std::string_view given) {
  const std::string_view text = trimmed(given);
  for (const char* signs : {"*", "-.", "#", "?"})
    if (text.find_first_not_of(signs) == std::string_view::npos) return true;  // also when it is empty
  std::string lower = lower_case(text);
  if (lower.front() == '-' || lower.front() == '+') lower.erase(0, 1);
  static constexpr std::array known{"nan",         "n/a",          "na",           "#n/a",    "#na",     "#nv",
                                    "#value!",     "#wert!",       "#div/0!",      "#num!",   "#zahl!",  "#ref!",
                                    "null",        "#null!",       "none",         "(null)",  "missing", "1.#qnan",
                                    "nil",         "<na>",         "no data",      "nodata",  "bad",     "bad input",
                                    "i/o timeout", "#name?",       "#calc!",       "1.#snan", "1.#ind",  "1.#inf",
                                    "nan(ind)",    "\xe2\x80\x93", "\xe2\x80\x94", "."};
  if (std::find(known.begin(), known.end(), lower) != known.end()) return true;
  return lower.starts_with("1.#") || lower.starts_with("1,#");
}

bool is_overload(std::string_view given) {
  std::string word = lower_case(trimmed(given));
  if (!word.empty() && word.find_first_not_of('+') == std::string::npos) return true;
  std::erase_if(word, [](char c) { return c == ' ' || c == '.' || c == '+' || c == '-'; });
  static constexpr std::array known{"ol",         "ovl",       "ovld",     "ovf",         "ovr",
                                    "ofl",        "over",      "overload", "overflow",    "overrange",
                                    "outofrange", "overlimit", "under",    "underrange",  "underflow",
                                    "inf",        "infinity",  "1#inf",    "\xe2\x88\x9e"};
  return std::find(known.begin(), known.end(), word) != known.end();
}

Evidence decimal_evidence(std::string_view text) {
  if (!only_number_signs(text)) return Evidence::none;
  const std::size_t mantissa = std::min(text.find_first_of("eEdD"), text.size());
  const std::string_view front = text.substr(0, mantissa);
  const auto points = std::count(front.begin(), front.end(), '.'), commas = std::count(front.begin(), front.end(), ',');
  if (points > 0 && commas > 0) {
    const bool comma_last = front.rfind(',') > front.rfind('.');
    if (!plain_number(text, comma_last ? DecimalMark::comma : DecimalMark::point)) return Evidence::none;
    return comma_last ? Evidence::comma : Evidence::point;
  }
  if (commas == 0 && points == 0) return Evidence::none;
  const char mark = commas > 0 ? ',' : '.';
  const bool groups = mantissa == text.size() && in_groups(front, mark, front.size()) &&
                      front.find_first_of("123456789") == front.find_first_of("0123456789");
  if (commas + points > 1) return !groups ? Evidence::none : commas > 0 ? Evidence::point : Evidence::comma;
  if (groups) return commas > 0 ? Evidence::maybe_comma : Evidence::maybe_point;
  if (!plain_number(text, commas > 0 ? DecimalMark::comma : DecimalMark::point)) return Evidence::none;
  return commas > 0 ? Evidence::comma : Evidence::point;
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

}  // namespace data
