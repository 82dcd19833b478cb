// Even sampling under stamps cut to a step r: t_i = a + b i with stamp_i <= t_i < stamp_i + r for every i. The interval
// b follows from the first and last change of the stamp, to one sample over the whole log; a is any that satisfies all.
#include "data/log_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "data/time_series.hpp"

namespace data {
namespace {

constexpr double day_length = 86400.0;  // s

/// The first sample of each stamp.
std::vector<std::size_t> starts_of(const std::vector<double>& times) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < times.size(); ++i)
    if (i == 0 || times[i] != times[i - 1]) starts.push_back(i);
  return starts;
}

}  // namespace

bool join_sections(std::vector<double>& times, const std::vector<std::size_t>& starts) {
  bool joined = false;
  for (const std::size_t start : starts) {
    const auto split = times.begin() + static_cast<std::ptrdiff_t>(start);
    const auto is_time = [](double time) { return std::isfinite(time); };
    const auto first = std::find_if(split, times.end(), is_time);
    std::vector<double> before;
    std::copy_if(times.begin(), split, std::back_inserter(before), is_time);
    if (first == times.end() || before.size() < 2 || *first > before.back()) continue;
    std::vector<double> steps;
    for (std::size_t i = 1; i < before.size(); ++i) steps.push_back(before[i] - before[i - 1]);
    const double shift = before.back() + median_of(std::move(steps)) - *first;
    std::for_each(split, times.end(), [shift](double& time) { time += shift; });
    joined = true;
  }
  return joined;
}

std::size_t pass_midnight(std::vector<double>& times, bool of_day) {
  std::size_t midnights = 0;
  double before = times.empty() ? 0.0 : times.front();
  for (double& time : times) {
    const double stamp = time;
    const bool wraps = of_day ? stamp < before - 0.5 * day_length
                              : before > day_length - 600.0 && before <= day_length && stamp >= 0.0 && stamp < 600.0;
    if (wraps) ++midnights;
    before = stamp;
    time += static_cast<double>(midnights) * day_length;
  }
  return midnights;
}

bool shares_stamps(const std::vector<double>& times) {
  return times.size() > 4 && 5 * starts_of(times).size() <= 4 * times.size() &&
         std::is_sorted(times.begin(), times.end());
}

bool repeats_stamps(const std::vector<double>& times) {
  return std::is_sorted(times.begin(), times.end()) && std::adjacent_find(times.begin(), times.end()) != times.end();
}

std::string spread_stamps(std::vector<double>& times) {
  const std::vector<std::size_t> starts = starts_of(times);
  if (starts.size() < 3) return "";  // no interval to tell
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < starts.size(); ++k) step = std::min(step, times[starts[k]] - times[starts[k - 1]]);
  const double interval = (times[starts.back()] - times[starts[1]]) / static_cast<double>(starts.back() - starts[1]);
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < times.size(); ++i) {
    low = std::max(low, times[i] - interval * static_cast<double>(i));
    high = std::min(high, times[i] + step - interval * static_cast<double>(i));
  }
  if (low <= high + 2.0 * interval) {  // a stamp may come late by a sample
    const double start = 0.5 * (low + high);
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = start + interval * static_cast<double>(i);
    return fmt::format("samples that share a stamp spread evenly, {:.4g} s apart", interval);
  }
  // A longer one is a gap in the log.
  std::vector<double> widths;
  for (std::size_t k = 1; k < starts.size(); ++k) widths.push_back(times[starts[k]] - times[starts[k - 1]]);
  const double usual = median_of(std::move(widths));
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const std::size_t end = k + 1 < starts.size() ? starts[k + 1] : times.size();
    const double width = k + 1 < starts.size() ? std::min(usual, times[end] - times[starts[k]]) : step;
    const double first = times[starts[k]];
    for (std::size_t i = starts[k]; i < end; ++i)
      times[i] = first + width * static_cast<double>(i - starts[k]) / static_cast<double>(end - starts[k]);
  }
  return "samples that share a stamp spread evenly within it";
}

}  // namespace data
