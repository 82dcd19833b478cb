// Plateaus. A sample belongs to the running plateau while its speed lies within the tolerance of the plateau's mean so
// far. One to `lone` samples further away are a logger's dropouts and stay in the torque series, whose even spacing the
// autocorrelation needs; more in a row end the plateau, as does a gap in time of over `lone` intervals.
#include "data/torque_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "data/csv.hpp"
#include "data/error.hpp"

namespace data {
namespace {

constexpr std::size_t lone = 4;
constexpr double standstill = 0.01;  // of the largest speed

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

struct Heading {
  std::string name, unit;
};

/// "Torque [N m]", "torque (N m)" and "torque / N m" are all the name and its unit.
Heading read_heading(const std::string& column) {
  for (const char* marks : {"[]", "()"}) {
    const auto open = column.rfind(marks[0]);
    if (open != std::string::npos && open > 0 && column.back() == marks[1])
      return {trimmed(column.substr(0, open)), trimmed(column.substr(open + 1, column.size() - open - 2))};
  }
  if (const auto slash = column.find(" / "); slash != std::string::npos)
    return {trimmed(column.substr(0, slash)), trimmed(column.substr(slash + 3))};
  return {column, ""};
}

struct Found {
  std::size_t column;
  Unit unit;
};

Found find_column(const Csv& csv, const LogColumn& wanted, const std::string& dimension, const std::string& option) {
  const auto fail = [&](const std::string& what, const std::string& remedy) -> InputError {
    return {ExitStatus::bad_data, Problem{fmt::format("{}:{}", csv.file, csv.header_line), what, remedy}};
  };
  std::string there;
  for (std::size_t i = 0; i < csv.columns.size(); ++i) {
    const Heading heading = read_heading(csv.columns[i]);
    there += (i ? ", " : "") + csv.columns[i];
    if (lower(heading.name) != lower(wanted.name) && lower(csv.columns[i]) != lower(wanted.name)) continue;
    std::string symbol = wanted.unit.empty() ? heading.unit : wanted.unit;
    if (symbol.empty()) symbol = wanted.usual;
    if (symbol.empty())
      throw fail(fmt::format("the column '{}' has no unit", csv.columns[i]),
                 fmt::format("write it in the header, '{} [N m]', or give --{}-unit", wanted.name, option));
    try {
      const Unit unit = parse_unit(symbol);
      if (convertible(symbol, dimension)) return {i, unit};
    } catch (const std::invalid_argument&) {
    }
    throw fail(fmt::format("'{}' is not a unit of {}", symbol, option),
               fmt::format("a unit like '{}'; --{}-unit overrides the header", dimension, option));
  }
  throw fail(fmt::format("the column '{}' is missing (the columns are {})", wanted.name, there),
             fmt::format("name it with --{}", option));
}

void check_spacing(TorqueLog& log) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < log.time.size(); ++i) gaps.push_back(log.time[i] - log.time[i - 1]);
  if (gaps.empty()) return;
  std::vector<double> sorted = gaps;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  log.interval = sorted[sorted.size() / 2];
  const auto uneven = std::count_if(gaps.begin(), gaps.end(),
                                    [&](double gap) { return std::abs(gap - log.interval) > 0.2 * log.interval; });
  log.uneven_share = static_cast<double>(uneven) / static_cast<double>(gaps.size());
}

/// Mean and error of a stretch of constant `speed`.
Plateau reduce(const TorqueLog& log, std::size_t first, std::size_t count, double speed,
               const PlateauOptions& options) {
  Plateau plateau{.first = first, .count = count, .used_from = first, .speed = speed};
  while (plateau.used_from < first + count && log.time[plateau.used_from] - log.time[first] < options.dead_time)
    ++plateau.used_from;
  const std::size_t left = first + count - plateau.used_from;
  plateau.torque = mean_with_error({log.torque.data() + plateau.used_from, left});
  plateau.used_from += plateau.torque.dropped;
  // Dropouts count in neither the speed nor its sd.
  double sum = 0.0, squares = 0.0, members = 0.0;
  for (std::size_t i = plateau.used_from; i < first + count; ++i) {
    if (std::abs(log.speed[i] - speed) > options.tolerance * std::abs(speed)) continue;
    sum += log.speed[i] - speed;
    squares += (log.speed[i] - speed) * (log.speed[i] - speed);
    members += 1.0;
  }
  if (members > 0.0) plateau.speed = speed + sum / members;
  if (members > 1.0) plateau.speed_sd = std::sqrt(std::max(0.0, squares - sum * sum / members) / (members - 1.0));
  return plateau;
}

}  // namespace

