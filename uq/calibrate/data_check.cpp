// All looks at the data, and those at the outputs of the runs and at the priors.
#include "uq/calibrate/data_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "uq/calibrate/data_columns.hpp"
#include "uq/findings/study_units.hpp"
#include "uq/posterior/prior.hpp"

namespace uq {
namespace {

using data::Finding;
using data::Severity;

}  // namespace

std::vector<UnitFactor> unit_factors(const data::Unit& unit) {
  struct Known {
    UnitFactor factor;
    std::vector<std::string> dimensions;  // SI base units of which the quantity has one; none: any quantity
    bool of_ratios = false;               // what numbers without a unit are most often written in
  };
  static const std::vector<Known> all{
      {{1000.0, "one prefix (m, k) more or less"}, {}},
      {{1e6, "two prefixes (u, M) more or less"}, {}},
      {{60.0, "minutes against seconds"}, {"s"}},
      {{60.0 / (2.0 * std::numbers::pi), "rpm against rad/s"}, {"rad"}},
      {{2.0 * std::numbers::pi, "turns against radians"}, {"rad"}},
      {{180.0 / std::numbers::pi, "degrees against radians"}, {"rad"}, true},
      {{100.0, "percent, or cm against m"}, {"m"}, true},
      {{1e4, "cm2 against m2"}, {"m"}},
      {{9.80665, "kgf against N, or N cm against mN m"}, {"kg"}},
      {{1e9, "three prefixes (n, G) more or less"}, {}},
  };
  const bool bare = data::is_bare(unit.symbol);  // nothing is known of what it measures
  const auto has = [&](const std::string& base) {
    std::istringstream terms(unit.si_symbol);
    for (std::string term; terms >> term;)
      if (term.substr(0, term.find_first_of("-0123456789")) == base) return true;
    return false;
  };
  std::vector<UnitFactor> found;
  for (const bool of_ratios : {true, false})
    for (const Known& known : all)
      if ((bare ? known.of_ratios : false) == of_ratios &&
          (bare || known.dimensions.empty() || std::any_of(known.dimensions.begin(), known.dimensions.end(), has)))
        found.push_back(known.factor);
  return found;
}

std::optional<UnitFactor> known_factor(const data::Unit& unit, double typical, double expected, double slack) {
  if (!(typical * expected > 0.0)) return {};
  const double wanted = std::abs(std::log(expected / typical));
  std::optional<UnitFactor> best;
  double nearest = std::log(slack);
  for (const UnitFactor& known : unit_factors(unit))
    if (const double off = std::abs(wanted - std::log(known.factor)); off < nearest) {
      nearest = off;
      best = known;
    }
  return best;
}

std::vector<Finding> check_outputs(const data::Study& study, const data::RunTable& table,
                                   const std::vector<std::string>& log_outputs) {
  std::vector<Finding> findings;
  for (std::size_t k = 0; k < study.outputs.size(); ++k) {
    const data::Output& output = study.outputs[k];
    const bool logarithmic = std::find(log_outputs.begin(), log_outputs.end(), output.name) != log_outputs.end();
    std::vector<std::string> exact, no_logarithm;
    std::size_t count = 0, with_error = 0;
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (const data::RunRow& row : table.rows) {
      const double value = row.outputs[k], error = row.standard_errors[k];
      if (row.left_out || !std::isfinite(value) || !std::isfinite(error)) continue;
      ++count;
      with_error += error > 0.0;
      least = std::min(least, value);
      most = std::max(most, value);
      if (!(error > 0.0)) exact.push_back(row.place);
      if (logarithmic && !(value > 0.0)) no_logarithm.push_back(row.place);
    }
    if (count == 0) continue;
    if (!exact.empty() && 2 * with_error > count) {
      Finding finding = data::about_rows(data::FindingKind::zero_standard_error, Severity::warning, exact);
      finding.what = fmt::format("{} {} a standard error of 0 for {}, where the other {} have one: {} taken as exact",
                                 exact.size(), exact.size() == 1 ? "row has" : "rows have", output.name, with_error,
                                 exact.size() == 1 ? "it is" : "they are");
      finding.remedy = "give the standard error, or leave the rows out ([training] leave_out)";
      findings.push_back(std::move(finding));
    }
    if (!no_logarithm.empty()) {
      Finding finding = data::about_rows(data::FindingKind::no_logarithm, Severity::refusal, no_logarithm);
      finding.what = fmt::format("{} is not above 0, and surrogate.log_outputs learns its logarithm", output.name);
      finding.remedy = "leave the rows out ([training] leave_out), or leave the output out of log_outputs";
      findings.push_back(std::move(finding));
    }
    if (count > 2 && !(most > least))
      findings.push_back(
          {.kind = data::FindingKind::no_response,
           .place = table.rows.front().place,
           .severity = Severity::warning,
           .what = fmt::format("{} is {:.5g}{} in all {} runs: it does not respond to any input, and "
                               "nothing can be learned from it",
                               output.name, output.unit.from_si(least), behind_number(output.unit.symbol), count),
           .remedy = "look at how the column was written",
           .places = {}});
  }
  return findings;
}

std::vector<Finding> check_priors(const data::Study& study) {
  constexpr double decade = 10.0;
  std::vector<Finding> findings;
  for (const data::Parameter& parameter : study.parameters) {
    if (parameter.scale != data::Scale::log || parameter.prior.stated || parameter.high < decade * parameter.low)
      continue;
    const bool used = std::any_of(study.cases.begin(), study.cases.end(), [&](const data::CalibrationCase& one) {
      return std::find(one.free.begin(), one.free.end(), parameter.name) != one.free.end() &&
             !one.priors.contains(parameter.name);
    });
    if (!used) continue;
    const double top = parameter.high / decade, share = (parameter.high - top) / (parameter.high - parameter.low);
    findings.push_back(
        {.kind = data::FindingKind::prior_not_stated,
         .place = parameter.place,
         .severity = Severity::note,
         .what = fmt::format(
             "the prior of {} is not stated, and uniform in its value, with {:.0f} % of it above {:.4g}{}",
             parameter.name, 100.0 * share, parameter.unit.from_si(top), behind_number(parameter.unit.symbol)),
         .remedy =
             "prior = { kind = \"log_uniform\" } gives every decade the same weight; kind = \"uniform\" says that "
             "this is meant",
         .places = {}});
  }
  return findings;
}

std::vector<Finding> check_data(const data::Study& study, data::RunTable& table,
                                const std::optional<data::RunTable>& low, const std::vector<std::string>& log_outputs,
                                const DataCheckThresholds& thresholds) {
  std::vector<Finding> all;
  const auto add = [&all](std::vector<Finding> found) {
    for (Finding& one : found) all.push_back(std::move(one));
  };
  if (data::used_rows(table) > 0) {
    add(check_ranges(study, table, thresholds));
    add(check_outputs(study, table, log_outputs));
    add(check_mixed_units(study, table));
    if (!data::has(all, Severity::refusal)) {
      add(check_design(study, table, thresholds));
      add(check_unread_inputs(study, table, thresholds));
    }
  }
  add(check_priors(study));
  add(check_observations(study, table, thresholds));
  add(check_saturated(study, table));
  if (!data::has(all, Severity::refusal)) add(check_cases(study, table, low));
  return all;
}

}  // namespace uq
