#include "data/time_text.hpp"

#include <array>
#include <charconv>
#include <chrono>

#include "data/number_text.hpp"

namespace data {
namespace {

/// Reads what a time is made of from the front of a text.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : text_(text) {}
  bool at_end() const { return text_.empty(); }
  char front() const { return text_.empty() ? '\0' : text_.front(); }
  bool take(char c) {
    if (front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  void blanks() {
    while (front() == ' ' || front() == '\t') text_.remove_prefix(1);
  }
  /// A whole number of at most `most` digits.
  std::optional<int> whole(std::size_t most) {
    std::size_t count = 0;
    while (count < text_.size() && text_[count] >= '0' && text_[count] <= '9') ++count;
    if (count == 0 || count > most) return {};
    int value = 0;
    std::from_chars(text_.data(), text_.data() + count, value);
    text_.remove_prefix(count);
    taken_ = count;
    return value;
  }
  std::size_t taken() const { return taken_; }  ///< digits of the last whole number
  /// ".123" or ",123"
  double fraction() {
    if (front() != '.' && front() != ',') return 0.0;
    text_.remove_prefix(1);
    double value = 0.0, place = 0.1;
    for (; front() >= '0' && front() <= '9'; place *= 0.1) {
      value += place * (front() - '0');
      text_.remove_prefix(1);
    }
    return value;
  }
  std::string_view rest() const { return text_; }
  /// The letters at the front, those that are not ASCII among them.
  std::string_view word() {
    std::size_t count = 0;
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c & 0x80) != 0; };
    while (count < text_.size() && is_letter(text_[count])) ++count;
    const std::string_view found = text_.substr(0, count);
    text_.remove_prefix(count);
    return found;
  }

 private:
  std::string_view text_;
  std::size_t taken_ = 0;
};

struct Date {
  double seconds = 0.0;
  bool either = false;
  DateOrder order = DateOrder::unknown;
};

std::optional<Date> days(int year, int month, int day) {
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return {};
  return Date{86400.0 * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count()), false};
}

/// The Monday of the year's first week is that of January 4 (ISO 8601).
std::optional<Date> day_of_week(int year, int week, int day) {
  if (week < 1 || week > 53 || day < 1 || day > 7) return {};
  const std::chrono::sys_days fourth(std::chrono::year(year) / std::chrono::January / 4);
  const std::chrono::sys_days monday = fourth - std::chrono::days(std::chrono::weekday(fourth).iso_encoding() - 1U);
  return Date{86400.0 * static_cast<double>((monday.time_since_epoch().count()) + 7 * (week - 1) + day - 1), false};
}

std::optional<Date> day_of_year(int year, int day) {
  if (day < 1 || day > 365 + static_cast<int>(std::chrono::year(year).is_leap())) return {};
  const std::chrono::sys_days first(std::chrono::year(year) / std::chrono::January / 1);
  return Date{86400.0 * static_cast<double>(first.time_since_epoch().count() + day - 1), false};
}

/// 2024-W18-5, 2024W185, 2024-124, all of them a Friday.
std::optional<Date> read_counted_date(Cursor& at) {
  Cursor ahead = at;
  const auto year = ahead.whole(4);
  if (!year || ahead.taken() != 4) return {};
  const bool parted = ahead.take('-');
  std::optional<Date> date;
  if (ahead.take('W')) {
    const auto week = parted ? ahead.whole(2) : ahead.whole(3);
    if (!week || ahead.taken() != (parted ? 2U : 3U) || (parted && !ahead.take('-'))) return {};
    const auto day = parted ? ahead.whole(1) : std::optional(*week % 10);
    if (!day) return {};
    date = day_of_week(*year, parted ? *week : *week / 10, *day);
  } else {
    const auto day = ahead.whole(3);
    if (!parted || !day || ahead.taken() != 3) return {};
    date = day_of_year(*year, *day);
  }
  if (date) at = ahead;
  return date;
}

