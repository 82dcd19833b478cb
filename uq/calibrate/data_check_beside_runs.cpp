// Checks of a measurement beside the runs: columns that look exchanged, outputs of another magnitude than all runs
// have, controls that would meet the runs in another unit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data/time_series.hpp"
#include "uq/calibrate/data_columns.hpp"
#include "uq/findings/study_units.hpp"

namespace uq {
namespace {

using data::Finding;
using data::Severity;

/// Whether the meter's reading may be another multiple of the runs' output than one.
bool is_scaled(const data::Study& study, const data::ObservationSet& set, std::size_t output) {
  if (set.of_machine && study.scale) return true;
  for (const data::CalibrationCase& one : study.cases) {
    if (std::find(one.observe.begin(), one.observe.end(), set.name) == one.observe.end()) continue;
    for (const data::Nuisance& nuisance : one.nuisances)
      if ((nuisance.kind == data::NuisanceKind::offset || nuisance.kind == data::NuisanceKind::gain ||
           nuisance.kind == data::NuisanceKind::scale) &&
          (!nuisance.output || *nuisance.output == output))
        return true;
  }
  return false;
}

Extent outputs_of_runs(const data::RunTable& table, const data::ObservationSet& set, std::size_t output) {
  Extent runs;
  for (const data::RunRow& row : table.rows)
    if (!row.left_out && row.material == set.material && std::isfinite(row.outputs[output]))
      runs.add(row.outputs[output]);
  return runs;
}

Finding exchanged_in(const data::ObservationSet& set, const std::string& one, const std::string& other,
                     std::string why) {
  return {.kind = data::FindingKind::exchanged_columns,
          .place = place_of(set, set.points.front()),
          .severity = Severity::refusal,
          .what = fmt::format("the columns {} and {} look exchanged: {}", one, other, why),
          .remedy = "exchange the two names in the header",
          .places = {}};
}

/// An output's column beside that of its standard errors, or beside a control's, where the numbers of each lie where
/// the other's belong.
void check_exchanged(const data::Study& study, const data::RunTable& table, const data::ObservationSet& set,
                     std::vector<Finding>& findings) {
  for (std::size_t column = 0; column < set.outputs.size(); ++column) {
    const data::Output& output = study.outputs[set.outputs[column]];
    const Extent runs = outputs_of_runs(table, set, set.outputs[column]);
    Extent values, errors;
    for (const data::Observation& point : set.points)
      if (point.has(column)) {
        values.add(point.values[column]);
        errors.add(point.standard_errors[column]);
      }
    if (runs.values.size() < 5 || values.values.size() < 2 || is_scaled(study, set, set.outputs[column])) continue;
    const bool outside = values.high < runs.low || values.low > runs.high;
    if (outside && errors.low >= runs.low && errors.high <= runs.high && values.high < errors.low) {
      findings.push_back(
          exchanged_in(set, output.name, output.name + "_se",
                       fmt::format("{0} lies outside all runs, and {0}_se among what they give, {1:.4g} to {2:.4g}{3}",
                                   output.name, output.unit.from_si(runs.low), output.unit.from_si(runs.high),
                                   behind_number(output.unit.symbol))));
      continue;
    }
    for (std::size_t c = 0; c < study.controls.size(); ++c) {
      const data::Control& control = study.controls[c];
      Extent seen;
      for (const data::Observation& point : set.points) seen.add(control.unit.from_si(point.controls[c]));
      const double low = control.unit.from_si(control.low), high = control.unit.from_si(control.high);
      const bool control_off = seen.high < low || seen.low > high;
      if (outside && control_off && output.unit.from_si(values.low) >= low &&
          output.unit.from_si(values.high) <= high && seen.low >= output.unit.from_si(runs.low) &&
          seen.high <= output.unit.from_si(runs.high))
        findings.push_back(exchanged_in(set, control.name, output.name,
                                        fmt::format("{} lies among what the runs give of {}, and {} in the range of {}",
                                                    control.name, output.name, output.name, control.name)));
    }
  }
}

Extent readings_of(const data::ObservationSet& set, std::size_t column) {
  Extent seen;
  for (const data::Observation& point : set.points)
    if (point.has(column)) seen.add(point.values[column]);
  return seen;
}

/// Two outputs whose readings each lie among what the runs give of the other, and outside what they give of their own.
void check_exchanged_outputs(const data::Study& study, const data::RunTable& table, const data::ObservationSet& set,
                             std::vector<Finding>& findings) {
  /// Numbers as the study writes them: a heading in the wrong place brings no unit with it.
  struct Numbers {
    Extent readings, runs;
    bool among(const Numbers& other) const {
      return readings.low >= other.runs.low && readings.high <= other.runs.high;
    }
    bool outside() const { return readings.high < runs.low || readings.low > runs.high; }
  };
  std::vector<Numbers> all;
  for (std::size_t column = 0; column < set.outputs.size(); ++column) {
    const data::Unit& unit = study.outputs[set.outputs[column]].unit;
    Numbers numbers;
    for (const double value : readings_of(set, column).values) numbers.readings.add(unit.from_si(value));
    for (const double value : outputs_of_runs(table, set, set.outputs[column]).values)
      numbers.runs.add(unit.from_si(value));
    all.push_back(std::move(numbers));
  }
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = a + 1; b < all.size(); ++b) {
      const auto few = [](const Numbers& one) { return one.readings.values.size() < 2 || one.runs.values.size() < 5; };
      if (few(all[a]) || few(all[b]) || is_scaled(study, set, set.outputs[a]) || is_scaled(study, set, set.outputs[b]))
        continue;
      if (!all[a].outside() || !all[b].outside() || !all[a].among(all[b]) || !all[b].among(all[a])) continue;
      const std::string &first = study.outputs[set.outputs[a]].name, &second = study.outputs[set.outputs[b]].name;
      findings.push_back(exchanged_in(
          set, first, second, "each lies outside what all runs give of it, and among what they give of the other"));
    }
}

/// Whether the set is of a tool that turns backwards, at a negative setting.
bool turns_backwards(const data::ObservationSet& set) {
  return std::any_of(set.points.begin(), set.points.end(), [](const data::Observation& point) {
    return std::any_of(point.controls.begin(), point.controls.end(), [](double setting) { return setting < 0.0; });
  });
}

/// Whether all readings have one sign and all runs the other. Where there are no runs yet, demcal's own will give
/// positive torques of a tool that turns forwards: those that the drive must supply.
bool has_other_sign(const data::Study& study, const data::ObservationSet& set, const data::Output& output,
                    const Extent& runs, const Extent& seen) {
  if (seen.values.empty()) return false;
  if (runs.values.empty())
    return study.training.engine == data::Engine::demcal && seen.high < 0.0 && !turns_backwards(set) &&
           (output.name == "torque" || output.name == "first_torque" || output.name == "second_torque");
  return (seen.high < 0.0 && runs.low > 0.0) || (seen.low > 0.0 && runs.high < 0.0);
}

/// Outputs that are counted the other way round, as by a sensor whose sign is that of the powder on the mixer.
void check_sign(const data::Study& study, const data::RunTable& table, const data::ObservationSet& set,
                std::vector<Finding>& findings) {
  for (std::size_t column = 0; column < set.outputs.size(); ++column) {
    const data::Output& output = study.outputs[set.outputs[column]];
    const Extent runs = outputs_of_runs(table, set, set.outputs[column]), seen = readings_of(set, column);
    if (!has_other_sign(study, set, output, runs, seen) || is_scaled(study, set, set.outputs[column])) continue;
    const char* const sign = seen.high < 0.0 ? "negative" : "positive";
    findings.push_back(
        {.kind = data::FindingKind::unit,
         .place = place_of(set, set.points.front()) + ": " + output.name,
         .severity = Severity::warning,
         .what = fmt::format("all readings are {}, {}", sign,
                             runs.values.empty()
                                 ? "where demcal's torque, which the drive must supply, is positive"
                                 : fmt::format("where all runs give {:.4g} to {:.4g}{}", output.unit.from_si(runs.low),
                                               output.unit.from_si(runs.high), behind_number(output.unit.symbol))),
         .remedy = fmt::format("multiply {} in {} by -1, if the sensor counts the other way round", output.name,
                               file_of(set)),
         .places = {}});
  }
}

/// Whether readings times a factor lie where the runs do, or a fifth of their reach beyond. The factor is above 0.
bool meets(const Extent& seen, const Extent& runs, double factor) {
  const double beyond = 0.2 * (runs.high - runs.low);
  return factor * seen.low >= runs.low - beyond && factor * seen.high <= runs.high + beyond;
}

/// Observed outputs beside those of all runs of the material.
void check_magnitude(const data::Study& study, const data::RunTable& table, const data::ObservationSet& set,
                     std::vector<Finding>& findings) {
  for (std::size_t column = 0; column < set.outputs.size(); ++column) {
    const data::Output& output = study.outputs[set.outputs[column]];
    const Extent runs = outputs_of_runs(table, set, set.outputs[column]), seen = readings_of(set, column);
    if (runs.values.size() < 5 || seen.values.empty() || is_scaled(study, set, set.outputs[column])) continue;
    if (has_other_sign(study, set, output, runs, seen)) continue;  // check_sign
    const double reach = runs.high - runs.low;
    const double ratio = data::median_of(seen.values) / data::median_of(runs.values);
    const bool apart = seen.high < runs.low || seen.low > runs.high;
    const bool far = seen.high < runs.low - reach || seen.low > runs.high + reach || !(ratio > 0.2 && ratio < 5.0);
    if (!(reach > 0.0) || !apart || !far) continue;
    const auto shown = [&](double si) { return output.unit.from_si(si); };
    const std::string unit = behind_number(output.unit.symbol);
    Finding finding{
        .kind = data::FindingKind::unit,
        .place = place_of(set, set.points.front()) + ": " + output.name,
        .severity = Severity::warning,
        .what = fmt::format("observed {:.4g}{}{} lie{} outside all runs, {:.4g} to {:.4g}{}", shown(seen.low),
                            seen.low < seen.high ? fmt::format(" to {:.4g}", shown(seen.high)) : "", unit,
                            seen.low < seen.high ? "" : "s", shown(runs.low), shown(runs.high), unit),
        .remedy = "",
        .places = {}};
    const auto known = known_factor(output.unit, data::median_of(seen.values), data::median_of(runs.values), 2.0);
    if (known && meets(seen, runs, ratio > 1.0 ? 1.0 / known->factor : known->factor))
      finding.what += fmt::format(": {:.3g} times the runs'. Is another unit meant, {}?", ratio, known->between);
    finding.remedy = fmt::format(
        "check the unit of {} in {} and in the run table, the fill and the geometry; where they are "
        "right, the model as it was run does not reach this",
        output.name, file_of(set));
    findings.push_back(std::move(finding));
  }
}

/// Observed controls beside the study's range and the runs, where a factor between units would explain that they do not
/// meet.
void check_control_unit(const data::Study& study, const data::RunTable& table, const data::ObservationSet& set,
                        std::vector<Finding>& findings) {
  for (std::size_t c = 0; c < study.controls.size(); ++c) {
    const data::Control& control = study.controls[c];
    Extent runs, seen;
    for (const data::RunRow& row : table.rows)
      if (!row.left_out && row.material == set.material) runs.add(row.inputs[input_column(table, control.name)]);
    for (const data::Observation& point : set.points) seen.add(point.controls[c]);
    if (runs.values.empty() || seen.values.empty()) continue;
    constexpr double least_factor = 1.5;  // units differ by more
    const double slack = 0.1 * (control.high - control.low);
    const double typical = data::median_of(runs.values);
    if (typical < control.low || typical > control.high) continue;  // then it is the runs' column that is odd
    const auto met = std::count_if(seen.values.begin(), seen.values.end(), [&](double value) {
      return value >= std::min(runs.low, control.low) - 0.2 * slack &&
             value <= std::max(runs.high, control.high) + 0.2 * slack;
    });
    if (2 * static_cast<std::size_t>(met) >= seen.values.size()) continue;
    const double middle = data::median_of(seen.values);
    if (middle < least_factor * runs.high && least_factor * middle > runs.low) continue;
    const UnitFactor* known = nullptr;  // that takes all readings into the range
    const std::vector<UnitFactor> factors = unit_factors(control.unit);
    for (const UnitFactor& candidate : factors)
      for (const double factor : {candidate.factor, 1.0 / candidate.factor})
        if (known == nullptr && factor * seen.low > control.low - 0.2 * slack &&
            factor * seen.high < control.high + 0.2 * slack)
          known = &candidate;
    if (known == nullptr) continue;
    findings.push_back(
        {.kind = data::FindingKind::unit,
         .place = place_of(set, set.points.front()) + ": " + control.name,
         .severity = Severity::warning,
         .what = fmt::format(
             "observed from {:.4g} to {:.4g}{}, the runs from {:.4g} to {:.4g}. Is another unit meant, {}?",
             control.unit.from_si(seen.low), control.unit.from_si(seen.high), behind_number(control.unit.symbol),
             control.unit.from_si(runs.low), control.unit.from_si(runs.high), known->between),
         .remedy = fmt::format("write both in the study's unit, or set controls.{}.unit", control.name),
         .places = {}});
  }
}

}  // namespace

std::string place_of(const data::ObservationSet& set, const data::Observation& point) {
  return fmt::format("{}:{}", file_of(set), point.line);
}

void check_beside_runs(const data::Study& study, const data::RunTable& table, const data::ObservationSet& set,
                       std::vector<data::Finding>& findings) {
  check_exchanged(study, table, set, findings);
  check_exchanged_outputs(study, table, set, findings);
  check_sign(study, table, set, findings);
  check_magnitude(study, table, set, findings);
  check_control_unit(study, table, set, findings);
}

}  // namespace uq
