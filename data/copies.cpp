#include "data/copies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "data/log_gamma.hpp"

namespace data {

namespace {

/// Probability that a Poisson number of this mean is `count` or more.
double at_least(double count, double mean) {
  if (!(mean > 0.0)) return 0.0;
  if (count > mean + 10.0 * std::sqrt(mean) + 10.0) return 0.0;
  double below = 0.0;
  for (double k = 0.0; k < count; k += 1.0) below += std::exp(k * std::log(mean) - mean - log_gamma(k + 1.0));
  return 1.0 - below;
}

/// The last decimal that any of the numbers uses.
double last_decimal(const std::vector<double>& numbers) {
  double step = 1.0;
  for (int decimals = 0; decimals < 12; ++decimals, step /= 10.0) {
    const bool whole = std::all_of(numbers.begin(), numbers.end(), [&](double number) {
      const double steps = number / step;
      return std::abs(steps - std::round(steps)) <= 1e-6 + 1e-14 * std::abs(steps);
    });
    if (whole) return step;
  }
  return step;
}

/// The step of a grid on which all numbers lie to within their last decimal; none where they lie on none, or are few.
std::optional<double> grid_step(const std::vector<double>& numbers, double decimal) {
  constexpr std::size_t few = 6;
  const std::set<double> sorted(numbers.begin(), numbers.end());
  if (sorted.size() < few) return {};
  const std::vector<double> values(sorted.begin(), sorted.end());
  double step = values.back() - values.front();
  for (std::size_t i = 1; i < values.size(); ++i) step = std::min(step, values[i] - values[i - 1]);
  if (step < 3.0 * decimal) return {};
  const bool exact = std::all_of(values.begin(), values.end(), [&](double value) {
    const double steps = (value - values.front()) / step;
    return std::abs(steps - std::round(steps)) < 1e-6;
  });
  if (exact) return step;
  // A step of more decimals than the numbers: it is known the better the farther off a number lies.
  double known = 1.0;  // steps over which it is known to a decimal
  for (const double value : values) {
    const double steps = std::round((value - values.front()) / step);
    const double slack = decimal * (1.0 + steps / known);  // of the number itself, and of the step so far
    if (std::abs(value - values.front() - steps * step) > 1.01 * slack || slack > 0.25 * step) return {};
    if (steps < known) continue;
    step = (value - values.front()) / steps;
    known = steps;
  }
  return step;
}

}  // namespace

double resolution(const std::vector<double>& numbers) {
  const double decimal = last_decimal(numbers);
  return std::max(decimal, grid_step(numbers, decimal).value_or(0.0));
}

namespace {

/// The standard deviation of the different numbers among these outputs of rows at one point; none of fewer than five.
std::optional<double> scatter_of(const std::vector<RepeatableRow>& rows, const std::vector<std::size_t>& members,
                                 std::size_t column) {
  constexpr std::size_t few = 5;
  std::set<double> different;
  for (const std::size_t i : members)
    if (std::isfinite(rows[i].values[column])) different.insert(rows[i].values[column]);
  if (different.size() < few) return {};
  double mean = 0.0, squares = 0.0;
  for (const double value : different) mean += value / static_cast<double>(different.size());
  for (const double value : different) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(different.size() - 1));
}

}  // namespace

std::vector<std::optional<std::size_t>> copies_of(const std::vector<RepeatableRow>& rows) {
  std::vector<std::optional<std::size_t>> found(rows.size());
  std::map<std::vector<double>, std::vector<std::size_t>> by_place;
  for (std::size_t i = 0; i < rows.size(); ++i) by_place[rows[i].at].push_back(i);
  double pairs = 0.0, equal = 0.0, chance = 0.0;
  std::vector<double> steps;
  for (std::size_t k = 0; !rows.empty() && k < rows.front().values.size(); ++k) {
    std::vector<double> column;
    for (const RepeatableRow& row : rows)
      if (std::isfinite(row.values[k])) column.push_back(row.values[k]);
    steps.push_back(resolution(column));
  }
  for (const auto& [unused, members] : by_place) {
    const double count = static_cast<double>(members.size());
    pairs += 0.5 * count * (count - 1.0);
    std::vector<double> error_most;  // of each output, as the readings themselves scatter
    for (std::size_t k = 0; k < steps.size(); ++k)
      error_most.push_back(scatter_of(rows, members, k).value_or(std::numeric_limits<double>::infinity()));
    std::map<std::pair<std::vector<double>, std::vector<double>>, std::size_t> first;
    std::map<std::size_t, double> seen;  // rows equal to that first one, before the next
    for (const std::size_t i : members) {
      // NaN is not equal to itself, and would not sort.
      std::vector<double> values = rows[i].values, errors = rows[i].errors;
      std::replace_if(
          values.begin(), values.end(), [](double v) { return std::isnan(v); }, -1e300);
      std::replace_if(
          errors.begin(), errors.end(), [](double v) { return std::isnan(v); }, -1e300);
      const auto [there, is_new] = first.emplace(std::pair{values, errors}, i);
      if (is_new) continue;
      found[i] = there->second;
      equal += ++seen[there->second];
      double agree = 1.0;  // all outputs at once
      for (std::size_t k = 0; k < steps.size(); ++k) {
        const double error = std::min(rows[i].errors[k], error_most[k]);
        if (std::isnan(rows[i].values[k])) continue;
        agree *= error > 0.0 ? std::min(1.0, steps[k] / (2.0 * std::sqrt(std::numbers::pi) * error)) : 0.0;
      }
      chance = std::max(chance, agree);
    }
  }
  if (equal == 0.0) return found;
  if (at_least(equal, pairs * chance) > 0.01) found.assign(rows.size(), std::nullopt);
  return found;
}

}  // namespace data