/// Hours that a zone is ahead of UTC. Names that several zones have (BST, CST, IST) are not among them.
std::optional<double> zone_of(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, double>, 21> zones{
      {{"", 0.0},     {"Z", 0.0},    {"UTC", 0.0},  {"GMT", 0.0},  {"WET", 0.0},  {"WEST", 1.0}, {"CET", 1.0},
       {"CEST", 2.0}, {"MEZ", 1.0},  {"MESZ", 2.0}, {"EET", 2.0},  {"EEST", 3.0}, {"MSK", 3.0},  {"JST", 9.0},
       {"KST", 9.0},  {"EST", -5.0}, {"EDT", -4.0}, {"PST", -8.0}, {"PDT", -7.0}, {"Uhr", 0.0},  {"h", 0.0}}};
  for (const auto& [name, hours] : zones)
    if (word == name) return hours;
  return {};
}

/// The month that a word begins with, in English or German; 0: none.
int month_of(std::string_view word) {
  const std::string name = lower_case(word);
  static constexpr std::array months{"jan", "feb", "mar", "apr", "may", "jun",
                                     "jul", "aug", "sep", "oct", "nov", "dec"};
  for (std::size_t i = 0; i < months.size(); ++i)
    if (name.starts_with(months[i])) return static_cast<int>(i) + 1;
  for (const auto& [german, month] : {std::pair("mai", 5), std::pair("okt", 10), std::pair("dez", 12),
                                      std::pair("m\xc3\xa4r", 3), std::pair("mrz", 3)})
    if (name.starts_with(german)) return month;
  return 0;
}

/// 13-May-2024, 13 May 2024, May 13, 2024.
std::optional<Date> read_date_in_words(Cursor& at) {
  Cursor ahead = at;
  const auto mark = [&] {
    while (ahead.front() == '-' || ahead.front() == '/' || ahead.front() == '.' || ahead.front() == ',' ||
           ahead.front() == ' ')
      ahead.take(ahead.front());
  };
  auto day = ahead.whole(2);
  mark();
  const int month = month_of(ahead.word());
  if (month == 0) return {};
  mark();
  if (!day) day = ahead.whole(2);
  mark();
  const auto year = ahead.whole(4);
  if (!day || !year) return {};
  const auto date = days(*year < 100 ? 2000 + *year : *year, month, *day);
  if (date) at = ahead;
  return date;
}

/// 20240513, before T, a blank or _ and six digits of a time.
std::optional<ClockTime> read_compact(std::string_view text) {
  const auto digits = [&](std::size_t from, std::size_t count) {
    int value = 0;
    for (std::size_t i = from; i < from + count; ++i) {
      if (text[i] < '0' || text[i] > '9') return -1;
      value = 10 * value + (text[i] - '0');
    }
    return value;
  };
  if (text.size() < 15 || (text[8] != 'T' && text[8] != ' ' && text[8] != '_')) return {};
  const int day = digits(0, 8), time = digits(9, 6);
  const int hours = time / 10000, minutes = time / 100 % 100, seconds = time % 100;
  if (day < 19000000 || day >= 22000000 || time < 0 || minutes > 59 || seconds > 60) return {};
  if (hours > 24 || (hours == 24 && time % 10000 > 0)) return {};
  const auto date = days(day / 10000, day / 100 % 100, day % 100);
  if (!date) return {};
  Cursor rest(text.substr(15));
  const double fraction = rest.fraction();
  if (rest.front() == 'Z') rest.take('Z');
  if (!rest.at_end()) return {};
  const int of_day = hours * 3600 + minutes * 60 + seconds;
  return ClockTime{.seconds = date->seconds + of_day + fraction, .dated = true};
}

