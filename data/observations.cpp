#include "data/observations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "data/copies.hpp"
#include "data/csv.hpp"
#include "data/error.hpp"

namespace data {
namespace {

double measured(const Csv& csv, const CsvRow& row, std::size_t column) {
  const double value = csv.number(row, column);
  if (!std::isfinite(value)) {
    throw InputError(ExitStatus::bad_data,
                     Problem{csv.place(row, column), fmt::format("'{}' is not a measured value", row.fields[column]),
                             "give a number, or remove the line"});
  }
  return value;
}

/// Columns of an output and of its standard errors.
struct OutputColumns {
  std::size_t output = 0;            ///< index into Study::outputs
  std::size_t value = 0;             ///< column of the file
  std::optional<std::size_t> error;  ///< none: MissingErrors::nan
  Unit unit, error_unit;
};

/// The outputs that the file has columns of. An output whose column holds no value at all joins set.empty_outputs
/// instead.
std::vector<OutputColumns> output_columns(const Csv& csv, const Study& study, MissingErrors missing,
                                          ObservationSet& set) {
  std::vector<OutputColumns> found;
  for (std::size_t i = 0; i < study.outputs.size(); ++i) {
    const std::string &name = study.outputs[i].name, error_name = name + "_se";
    const bool has_errors = csv.find(error_name, Csv::Capitals::any).has_value();
    if (!csv.find(name, Csv::Capitals::any) && !has_errors) continue;
    OutputColumns one{.output = i, .value = csv.column(name)};
    if (has_errors || missing == MissingErrors::refused) one.error = csv.column(error_name);
    one.unit = csv.unit(one.value, study.outputs[i].unit);
    one.error_unit = one.error ? csv.unit(*one.error, one.unit) : one.unit;
    found.push_back(std::move(one));
  }
  if (found.empty() && !study.outputs.empty()) csv.column(study.outputs.front().name);  // says what is missing
  const auto is_empty = [&](const OutputColumns& one) {
    return std::all_of(csv.rows.begin(), csv.rows.end(),
                       [&](const CsvRow& row) { return std::isnan(csv.number(row, one.value)); });
  };
  std::vector<OutputColumns> measured_ones;
  for (OutputColumns& one : found)
    if (is_empty(one))
      set.empty_outputs.push_back(one.output);
    else
      measured_ones.push_back(std::move(one));
  if (measured_ones.empty()) {  // nothing was measured: the caller says of which row
    set.empty_outputs.clear();
    return found;
  }
  return measured_ones;
}

/// Adds what a row measures of each output: NaN of one whose field is empty, where another's is not.
void read_outputs(const Csv& csv, const CsvRow& row, const std::vector<OutputColumns>& outputs, Observation& point) {
  const bool measures_some = std::any_of(outputs.begin(), outputs.end(), [&](const OutputColumns& one) {
    return !std::isnan(csv.number(row, one.value));
  });
  for (const OutputColumns& one : outputs) {
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    const bool is_measured = !measures_some || !std::isnan(csv.number(row, one.value));
    point.values.push_back(is_measured ? one.unit.to_si(measured(csv, row, one.value)) : nothing);
    if (!is_measured || !one.error) {
      point.standard_errors.push_back(nothing);
      continue;
    }
    const double error = measured(csv, row, *one.error);
    if (error <= 0.0) {
      throw InputError(ExitStatus::bad_data,
                       Problem{csv.place(row, *one.error), fmt::format("{} is not above 0", error),
                               "give the standard error of the measured mean"});
    }
    point.standard_errors.push_back(one.error_unit.factor * error);  // a difference: no offset
  }
}

/// Columns of numbers that vary, beside those that are read and those of demcal observe.
std::vector<std::string> unread_columns(const Csv& csv, const Study& study) {
  std::set<std::size_t> known;
  const auto add = [&](const std::string& name) {
    if (const auto column = csv.find(name, Csv::Capitals::any)) known.insert(*column);
  };
  for (const std::string_view name : columns_of_observe) add(std::string(name));
  for (const Control& control : study.controls)
    for (const char* ending : {"", "_sd"}) add(control.name + ending);
  for (const Output& output : study.outputs)
    for (const char* ending : {"", "_se"}) add(output.name + ending);
  for (const Parameter& parameter : study.parameters) add(parameter.name);
  std::vector<std::string> unread;
  for (std::size_t i = 0; i < csv.columns.size(); ++i)
    if (const auto range = csv.number_range(i); range && range->first < range->second && !known.contains(i))
      unread.push_back(column_in_words(csv, i));
  return unread;
}

}  // namespace

void count_copies_once(ObservationSet& set, const Study& study) {
  std::vector<RepeatableRow> rows;
  for (const Observation& point : set.points) {
    RepeatableRow row{.at = point.controls, .values = {}, .errors = {}};
    for (std::size_t i = 0; i < set.outputs.size(); ++i) {
      const Unit& unit = study.outputs[set.outputs[i]].unit;
      row.values.push_back(unit.from_si(point.values[i]));
      row.errors.push_back(point.standard_errors[i] / unit.factor);
    }
    rows.push_back(std::move(row));
  }
  const auto copies = copies_of(rows);
  std::vector<Observation> kept;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (copies[i])
      set.copies.push_back({.line = set.points[i].line, .of = set.points[*copies[i]].line});
    else
      kept.push_back(set.points[i]);
  }
  set.points = std::move(kept);
}

