#include "uq/calibrate/case_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uq/calibrate/data_columns.hpp"
#include "uq/findings/study_units.hpp"

namespace uq {
namespace {

constexpr const char* check_reading =
    "Check that reading, its unit and its decimal point first; where it is wrong, take its line out.";

std::string line_of(const data::Study& study, const RowOrigin& origin) {
  const data::ObservationSet& set = study.observations[origin.set];
  return place_of(set, set.points[origin.point]);
}

/// "torque 31.2 mN m at rpm 150 (bench.csv:5)".
std::string reading_in_words(const data::Study& study, const RowOrigin& origin) {
  const data::ObservationSet& set = study.observations[origin.set];
  const data::Observation& point = set.points[origin.point];
  const data::Output& output = study.outputs[origin.output];
  std::string at;
  for (std::size_t c = 0; c < study.controls.size(); ++c)
    at += fmt::format("{} {} {:.4g}{}", at.empty() ? " at" : ",", study.controls[c].name,
                      study.controls[c].unit.from_si(point.controls[c]), behind_number(study.controls[c].unit.symbol));
  return fmt::format("{} {:.4g}{}{} ({})", output.name,
                     output.unit.from_si(point.values[set.column_of(origin.output).value()]),
                     behind_number(output.unit.symbol), at, line_of(study, origin));
}

}  // namespace

void say_doubt(CaseReport& report, DoubtOf of, Words& words, const data::Study& study) {
  const bool own_engine = study.training.engine == data::Engine::demcal;
  words.finding =
      fmt::format("No verdict: {}.{}", report.doubt,
                  report.fits            ? ""
                  : of == DoubtOf::prior ? " At no value does the model reproduce the data either."
                                         : " As it stands, the surrogate does not reproduce the data either.");
  if (const std::string off = farthest_off(report.predictive); !report.fits && !off.empty()) words.finding += " " + off;
  report.traded.clear();
  if (of == DoubtOf::surrogate) {
    words.consequence = "What the surrogate gives for the parameters is not the model's, and is not shown.";
    words.remedies = {"See the surrogate's remedy above; then calibrate again."};
  } else if (of == DoubtOf::support) {
    words.consequence = "The values are extrapolated, and no results.";
    words.remedies = {
        fmt::format("Run {} of the posterior's points ({}), and calibrate again.", report.support.next_runs.size(),
                    own_engine ? "demcal train STUDY --at-posterior N" : "next-runs.csv beside the report")};
  } else if (of == DoubtOf::draws) {
    words.consequence = "The values are those of draws that do not agree yet, and no results.";
    words.remedies = {
        "Fix what the data say nothing of, or try the other sampler (--sampler nuts, --sampler mixture)."};
  } else if (of == DoubtOf::prior) {
    words.consequence = "The values are a compromise of the two, which neither supports.";
    words.remedies = {
        "Check that prior, and what it was measured on; then the data's units and errors. Without the prior the data "
        "speak alone."};
  } else if (of == DoubtOf::source) {
    words.consequence = "What rests on that case is no result either.";
    words.remedies = {"Follow the remedy of that case first; then calibrate again."};
  } else {
    words.consequence = "The values with and without those runs are both shown; neither is a result yet.";
    words.remedies = {"Correct the runs or leave them out ([training] leave_out), and calibrate again."};
  }
}

void say_poor_fit(Words& words, const FitCheck& check) {
  words.finding += fmt::format(
      " The fit is poor: chi2 {:.1f} for {} degrees of freedom, as far off as {:.1g} % of the model's own data.",
      check.chi2, check.dof, 100.0 * check.best_fit_p);
  words.consequence += " The errors do not cover a model that is off, nor readings that scatter more than is stated.";
  words.remedies.insert(words.remedies.begin(), "Look first at what the residuals have in common.");
}

std::string outlying_warning(const std::string& name, const data::Study& study, const OutlyingReading& one) {
  return fmt::format(
      "case {}: {} lies {:.2g} errors of the others from what they say (chance {:.1g}), and widens the "
      "unknown errors by a factor of {:.2g}",
      name, reading_in_words(study, one.origin), one.errors, one.chance, one.widening);
}

void say_outlying_reading(Words& words, const data::Study& study, const OutlyingReading& one) {
  words.finding +=
      fmt::format(" {} is far from what all others say, and widens every value.", reading_in_words(study, one.origin));
  words.consequence = "Look at that reading before any value is used.";
  words.remedies = {check_reading};
}

void say_close_fit(Words& words, const FitCheck& check) {
  words.finding += fmt::format(
      " The readings lie {:.2g} times closer to the model than their errors let expect (chi2 {:.2g} for {} degrees of "
      "freedom).",
      std::sqrt(check.dof / check.chi2), check.chi2, check.dof);
  words.consequence += " The intervals are wider than the readings' own scatter makes them.";
  words.remedies.emplace_back(
      "Look at the stated errors: a part that all readings share is no scatter, and belongs into common_error of the "
      "observations.");
}

void say_lack_of_fit(Words& words, const LackOfFit& lack) {
  words.finding += fmt::format(
      " The settings' means lie {:.2g} times farther from the model than their readings let expect (p {:.1g}): readings "
      "of one setting share an error, or the model is off.",
      std::sqrt(lack.f), lack.p);
  words.consequence =
      fmt::format("The errors given are too small: {} readings of {} settings were taken for {} independent ones.",
                  lack.readings, lack.settings, lack.readings);
  words.remedies.insert(
      words.remedies.begin(),
      "Give each setting one row, the mean of its readings, so that the means' scatter about the model "
      "sets the errors; then look at what their residuals have in common.");
}

std::string lack_of_fit_warning(const std::string& name, const LackOfFit& lack) {
  return fmt::format(
      "case {}: the means of {} settings lie {:.2g} times farther from the model than their {} readings let expect (F "
      "test, p {:.1g}): the errors given are too small",
      name, lack.settings, std::sqrt(lack.f), lack.readings, lack.p);
}

void say_misfit(Words& words, const CaseReport& report, const data::Study& study, const CaseModel& model,
                const Identification& found, const VerdictThresholds& thresholds) {
  if (const std::string off = farthest_off(report.predictive); !off.empty()) words.finding += " " + off;
  const Contradiction sets = describe_contradiction(fits_alone(study, model, found.best_fit.x), thresholds.best_fit_p);
  if (!sets.finding.empty()) {
    words.finding += " " + sets.finding;
    words.remedies.insert(words.remedies.begin(), sets.remedy);
  }
}

void say_lone_reading(CaseReport& report, Words& words, const data::Study& study, const LoneReading& lone) {
  report.lone_reading = line_of(study, lone.origin);
  words.finding += fmt::format(" {} contradicts all others, which fit without it (p {:.2g}).",
                               reading_in_words(study, lone.origin), lone.p_without);
  words.remedies = {check_reading};
}

}  // namespace uq
