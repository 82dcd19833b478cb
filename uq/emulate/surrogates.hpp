#pragma once
// One surrogate per material and output from the run table: a Gaussian process, or, where there are runs of a cheaper
// level ([training] low), a two-level process under the table's. Its inputs are what that material's rows vary:
// parameters in uq/posterior/prior.hpp's u, controls by their range. Each run's standard error enters as known noise, scatter
// beyond it as nugget. A row without one output (NaN) trains the others.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data/run_table.hpp"
#include "data/study.hpp"
#include "surrogate/fit.hpp"
#include "surrogate/two_level.hpp"
#include "surrogate/validation.hpp"
#include "uq/emulate/emulator.hpp"
#include "uq/findings/results.hpp"

namespace uq {

/// A material's rows of one output, as the surrogate sees them.
struct TrainingRows {
  std::string material;
  std::size_t output = 0;
  surrogate::TrainingSet set;                 ///< SI
  std::optional<surrogate::TrainingSet> low;  ///< SI, runs of the cheaper level
  std::vector<std::string> places;            ///< of the runs of `set`: "runs.csv:31"
  std::vector<EmulatorInput> inputs;
  std::map<std::size_t, double> constants;  ///< parameters held at one value, SI
  std::map<std::size_t, std::pair<double, double>> control_range;
};

struct FittedSurrogate {
  TrainingRows rows;
  std::shared_ptr<const surrogate::GaussianProcess> process;    ///< of the low level where there are two
  std::shared_ptr<const surrogate::TwoLevelProcess> two_level;  ///< none: one level
  SurrogateReport report;
};

struct SurrogateOptions {
  /// Matern 5/2 about a constant, integrated over where runs are few, between the runs doubted: surrogate/COVERAGE.md
  /// says why.
  surrogate::FitOptions fit = {.hyper_uncertainty = surrogate::HyperUncertainty::integrated_if_few,
                               .between_runs = surrogate::BetweenRuns::doubted};
  std::vector<std::string> log_outputs = {};     ///< outputs that are learnt as logarithms, whatever fit.scale
  surrogate::ValidationOptions validation = {};  ///< its seed is that of the fit
  int runs_most = 1000;                          ///< of a table with more, so many train, chosen at random
  bool observed_only = false;                    ///< leave out the outputs that no case observes or predicts
  std::optional<data::RunTable> low = {};        ///< runs of the cheaper level
  std::vector<FittedSurrogate> known = {};       ///< fitted before under the same options: not fitted again
};

/// Rows of every material and output that have any. Throws data::InputError (65): a table without a column of the
/// study, rows fewer than a surrogate needs (inputs + 2; three of the dear level where there are two).
std::vector<TrainingRows> training_rows(const data::Study& study, const data::RunTable& table,
                                        const std::optional<data::RunTable>& low = {});

/// Emulators that know what their runs cover, and predict nothing: enough to see whether a case or a plan can be. Throws
/// as `training_rows` does.
std::vector<Emulator> outlines_of(const data::Study& study, const data::RunTable& table,
                                  const std::optional<data::RunTable>& low = {});

/// Where the runs of each material that a fitted surrogate stands for lie, those left out too.
std::vector<DesignReport> designs_of(const data::Study& study, const data::RunTable& table,
                                     const std::vector<FittedSurrogate>& fitted);

std::vector<FittedSurrogate> fit_surrogates(const data::Study& study, const data::RunTable& table,
                                            const SurrogateOptions& options = {});

/// What the observations ask of the surrogate outside the box of its runs, one sentence each.
std::vector<std::string> extrapolation_notes(const data::Study& study, const TrainingRows& rows);

/// "[training] leave_out = [...]" for these runs.
std::string leave_out_key(const std::vector<OutlyingRun>& runs);

/// What must stand in the first lines of whatever rests on the surrogates: unusable, not converged, runs that the
/// others contradict.
std::vector<std::string> surrogate_warnings(const std::vector<FittedSurrogate>& fitted);

/// What is said of them without making the status a warning: surrogates to be used with caution.
std::vector<std::string> surrogate_cautions(const std::vector<FittedSurrogate>& fitted);

/// "carrier torque": by this name a surrogate is saved.
std::string surrogate_name(const data::Study& study, const TrainingRows& rows);

/// The process, or the two, with the emulator's bookkeeping.
Emulator emulator_of(const FittedSurrogate& fitted);
std::vector<Emulator> emulators_of(const std::vector<FittedSurrogate>& fitted);

}  // namespace uq