TorqueLog read_torque_log(const std::string& path, const LogColumns& columns) {
  const Csv csv = read_csv(path);
  TorqueLog log{.file = csv.file};
  const Found time = find_column(csv, columns.time, "s", "time");
  const Found torque = find_column(csv, columns.torque, "N m", "torque");
  const Found speed = find_column(csv, columns.speed, "rpm", "rpm");
  log.torque_unit = torque.unit;
  log.speed_unit = speed.unit;
  for (const CsvRow& row : csv.rows) {
    const double t = time.unit.to_si(csv.number(row, time.column));
    const double m = torque.unit.to_si(csv.number(row, torque.column));
    const double w = speed.unit.to_si(csv.number(row, speed.column));
    if (!std::isfinite(t) || !std::isfinite(m) || !std::isfinite(w)) {
      ++log.missing;
      continue;
    }
    if (!log.time.empty() && !(t > log.time.back()))
      throw InputError(
          ExitStatus::bad_data,
          Problem{csv.place(row, time.column),
                  fmt::format("{:g} s does not come after {:g} s of the sample before", t, log.time.back()),
                  "sort the log by time, remove repeated lines, or split a log that was restarted"});
    log.time.push_back(t);
    log.torque.push_back(m);
    log.speed.push_back(w);
  }
  if (log.time.size() < 2)
    throw InputError(ExitStatus::bad_data, Problem{csv.file, fmt::format("has {} complete samples", log.time.size()),
                                                   "a log has time, torque and speed of many samples"});
  check_spacing(log);
  return log;
}

std::vector<Plateau> find_plateaus(const TorqueLog& log, const PlateauOptions& options) {
  double fastest = 0.0;
  for (const double speed : log.speed) fastest = std::max(fastest, std::abs(speed));
  const auto inside = [&](std::size_t i) { return log.time[i] >= options.from && log.time[i] <= options.to; };

  std::vector<Plateau> plateaus;
  const std::size_t n = log.time.size();
  std::size_t first = 0;
  while (first < n) {
    if (!inside(first)) {
      ++first;
      continue;
    }
    double sum = log.speed[first];
    std::size_t members = 1, last = first;
    for (std::size_t i = first + 1; i < n && i - last <= lone && inside(i); ++i) {
      if (log.time[i] - log.time[i - 1] > static_cast<double>(lone) * log.interval) break;
      const double mean = sum / static_cast<double>(members);
      if (std::abs(log.speed[i] - mean) > options.tolerance * std::abs(mean)) continue;
      sum += log.speed[i];
      ++members;
      last = i;
    }
    const double mean = sum / static_cast<double>(members);
    const bool turning = std::abs(mean) > standstill * fastest;
    const bool long_enough = log.time[last] - log.time[first] >= std::max(options.shortest, options.dead_time);
    if (turning && long_enough && last > first) {
      Plateau plateau = reduce(log, first, last - first + 1, mean, options);
      if (plateau.used_from <= last) plateaus.push_back(std::move(plateau));
    }
    first = turning && long_enough ? last + 1 : first + 1;
  }
  return plateaus;
}

std::optional<MeanTorque> idle_at(const std::vector<Plateau>& idle, double speed, double tolerance) {
  double weight = 0.0, sum = 0.0, plain = 0.0, exact = 0.0;
  for (const Plateau& plateau : idle) {
    if (std::abs(plateau.speed - speed) > tolerance * std::abs(speed)) continue;
    if (const double error = plateau.torque.standard_error; error > 0.0) {
      weight += 1.0 / (error * error);
      sum += plateau.torque.mean / (error * error);
    } else {
      exact += 1.0;
      plain += plateau.torque.mean;
    }
  }
  if (exact > 0.0) return MeanTorque{plain / exact, 0.0};
  if (weight > 0.0) return MeanTorque{sum / weight, 1.0 / std::sqrt(weight)};
  return std::nullopt;
}

}  // namespace data
