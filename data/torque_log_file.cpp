// Reading a log: its columns, its times, its numbers.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "data/csv.hpp"
#include "data/error.hpp"
#include "data/log_channels.hpp"
#include "data/log_columns.hpp"
#include "data/log_stamps.hpp"
#include "data/log_times.hpp"
#include "data/number_text.hpp"
#include "data/torque_log.hpp"
#include "data/unit_text.hpp"

namespace data {
namespace {

double median_interval(const std::vector<double>& times) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < times.size(); ++i) gaps.push_back(times[i] - times[i - 1]);
  if (gaps.empty()) return 0.0;
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  return *middle;
}

/// Median interval, and the share of those that differ from it.
void check_spacing(TorqueLog& log) {
  log.interval = median_interval(log.time);
  std::size_t uneven = 0;
  for (std::size_t i = 1; i < log.time.size(); ++i)
    uneven += std::abs(log.time[i] - log.time[i - 1] - log.interval) > 0.2 * log.interval;
  log.uneven_share = static_cast<double>(uneven) / static_cast<double>(log.time.size() - 1);
  if (log.uneven())
    log.notes.push_back(
        fmt::format("{:.0f} % of the samples are not evenly spaced in time: each counts until the next one",
                    100.0 * log.uneven_share));
}

/// Seconds since the beginning of some calendar, not of the log: from three years on.
constexpr double of_calendar = 1e8;

const char* const say_time_unit =
    "say which with --time-unit s, ms, min or d, or give the samples per second with --rate";

/// Numbers without a unit are taken as seconds where they can be seconds: not the days, milliseconds and ticks of
/// computers' clocks.
void refuse_no_seconds(const Csv& csv, std::size_t column, const std::vector<double>& times) {
  const std::string place = csv.place(csv.rows.front(), column);
  const double first = times.front(), last = times.back();
  if (first > 2e4 && first < 8e4 && last - first < 1.0)
    refuse_data(place,
                fmt::format("{} looks like a spreadsheet's day, not like seconds", csv.rows.front().fields[column]),
                "say which with --time-unit d or --time-unit s");
  if (first > 1e10)
    refuse_data(
        place,
        fmt::format("has no unit, and {} is too large for the seconds of a clock: these count from 1970 or 1904",
                    csv.rows.front().fields[column]),
        say_time_unit);
  const double interval = median_interval(times);
  if (!(interval < 1e-6) && !(interval > 100.0)) return;
  refuse_data(place,
              fmt::format("has no unit, and taken as seconds the samples lie {:.3g} s apart, which is {}", interval,
                          interval > 100.0 ? "more than 100 s" : "less than 1e-6 s"),
              say_time_unit);
}

std::string assumed_seconds(const std::vector<double>& times) {
  return fmt::format(
      "time taken as s, as nothing states its unit: {} samples every {:.4g} s, {:.6g} s in all "
      "(--time-unit says otherwise)",
      times.size(), median_interval(times), times.back() - times.front());
}

/// Whether lines are there twice, one behind the other: then equal stamps are no clock's doing.
bool repeats_lines(const Csv& csv) {
  return std::adjacent_find(csv.rows.begin(), csv.rows.end(), [](const CsvRow& one, const CsvRow& other) {
           return one.fields == other.fields;
         }) != csv.rows.end();
}

bool is_one_of(const std::string& field, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), lower_case(trimmed(field))) != words.end();
}
bool is_good(const std::string& field) {
  return is_one_of(field, {"good", "ok", "valid", "true", "192", "good (192)"});
}
bool is_bad(const std::string& field) {
  return is_one_of(field, {"bad", "invalid", "uncertain", "stale", "error", "fail", "failed", "not ok", "nok",
                           "questionable", "comm fail", "false", "0", "64", "bad (0)"});
}

/// Words in the fields of a column that is to hold numbers, with how often and where first.
struct Words {
  std::map<std::string, std::size_t> counts;
  const CsvRow* first = nullptr;
  std::size_t total = 0;
  void add(const std::string& word, const CsvRow& row) {
    ++counts[word];
    ++total;
    if (first == nullptr) first = &row;
  }
  std::string list() const {
    constexpr std::size_t shown = 10;
    std::vector<std::string> texts;
    for (const auto& [word, count] : counts)
      if (texts.size() < shown) texts.push_back(fmt::format("'{}' ({})", word, count));
    return fmt::format("{}{}", fmt::join(texts, ", "), counts.size() > shown ? ", ..." : "");
  }
};

