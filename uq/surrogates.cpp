#include "uq/surrogates.hpp"

#include <algorithm>

#include "uq/surrogate_report.hpp"

namespace uq {
namespace {

/// Whether some case uses measurements of this material and output.
bool is_observed(const data::Study& study, const TrainingRows& rows) {
  for (const auto& one : study.cases)
    for (const auto& name : one.observe) {
      const data::ObservationSet& set = study.observations[study.observation_index(name).value()];
      if (set.material == rows.material &&
          std::find(set.outputs.begin(), set.outputs.end(), rows.output) != set.outputs.end())
        return true;
    }
  return false;
}

FittedSurrogate fit_one(const data::Study& study, TrainingRows rows, const SurrogateOptions& options) {
  const surrogate::FitOptions fit_options = options_for(study, rows, options);
  FittedSurrogate fitted{.rows = std::move(rows), .process = {}, .two_level = {}, .report = {}};
  const surrogate::TrainingSet& base = fitted.rows.low ? *fitted.rows.low : fitted.rows.set;
  fitted.process = std::make_shared<const surrogate::GaussianProcess>(surrogate::fit(base, fit_options));
  if (fitted.rows.low)
    fitted.two_level = std::make_shared<const surrogate::TwoLevelProcess>(
        surrogate::fit_two_level(*fitted.process, fitted.rows.set, {.seed = options.fit.seed}));
  fitted.report = report_of(study, fitted, options);
  return fitted;
}

}  // namespace

std::vector<FittedSurrogate> fit_surrogates(const data::Study& study, const data::RunTable& table,
                                            const SurrogateOptions& options) {
  std::vector<FittedSurrogate> fitted;
  for (TrainingRows& rows : training_rows(study, table, options.low)) {
    if (options.observed_only && !is_observed(study, rows)) continue;
    const auto known = std::find_if(options.known.begin(), options.known.end(), [&](const FittedSurrogate& item) {
      return item.rows.material == rows.material && item.rows.output == rows.output;
    });
    fitted.push_back(known != options.known.end() ? *known : fit_one(study, std::move(rows), options));
  }
  return fitted;
}

std::string surrogate_name(const data::Study& study, const TrainingRows& rows) {
  const std::string& output = study.outputs[rows.output].name;
  return rows.material.empty() ? output : rows.material + " " + output;
}

Emulator emulator_of(const FittedSurrogate& fitted) {
  const TrainingRows& rows = fitted.rows;
  Emulator emulator = fitted.two_level ? make_emulator(fitted.two_level, rows.material, rows.output, rows.inputs)
                                       : make_emulator(fitted.process, rows.material, rows.output, rows.inputs);
  emulator.constants = rows.constants;
  emulator.control_range = rows.control_range;
  return emulator;
}

std::vector<Emulator> emulators_of(const std::vector<FittedSurrogate>& fitted) {
  std::vector<Emulator> emulators;
  for (const FittedSurrogate& item : fitted) emulators.push_back(emulator_of(item));
  return emulators;
}

}  // namespace uq
