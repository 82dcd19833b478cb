// Checks of what the errors of readings share: of repeats, of outputs at one setting, of sets that one meter read.
// Errors that are shared and counted as independent make widths too small.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "data/number_text.hpp"
#include "data/observations.hpp"
#include "data/repeats.hpp"
#include "uq/calibrate/data_columns.hpp"

namespace uq {
namespace {

using data::Finding;
using data::Severity;

/// Readings of one setting that share their error, which repetition does not lessen (data/repeats.hpp).
void check_repeats(const data::Study& study, const data::ObservationSet& set, std::vector<Finding>& findings) {
  for (const data::SharedErrors& repeats : set.repeats) {
    const std::string& name = study.outputs[repeats.output].name;
    Finding finding = data::about_rows(data::FindingKind::shared_errors, Severity::warning, {file_of(set)});
    finding.what = fmt::format(
        "{} readings of {} at {} scatter {:.2g} times as much as their standard errors say: repeats share an error, and "
        "more of them do not lessen it. Each setting counts as one reading",
        repeats.readings, name, data::counted(repeats.settings, "setting"), repeats.scatter);
    finding.remedy = fmt::format(
        "if they are independent, write their scatter into {0}_se; if all settings share the error, into common_error",
        name);
    findings.push_back(std::move(finding));
  }
}

/// The error of an idle torque that `observe` has taken off every row, where the study does not state it.
void check_idle_error(const data::Study& study, const data::ObservationSet& set, std::vector<Finding>& findings) {
  if (!set.common_errors.empty()) return;
  constexpr std::string_view mark = data::idle_error_mark;
  for (const std::string& line : set.header) {
    const std::size_t at = line.find(mark);
    if (at == std::string::npos) continue;
    const bool sampled = std::any_of(study.cases.begin(), study.cases.end(), [&](const data::CalibrationCase& one) {
      return std::find(one.observe.begin(), one.observe.end(), set.name) != one.observe.end() &&
             std::any_of(one.nuisances.begin(), one.nuisances.end(),
                         [](const data::Nuisance& nuisance) { return nuisance.kind == data::NuisanceKind::offset; });
    });
    if (sampled) return;
    findings.push_back({.kind = data::FindingKind::error_left_out,
                        .place = set.place,
                        .severity = Severity::warning,
                        .what = fmt::format("{} states the error of the idle torque, which all its rows share, and the "
                                            "study does not: widths are too small",
                                            file_of(set)),
                        .remedy = "add " + line.substr(at + mark.size()),
                        .places = {}});
    return;
  }
}

/// Common errors of several sets, each taken as the set's own: too narrow a posterior where one meter read them all.
void check_meters(const data::Study& study, std::vector<Finding>& findings) {
  for (std::size_t output = 0; output < study.outputs.size(); ++output) {
    std::vector<std::string> sets, places;
    for (const data::ObservationSet& set : study.observations) {
      const bool common = std::any_of(set.common_errors.begin(), set.common_errors.end(),
                                      [&](const data::CommonError& error) { return error.output == output; });
      if (!common || !set.meter.empty()) continue;
      sets.push_back("'" + set.name + "'");
      places.push_back(set.place);
    }
    if (sets.size() < 2) continue;
    Finding finding = data::about_rows(data::FindingKind::errors_apart, Severity::note, places);
    finding.what = fmt::format("the common errors of {} in {} are taken as independent", study.outputs[output].name,
                               fmt::join(sets, ", "));
    finding.remedy = "if one meter read them all, name it in each: meter = \"torque-cell\"";
    findings.push_back(std::move(finding));
  }
}

/// Outputs of one file whose errors are taken as independent: too narrow a posterior where they were read off one
/// picture.
void check_readings(const data::Study& study, const data::ObservationSet& set, std::vector<Finding>& findings) {
  if (set.outputs.size() < 2 || !set.correlations.empty()) return;
  std::vector<std::string> names;
  for (const std::size_t output : set.outputs) names.push_back(study.outputs[output].name);
  Finding finding = data::about_rows(data::FindingKind::errors_apart, Severity::note, {set.place});
  finding.what = fmt::format("the errors of {} at one setting are taken as independent", fmt::join(names, ", "));
  finding.remedy = "if they were read off one picture, or by one instrument, state [[observe.correlation]]";
  findings.push_back(std::move(finding));
}

/// Readings whose errors are said to go with another set's, which has none at their settings.
void check_correlations(const data::Study& study, const data::ObservationSet& set, std::vector<Finding>& findings) {
  for (const data::ErrorCorrelation& stated : set.correlations) {
    const data::ObservationSet& other = study.observations[study.observation_index(stated.other_set).value()];
    const std::optional<std::size_t> column = set.column_of(stated.output),
                                     other_column = other.column_of(stated.other_output);
    if (!column || !other_column) continue;
    std::size_t joined = 0;
    for (const auto& [point, other_point] : data::points_at_same_settings(study, set, other))
      joined += set.points[point].has(*column) && other.points[other_point].has(*other_column);
    const std::size_t readings = data::points_with(set, *column).size();
    if (joined == readings) continue;
    const Severity severity = joined == 0 ? Severity::warning : Severity::note;
    Finding finding = data::about_rows(data::FindingKind::errors_apart, severity, {stated.place});
    finding.what = fmt::format(
        "{} of {} readings of {} have no reading of {} at their setting in '{}': their errors are "
        "taken as independent",
        readings - joined, readings, study.outputs[stated.output].name, study.outputs[stated.other_output].name,
        other.name);
    finding.remedy =
        fmt::format("give both the same settings, to {:g} % of a control's range", 100.0 * data::same_setting);
    findings.push_back(std::move(finding));
  }
}

/// Whether the sets say of an output what their errors share: by their meter, or by a correlation.
bool states_sharing(const data::ObservationSet& set, const data::ObservationSet& other, std::size_t output) {
  const auto names = [output](const data::ObservationSet& one, const data::ObservationSet& two) {
    return std::any_of(one.correlations.begin(), one.correlations.end(), [&](const data::ErrorCorrelation& stated) {
      return stated.output == output && stated.other_set == two.name;
    });
  };
  return (!set.meter.empty() && set.meter == other.meter) || names(set, other) || names(other, set);
}

/// Two sets whose readings at the same settings agree too well to be independent: a table and its copy with fewer
/// digits. `one_case`: one case observes both; else one is predicted from the other.
void check_agreement(const data::Study& study, const data::ObservationSet& set, const data::ObservationSet& other,
                     bool one_case, std::vector<Finding>& findings) {
  if (set.material != other.material) return;
  const auto pairs = data::points_at_same_settings(study, set, other);
  for (std::size_t column = 0; column < set.outputs.size(); ++column) {
    const std::optional<std::size_t> other_column = other.column_of(set.outputs[column]);
    if (!other_column || states_sharing(set, other, set.outputs[column])) continue;
    data::Agreement agreement;
    for (const auto& [i, j] : pairs) {
      const data::Observation &one = set.points[i], &two = other.points[j];
      if (!one.has(column) || !two.has(*other_column)) continue;
      agreement.add(std::pow(one.values[column] - two.values[*other_column], 2) /
                        (std::pow(one.standard_errors[column], 2) + std::pow(two.standard_errors[*other_column], 2)),
                    1);
    }
    if (!agreement.too_good() || agreement.scatter() == 0.0)
      continue;  // copies to the last digit are refused elsewhere
    Finding finding = data::about_rows(one_case ? data::FindingKind::counted_twice : data::FindingKind::shared_errors,
                                       Severity::warning, {set.place, other.place});
    finding.what = fmt::format(
        "{} readings of {} in '{}' and '{}' differ {:.2g} times as much as their standard errors say: they are the same "
        "readings, or share an error{}",
        agreement.degrees(), study.outputs[set.outputs[column]].name, set.name, other.name, agreement.scatter(),
        one_case ? ", which counts twice" : "; to predict them says little");
    finding.remedy = "use one of the two, or state what they share: the meter, or [[observe.correlation]]";
    findings.push_back(std::move(finding));
  }
}

/// Sets that a case observes or that are predicted from it, each pair once.
void check_pairs(const data::Study& study, std::vector<Finding>& findings) {
  std::set<std::pair<std::string, std::string>> seen;
  const auto check = [&](const std::string& one, const std::string& two, bool one_case) {
    if (one == two || !seen.insert(std::minmax(one, two)).second) return;
    check_agreement(study, study.observations[study.observation_index(one).value()],
                    study.observations[study.observation_index(two).value()], one_case, findings);
  };
  for (const data::CalibrationCase& one : study.cases)
    for (const std::string& set : one.observe)
      for (const std::string& other : one.observe) check(set, other, true);
  for (const data::UnusedData& wanted : study.unused_data)
    for (const std::string& set : wanted.observe)
      for (const std::string& other : study.cases[wanted.case_index].observe) check(set, other, false);
}

}  // namespace

void check_shared_errors(const data::Study& study, const data::ObservationSet& set, std::vector<Finding>& findings) {
  check_repeats(study, set, findings);
  check_readings(study, set, findings);
  check_correlations(study, set, findings);
  check_idle_error(study, set, findings);
}

void check_errors_of_sets(const data::Study& study, std::vector<Finding>& findings) {
  check_meters(study, findings);
  check_pairs(study, findings);
}

}  // namespace uq