ObservationSet read_observations(const std::string& path, const Study& study,
                                 const std::map<std::string, double>& settings, MissingErrors missing) {
  const Csv csv = read_csv(path);
  ObservationSet set;
  set.file = path;
  set.header = csv.comments;

  std::vector<std::optional<std::size_t>> control_columns;  // none: a setting of the whole set
  std::vector<Unit> control_units;
  for (const Control& control : study.controls) {
    const bool set_once = settings.contains(control.name);
    if (set_once && csv.find(control.name, Csv::Capitals::any))
      throw InputError(ExitStatus::bad_data,
                       Problem{csv.file, fmt::format("has a column {}, which the study also sets", control.name),
                               "keep one of the two"});
    control_columns.push_back(set_once ? std::nullopt : std::optional(csv.column(control.name)));
    control_units.push_back(control_columns.back() ? csv.unit(*control_columns.back(), control.unit) : control.unit);
  }
  for (const Parameter& parameter : study.parameters)
    if (csv.find(parameter.name, Csv::Capitals::any)) set.parameter_columns.push_back(parameter.name);
  const std::vector<OutputColumns> outputs = output_columns(csv, study, missing, set);
  for (const OutputColumns& one : outputs) set.outputs.push_back(one.output);
  set.unread = unread_columns(csv, study);
  if (csv.rows.empty()) {
    throw InputError(ExitStatus::bad_data, Problem{csv.file, "has a header but no rows", "add the measured points"});
  }

  for (const CsvRow& row : csv.rows) {
    Observation point;
    point.line = row.line;
    for (std::size_t i = 0; i < control_columns.size(); ++i) {
      const Control& control = study.controls[i];
      point.controls.push_back(control_columns[i] ? control_units[i].to_si(measured(csv, row, *control_columns[i]))
                                                  : settings.at(control.name));
      if (control.scale == Scale::log && !(point.controls.back() > 0.0))
        throw InputError(ExitStatus::bad_data,
                         Problem{control_columns[i] ? csv.place(row, *control_columns[i]) : csv.file,
                                 fmt::format("{} is {:.10g}, which has no logarithm", control.name,
                                             control.unit.from_si(point.controls.back())),
                                 fmt::format("correct it, or set controls.{}.scale = \"linear\"", control.name)});
    }
    read_outputs(csv, row, outputs, point);
    set.points.push_back(std::move(point));
  }
  if (std::all_of(outputs.begin(), outputs.end(), [](const OutputColumns& one) { return one.error.has_value(); }))
    count_copies_once(set, study);
  return set;
}

std::vector<std::size_t> points_with(const ObservationSet& set, std::size_t column) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < set.points.size(); ++i)
    if (set.points[i].has(column)) found.push_back(i);
  return found;
}

std::vector<std::pair<std::size_t, std::size_t>> points_at_same_settings(const Study& study, const ObservationSet& set,
                                                                         const ObservationSet& other) {
  struct Pair {
    double apart;
    std::size_t point, other;
  };
  const auto apart = [&](const Observation& a, const Observation& b) {
    double largest = 0.0;
    for (std::size_t c = 0; c < study.controls.size(); ++c) {
      const Axis axis = study.controls[c].axis();
      largest = std::max(largest, std::abs(axis.to_unit(a.controls[c]) - axis.to_unit(b.controls[c])));
    }
    return largest;
  };
  std::vector<Pair> near;
  for (std::size_t i = 0; i < set.points.size(); ++i)
    for (std::size_t j = 0; j < other.points.size(); ++j)
      if (const double distance = apart(set.points[i], other.points[j]); distance <= same_setting)
        near.push_back({distance, i, j});
  // Equal to rounding is equal: replicates keep the order of the files.
  constexpr double rounding = 1e-9;
  std::stable_sort(near.begin(), near.end(), [](const Pair& a, const Pair& b) {
    return std::floor(a.apart / rounding) < std::floor(b.apart / rounding);
  });
  std::vector<bool> taken(set.points.size(), false), other_taken(other.points.size(), false);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const Pair& pair : near) {
    if (taken[pair.point] || other_taken[pair.other]) continue;
    taken[pair.point] = other_taken[pair.other] = true;
    pairs.emplace_back(pair.point, pair.other);
  }
  return pairs;
}

const Nuisance* noise_instead(const Study& study, const ObservationSet& set, std::size_t output) {
  const Nuisance* instead = nullptr;
  const auto reads = [&](const std::vector<std::string>& observe) {
    return std::find(observe.begin(), observe.end(), set.name) != observe.end();
  };
  const auto stands_in = [&](const CalibrationCase& item) {
    const auto noise = std::find_if(item.nuisances.begin(), item.nuisances.end(), [&](const Nuisance& one) {
      return one.kind == NuisanceKind::noise_sd && one.output.value_or(output) == output;
    });
    if (noise != item.nuisances.end() && instead == nullptr) instead = &*noise;
    return noise != item.nuisances.end();
  };
  for (const CalibrationCase& item : study.cases)
    if (reads(item.observe) && !stands_in(item)) return nullptr;
  for (const UnusedData& wanted : study.unused_data)
    if (reads(wanted.observe) && !stands_in(study.cases.at(wanted.case_index))) return nullptr;
  return instead;
}

}  // namespace data