bool is_plain_number(const std::string& field) {
  double value = 0.0;
  const char* const end = field.data() + field.size();
  const auto [rest, error] = std::from_chars(field.data() + (field.starts_with('+') ? 1 : 0), end, value);
  return rest == end && error != std::errc::invalid_argument && std::isfinite(value);
}

/// Takes a meter's words for "beyond my range" out of a column, with a warning. Throws InputError (65) with all other
/// words that are neither numbers nor say that there is no value.
void take_words(Csv& csv, std::size_t column, TorqueLog& log) {
  Words beyond, others;
  for (CsvRow& row : csv.rows) {
    std::string& field = row.fields[column];
    if (is_plain_number(field)) continue;
    if (is_overload(field)) {
      beyond.add(field, row);
      field.clear();
    } else if (!is_missing(field)) {
      others.add(field, row);
    }
  }
  if (others.total > 1)
    refuse_data(csv.place(*others.first, column),
                fmt::format("{} fields from here on are no numbers: {}", others.total, others.list()),
                "write numbers with a decimal point, and nothing where there is no value");
  if (beyond.total > 0)
    log.warnings.push_back(
        fmt::format("{}: {} samples that say the meter was beyond its range, {}, are left out, the first "
                    "in line {}: the mean of a hold with them is too near to 0",
                    csv.columns[column], beyond.total, beyond.list(), beyond.first->line));
}

/// Whether a column says of every sample whether it is good, and not of all the same; words as of OPC and historians.
bool tells_quality(const Csv& csv, std::size_t column) {
  const std::string name = lower_case(csv.headings[column]);
  const bool yes_or_no = name == "valid" || name == "validity";  // 1 and 0; a machine's state may be these, too
  if (name.find("quality") == std::string::npos && name != "status" && name != "state" && !yes_or_no) return false;
  std::size_t good = 0, bad = 0;
  for (const CsvRow& row : csv.rows) {
    if (is_good(row.fields[column]) || (yes_or_no && row.fields[column] == "1"))
      ++good;
    else if (is_bad(row.fields[column]))
      ++bad;
    else
      return false;
  }
  return good > 0 && bad > 0;
}

/// The samples that a column of their quality calls bad; none where there is no such column. Where there are several,
/// those beside torque and speed count.
std::vector<bool> bad_samples(const Csv& csv, std::size_t torque, std::optional<std::size_t> speed, TorqueLog& log) {
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < csv.columns.size(); ++i)
    if (tells_quality(csv, i)) columns.push_back(i);
  if (columns.size() > 1)
    std::erase_if(columns, [&](std::size_t i) { return i != torque + 1 && !(speed && i == *speed + 1); });
  std::vector<bool> bad(csv.rows.size(), false);
  for (const std::size_t column : columns) {
    Words words;
    for (std::size_t i = 0; i < csv.rows.size(); ++i) {
      if (!is_bad(csv.rows[i].fields[column])) continue;
      bad[i] = true;
      words.add(csv.rows[i].fields[column], csv.rows[i]);
    }
    if (words.total > 0)
      log.notes.push_back(fmt::format("{} says {}: these samples are left out, the first in line {}",
                                      csv.headings[column], words.list(), words.first->line));
  }
  return bad;
}

/// Takes rows out of a table.
void leave_out(Csv& csv, const std::vector<bool>& out) {
  std::size_t row = 0;
  std::erase_if(csv.rows, [&](const CsvRow&) { return out[row++]; });
}

/// The times of the rows that have one, made good; rows without stay NaN.
std::vector<double> times_of(const Csv& csv, std::size_t column, const LogColumns& columns, TorqueLog& log) {
  if (columns.rate) {
    std::vector<double> times(csv.rows.size());
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<double>(i) / *columns.rate;
    return times;
  }
  Stamps stamps = read_stamps(csv, column, columns.time);
  log.took.insert(log.took.end(), stamps.took.begin(), stamps.took.end());
  if (!stamps.clock && join_sections(stamps.seconds, csv.sections))
    log.took.push_back("a time that begins again with each heading: the sections joined one behind the other");
  std::vector<double> there;
  for (const double one : stamps.seconds)
    if (std::isfinite(one)) there.push_back(one);
  if (pass_midnight(there, stamps.of_day) > 0) log.took.push_back("times that go on past midnight");
  if (shares_stamps(there) || (repeats_stamps(there) && !repeats_lines(csv)))
    if (const std::string how = spread_stamps(there); !how.empty()) log.took.push_back(how);
  if (stamps.assumed && there.size() > 2) {
    refuse_no_seconds(csv, column, there);
    log.notes.push_back(assumed_seconds(there));
  }
  const bool of_clock = !there.empty() && (stamps.clock || std::abs(there.front()) > of_calendar);
  if (of_clock && !stamps.clock) log.took.push_back("times of a clock, counted from the first");
  const double start = of_clock ? there.front() : 0.0;
  std::size_t next = 0;
  for (double& one : stamps.seconds)
    if (std::isfinite(one)) one = there[next++] - start;
  return stamps.seconds;
}