/// The date at the front; the cursor stands behind it, or where it was.
std::optional<Date> read_date(Cursor& at, DateOrder order) {
  Cursor ahead = at;
  const auto first = ahead.whole(4);
  if (!first) return {};
  const bool year_first = ahead.taken() == 4;
  const char mark = ahead.front();
  if ((mark != '-' && mark != '/' && mark != '.') || !ahead.take(mark)) return {};
  const auto second = ahead.whole(2);
  if (!second || !ahead.take(mark)) return {};
  const auto third = ahead.whole(4);
  if (!third) return {};
  std::optional<Date> date;
  if (year_first) {
    date = days(*first, *second, *third);
  } else if (mark != '/') {
    date = days(*third < 100 ? 2000 + *third : *third, *second, *first);
  } else {
    const int year = *third < 100 ? 2000 + *third : *third;
    const DateOrder shown = *first > 12    ? DateOrder::day_first
                            : *second > 12 ? DateOrder::month_first
                                           : DateOrder::unknown;
    const DateOrder read = shown != DateOrder::unknown ? shown : order;
    if (*first == *second || read == DateOrder::month_first)
      date = days(year, *first, *second);
    else if (read == DateOrder::day_first)
      date = days(year, *second, *first);
    else
      date = Date{.seconds = 0.0, .either = true};
    if (date) date->order = shown;
  }
  if (date) at = ahead;
  return date;
}

/// AM, pm, a.m.
bool is_half_of_day(std::string_view text) {
  std::string word = lower_case(text);
  std::erase(word, '.');
  return word == "am" || word == "pm";
}

}  // namespace

std::optional<ClockTime> read_time(std::string_view text, DateOrder order) {
  if (text.find(':') == std::string_view::npos) return read_compact(trimmed(text));
  Cursor at(trimmed(text));
  ClockTime time;
  auto date = read_date(at, order);
  if (!date) date = read_counted_date(at);
  if (!date) date = read_date_in_words(at);
  if (date) {
    time.dated = !date->either;
    time.day_or_month = date->either;
    time.order = date->order;
    time.seconds = date->seconds;
    if (!at.take('T')) at.blanks();
    at.take(',');
    at.blanks();
  }
  auto hours = at.whole(3);
  const int hours_most = date ? 24 : 999;  // without a date it may be a duration
  if (!hours || *hours > hours_most || !at.take(':')) return {};
  const auto minutes = at.whole(2);
  if (!minutes || *minutes > 59 || (date && *hours == 24 && *minutes > 0)) return {};
  double seconds = 0.0;
  if (at.take(':')) {
    const auto whole = at.whole(2);
    if (!whole || *whole > 60) return {};
    seconds = *whole + at.fraction();
    if (at.take(':')) {  // and milliseconds
      const auto thousandths = at.whole(3);
      if (!thousandths || at.taken() != 3) return {};
      seconds += 1e-3 * *thousandths;
    }
  } else if (at.front() == '.' || at.front() == ',') {  // minutes and seconds
    seconds = *minutes + at.fraction() + 60.0 * *hours;
    if (!at.at_end() || time.dated || time.day_or_month) return {};
    time.seconds = seconds;
    return time;
  } else {
    time.two_parts = !time.dated && !time.day_or_month;
  }
  at.blanks();
  if (is_half_of_day(at.rest())) {
    if (*hours < 1 || *hours > 12) return {};
    hours = *hours % 12 + (at.front() == 'P' || at.front() == 'p' ? 12 : 0);
  } else if (const auto zone = zone_of(at.rest())) {
    time.seconds -= 3600.0 * *zone;
  } else if (at.front() == '+' || at.front() == '-') {
    const double sign = at.take('-') ? -1.0 : (at.take('+'), 1.0);
    const auto offset = at.whole(4);
    if (!offset) return {};
    int zone_minutes = at.taken() > 2 ? *offset / 100 * 60 + *offset % 100 : *offset * 60;
    if (at.take(':')) {
      const auto more = at.whole(2);
      if (!more) return {};
      zone_minutes += *more;
    }
    if (!at.at_end() && (at.front() != '[' || !at.rest().ends_with(']'))) return {};  // "[Europe/Berlin]"
    time.seconds -= sign * 60.0 * zone_minutes;
  } else {
    return {};
  }
  time.seconds += 3600.0 * *hours + 60.0 * *minutes + seconds;
  return time;
}

}  // namespace data
