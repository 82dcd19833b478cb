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

 private:
  std::string_view text_;
  std::size_t taken_ = 0;
};

struct Date {
  double seconds = 0.0;
  bool either = false;
};

std::optional<Date> days(int year, int month, int day) {
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return {};
  return Date{86400.0 * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count()), false};
}

/// The date at the front; the cursor stands behind it, or where it was.
std::optional<Date> read_date(Cursor& at) {
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
  } else if (*first > 12) {
    date = days(*third < 100 ? 2000 + *third : *third, *second, *first);
  } else if (*second > 12) {
    date = days(*third < 100 ? 2000 + *third : *third, *first, *second);
  } else if (*first == *second) {
    date = days(*third < 100 ? 2000 + *third : *third, *first, *second);
  } else {
    date = Date{0.0, true};
  }
  if (date) at = ahead;
  return date;
}

}  // namespace

std::optional<ClockTime> read_time(std::string_view text) {
  if (text.find(':') == std::string_view::npos) return {};
  Cursor at(trimmed(text));
  ClockTime time;
  if (const auto date = read_date(at)) {
    time.dated = !date->either;
    time.day_or_month = date->either;
    time.seconds = date->seconds;
    if (!at.take('T')) at.blanks();
    at.take(',');
    at.blanks();
  }
  auto hours = at.whole(3);
  if (!hours || !at.take(':')) return {};
  const auto minutes = at.whole(2);
  if (!minutes || *minutes > 59) return {};
  double seconds = 0.0;
  if (at.take(':')) {
    const auto whole = at.whole(2);
    if (!whole || *whole > 60) return {};
    seconds = *whole + at.fraction();
  } else if (at.front() == '.' || at.front() == ',') {  // minutes and seconds
    seconds = *minutes + at.fraction() + 60.0 * *hours;
    if (!at.at_end() || time.dated || time.day_or_month) return {};
    time.seconds = seconds;
    return time;
  } else {
    time.two_parts = !time.dated && !time.day_or_month;
  }
  at.blanks();
  if (at.rest() == "PM" || at.rest() == "pm" || at.rest() == "AM" || at.rest() == "am") {
    if (*hours < 1 || *hours > 12) return {};
    hours = *hours % 12 + (at.front() == 'P' || at.front() == 'p' ? 12 : 0);
  } else if (at.take('Z')) {
    if (!at.at_end()) return {};
  } else if (at.front() == '+' || at.front() == '-') {
    const double sign = at.take('-') ? -1.0 : (at.take('+'), 1.0);
    const auto zone = at.whole(4);
    if (!zone) return {};
    int zone_minutes = at.taken() > 2 ? *zone / 100 * 60 + *zone % 100 : *zone * 60;
    if (at.take(':')) {
      const auto more = at.whole(2);
      if (!more) return {};
      zone_minutes += *more;
    }
    if (!at.at_end()) return {};
    time.seconds -= sign * 60.0 * zone_minutes;
  } else if (!at.at_end()) {
    return {};
  }
  time.seconds += 3600.0 * *hours + 60.0 * *minutes + seconds;
  return time;
}

}  // namespace data
