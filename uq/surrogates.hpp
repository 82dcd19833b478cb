#pragma once
// One Gaussian process per material and output from the run table. Its inputs are what that material's rows vary:
// parameters in uq/prior.hpp's u, controls by their range. Each run's standard error enters as known noise, scatter
// beyond it as nugget.
#include <memory>
#include <string>
#include <vector>

#include "data/run_table.hpp"
#include "data/study.hpp"
#include "surrogate/fit.hpp"
#include "surrogate/validation.hpp"
#include "uq/emulator.hpp"
#include "uq/results.hpp"

namespace uq {

struct SurrogateOptions {
  surrogate::FitOptions fit = {};
  surrogate::ValidationOptions validation = {};  ///< its seed is that of the fit
  bool observed_only = false;                    ///< leave out the outputs that no case observes
};

/// A material's rows of one output, as the surrogate sees them.
struct TrainingRows {
  std::string material;
  std::size_t output = 0;
  surrogate::TrainingSet set;  ///< SI
  std::vector<EmulatorInput> inputs;
  std::map<std::size_t, double> constants;  ///< parameters held at one value, SI
  std::map<std::size_t, std::pair<double, double>> control_range;
};

/// Rows of every material and output that have any. Throws data::InputError (65): a table without a column of the
/// study, rows fewer than a surrogate needs (inputs + 2), rows outside a parameter's range.
std::vector<TrainingRows> training_rows(const data::Study& study, const data::RunTable& table);

struct FittedSurrogate {
  TrainingRows rows;
  std::shared_ptr<const surrogate::GaussianProcess> process;
  SurrogateReport report;
};

std::vector<FittedSurrogate> fit_surrogates(const data::Study& study, const data::RunTable& table,
                                            const SurrogateOptions& options = {});

/// The process of given rows with its emulator's bookkeeping: for processes loaded from a file.
Emulator emulator_of(const TrainingRows& rows, std::shared_ptr<const surrogate::GaussianProcess> process);
std::vector<Emulator> emulators_of(const std::vector<FittedSurrogate>& fitted);

}  // namespace uq
