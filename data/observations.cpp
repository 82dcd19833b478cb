#include "data/observations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "data/copies.hpp"
#include "data/csv.hpp"
#include "data/error.hpp"

namespace data {
namespace {

double measured(const Csv& csv, const CsvRow& row, std::size_t column) {
  const double value = csv.number(row, column);
  if (!std::isfinite(value)) {
    throw InputError(
        ExitStatus::bad_data,
        Problem{csv.place(row, column), fmt::format("'{}' is not a measured value", row.fields[column]),
                "give a number, or remove the line; outputs of which some are missing go into files of their own"});
  }
  return value;
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
  std::vector<std::size_t> value_columns;
  std::vector<std::optional<std::size_t>> error_columns;  // none: MissingErrors::nan
  for (const Control& control : study.controls) {
    const bool set_once = settings.contains(control.name);
    if (set_once && csv.find(control.name, Csv::Capitals::any))
      throw InputError(ExitStatus::bad_data,
                       Problem{csv.file, fmt::format("has a column {}, which the study also sets", control.name),
                               "keep one of the two"});
    control_columns.push_back(set_once ? std::nullopt : std::optional(csv.column(control.name)));
  }
  for (std::size_t i = 0; i < study.outputs.size(); ++i) {
    const std::string& name = study.outputs[i].name;
    if (!csv.find(name, Csv::Capitals::any) && !csv.find(name + "_se", Csv::Capitals::any)) continue;
    set.outputs.push_back(i);
    value_columns.push_back(csv.column(name));
    const bool without = missing == MissingErrors::nan && !csv.find(name + "_se", Csv::Capitals::any);
    error_columns.push_back(without ? std::nullopt : std::optional(csv.column(name + "_se")));
  }
  if (set.outputs.empty() && !study.outputs.empty()) csv.column(study.outputs.front().name);  // says what is missing
  if (csv.rows.empty()) {
    throw InputError(ExitStatus::bad_data, Problem{csv.file, "has a header but no rows", "add the measured points"});
  }

  std::vector<Unit> control_units, value_units, error_units;
  for (std::size_t i = 0; i < control_columns.size(); ++i)
    control_units.push_back(control_columns[i] ? csv.unit(*control_columns[i], study.controls[i].unit)
                                               : study.controls[i].unit);
  for (std::size_t i = 0; i < value_columns.size(); ++i) {
    value_units.push_back(csv.unit(value_columns[i], study.outputs[set.outputs[i]].unit));
    error_units.push_back(error_columns[i] ? csv.unit(*error_columns[i], value_units.back()) : value_units.back());
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
    for (std::size_t i = 0; i < value_columns.size(); ++i) {
      point.values.push_back(value_units[i].to_si(measured(csv, row, value_columns[i])));
      if (!error_columns[i]) {
        point.standard_errors.push_back(std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      const double error = measured(csv, row, *error_columns[i]);
      if (error <= 0.0) {
        throw InputError(ExitStatus::bad_data,
                         Problem{csv.place(row, *error_columns[i]), fmt::format("{} is not above 0", error),
                                 "give the standard error of the measured mean"});
      }
      point.standard_errors.push_back(error_units[i].factor * error);  // a difference: no offset
    }
    set.points.push_back(std::move(point));
  }
  if (std::all_of(error_columns.begin(), error_columns.end(), [](const auto& one) { return one.has_value(); }))
    count_copies_once(set, study);
  return set;
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