/// Whether a heading says that it counts revolutions per minute, or names them as one does.
bool says_rpm(const std::string& heading) {
  const std::string name = lower_case(heading);
  return name.find("rpm") != std::string::npos || name.find("/min") != std::string::npos || name == "n";
}

}  // namespace

TorqueLog read_torque_log(const std::string& path, const LogColumns& columns) {
  Csv csv = read_csv(path);
  part_headings(csv, columns);
  TorqueLog log{.file = csv.file};
  log.took = csv.took;
  if (const auto channels = find_channels(csv, columns)) {
    leave_out(csv, bad_samples(csv, channels->value, {}, log));
    csv = with_channels_as_columns(csv, *channels, columns, log.took);
  }
  const std::size_t time = columns.rate ? 0 : find_column(csv, columns.time, time_of_log, log.took);
  if (!columns.rate) take_unit_of_cells(csv, time, columns.time, time_of_log, log.took);
  const std::size_t torque = find_column(csv, columns.torque, torque_of_log, log.took);
  take_unit_of_cells(csv, torque, columns.torque, torque_of_log, log.took);
  log.torque_unit = find_unit(csv, torque, columns.torque, torque_of_log);
  std::optional<std::size_t> speed;
  double in_unit = 1.0;
  const std::string given_speed = columns.speed.unit.empty() ? "rpm" : columns.speed.unit;
  log.speed_unit = shown_unit(unit_meant(given_speed, "rpm").value_or(parse_unit("rpm")), given_speed);
  if (!columns.constant_speed) {
    speed = find_column(csv, columns.speed, speed_of_log, log.took);
    take_unit_of_cells(csv, *speed, columns.speed, speed_of_log, log.took);
    log.speed_unit = find_unit(csv, *speed, columns.speed, speed_of_log);
    in_unit = per_shown_unit(csv, *speed, columns.speed);
    if (columns.speed.unit.empty() && csv.units[*speed].empty() && !says_rpm(csv.headings[*speed]))
      log.notes.push_back(
          fmt::format("'{}' has no unit, and is taken as rpm; --rpm-unit says another", csv.headings[*speed]));
  }
  take_words(csv, torque, log);
  if (speed) take_words(csv, *speed, log);
  const std::vector<double> times = times_of(csv, time, columns, log);
  const std::vector<bool> bad = bad_samples(csv, torque, speed, log);
  for (std::size_t i = 0; i < csv.rows.size(); ++i) {
    const CsvRow& row = csv.rows[i];
    if (bad[i]) continue;
    const double m = log.torque_unit.to_si(csv.number(row, torque));
    const double w = speed ? log.speed_unit.to_si(in_unit * csv.number(row, *speed)) : *columns.constant_speed;
    if (!std::isfinite(times[i]) || !std::isfinite(m) || !std::isfinite(w)) {
      ++log.missing;
      log.missing_torque += std::isfinite(m) ? 0 : 1;
      continue;
    }
    if (!log.time.empty() && !(times[i] > log.time.back())) {
      const bool an_hour = std::abs(times[i] - log.time.back() + 3600.0) < 60.0;
      refuse_data(csv.place(row, time),
                  fmt::format("{:g} s does not come after {:g} s of the sample before", times[i], log.time.back()),
                  an_hour ? "the clock was set back by an hour, as at the end of summer time: add the hour from this "
                            "line on, or split the log here"
                          : "sort the log by time, remove repeated lines, or split a log that was restarted");
    }
    log.time.push_back(times[i]);
    log.torque.push_back(m);
    log.speed.push_back(w);
  }
  if (log.time.size() < 2)
    throw InputError(ExitStatus::bad_data, Problem{csv.file, fmt::format("has {} complete samples", log.time.size()),
                                                   "a log has time, torque and speed of many samples"});
  check_spacing(log);
  return log;
}

}  // namespace data
