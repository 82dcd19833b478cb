// A check of outputs, measured or of runs: several rows that have exactly the largest value, or the smallest, at
// different settings. A sensor at the end of its range reads so, and such a row says only "at least" or "at most".
//
// Numbers rounded to few digits meet by chance. So nothing is said where the values are coarse, or where a value in the
// middle comes as often, or of zeros.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "data/observations.hpp"
#include "uq/calibrate/data_columns.hpp"

namespace uq {
namespace {

using data::Finding;
using data::Severity;

/// Values of one output in its unit, with the place of each and its settings.
struct OutputColumn {
  std::string name, unit;
  std::vector<double> values;
  std::vector<std::string> places;
  std::vector<std::vector<double>> settings;
};

/// The last digit that the values are written to, 1e-9 at least.
double last_digit(const std::vector<double>& values) {
  double digit = 1.0;
  for (; digit > 1e-9; digit *= 0.1) {
    const bool all = std::all_of(values.begin(), values.end(), [digit](double value) {
      const double steps = value / digit;
      return std::abs(steps - std::round(steps)) < 1e-6 * std::max(1.0, std::abs(steps));
    });
    if (all) break;
  }
  return digit;
}

void check_end(const OutputColumn& column, bool high, std::size_t least_rows, std::vector<Finding>& findings) {
  constexpr double digits_apart = 30.0;
  const auto [least, most] = std::minmax_element(column.values.begin(), column.values.end());
  const double end = high ? *most : *least;
  if (end == 0.0 || *most - *least < digits_apart * last_digit(column.values)) return;
  std::map<double, std::size_t> counts;
  for (const double value : column.values) ++counts[value];
  const std::size_t count = counts[end];
  if (count < least_rows) return;
  for (const auto& [value, times] : counts)
    if (value != end && 2 * times > count) return;
  std::vector<std::string> places;
  const std::vector<double>* first = nullptr;
  bool elsewhere = false;
  for (std::size_t i = 0; i < column.values.size(); ++i) {
    if (column.values[i] != end) continue;
    places.push_back(column.places[i]);
    if (first == nullptr) first = &column.settings[i];
    elsewhere = elsewhere || column.settings[i] != *first;
  }
  if (!elsewhere) return;
  Finding finding = data::about_rows(data::FindingKind::saturated, Severity::warning, places);
  finding.what = fmt::format(
      "{} of {} rows have exactly the {} {}, {:.6g}{}, at different settings, as a sensor reads "
      "at the end of its range",
      count, column.values.size(), high ? "largest" : "smallest", column.name, end, behind_number(column.unit));
  finding.remedy = "look at the sensor's range; a row at its end says only \"at least\" or \"at most\": leave it out";
  findings.push_back(std::move(finding));
}

void check_column(const OutputColumn& column, std::size_t least_rows, std::vector<Finding>& findings) {
  if (column.values.size() < 5) return;
  for (const bool high : {true, false}) check_end(column, high, least_rows, findings);
}

}  // namespace

std::vector<Finding> check_saturated(const data::Study& study, const data::RunTable& table) {
  constexpr std::size_t least_readings = 3, least_runs = 5;
  std::vector<Finding> findings;
  for (const data::ObservationSet& set : study.observations)
    for (std::size_t c = 0; c < set.outputs.size(); ++c) {
      const data::Output& output = study.outputs[set.outputs[c]];
      OutputColumn column{.name = output.name, .unit = output.unit.symbol};
      for (const data::Observation& point : set.points) {
        if (!point.has(c)) continue;
        column.values.push_back(output.unit.from_si(point.values[c]));
        column.places.push_back(place_of(set, point));
        column.settings.push_back(point.controls);
      }
      check_column(column, least_readings, findings);
    }
  for (const data::Material& material : study.materials)
    for (std::size_t o = 0; o < study.outputs.size(); ++o) {
      const data::Output& output = study.outputs[o];
      OutputColumn column{.name = output.name, .unit = output.unit.symbol};
      for (const data::RunRow& row : table.rows) {
        if (row.left_out || row.material != material.name || !std::isfinite(row.outputs[o])) continue;
        column.values.push_back(output.unit.from_si(row.outputs[o]));
        column.places.push_back(row.place);
        column.settings.push_back(row.inputs);
      }
      check_column(column, least_runs, findings);
    }
  return findings;
}

}  // namespace uq
