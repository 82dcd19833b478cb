#pragma once
// One surrogate per material and output from the run table: a Gaussian process, or, where there are runs of a cheaper
// level ([training] low), a two-level process under the table's. Its inputs are what that material's rows vary:
// parameters in uq/posterior/prior.hpp's u, controls by their range. Each run's standard error enters as known noise,
// scatter beyond it as nugget. A row without one output (NaN) trains the others.
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
#include "uq/findings/surrogate_results.hpp"

namespace uq {

/// A material's rows of one output, as the surrogate sees them.
struct TrainingRows {
  std::string material;
  std::size_t output = 0;
  surrogate::TrainingSet set;                 ///< SI
  std::optional<surrogate::TrainingSet> low;  ///< SI, runs of the cheaper level
  std::vector<std::string> places;            ///< place of each run of `set`: "runs.csv:31"
  std::vector<EmulatorInput> inputs;          ///< columns of the points, which lie on their learnt scales
  std::map<std::size_t, double> constants;    ///< parameters held at one value, SI
  std::map<std::size_t, std::pair<double, double>> control_range;
};

/// The place on the study's unit interval of a point's learnt coordinate.
inline double study_place(const EmulatorInput& input, double learnt) { return input.stretch.origin(learnt); }

/// Moves the rows of all levels, which lie in the study's unit cube, to other scales; one ratio for each input.
void stretch_rows(TrainingRows& rows, const std::vector<double>& ratios);

struct FittedSurrogate {
  TrainingRows rows;
  std::shared_ptr<const surrogate::GaussianProcess> process;    ///< process of the low level where there are two
  std::shared_ptr<const surrogate::TwoLevelProcess> two_level;  ///< none: one level
  SurrogateReport report;
};

struct SurrogateOptions {
  /// Matern 5/2 about a constant. Hyper-parameters are integrated over where runs are few, and the process is doubted
  /// between the runs: surrogate/COVERAGE.md says why.
  surrogate::FitOptions fit = {.hyper_uncertainty = surrogate::HyperUncertainty::integrated_if_few,
                               .between_runs = surrogate::BetweenRuns::doubted};
  bool stretch = true;                           ///< inputs may be learnt on stretched scales (surrogate/stretch.hpp)
  std::vector<std::string> log_outputs = {};     ///< outputs that are learnt as logarithms, whatever fit.scale
  surrogate::ValidationOptions validation = {};  ///< options whose seed is that of the fit
  int runs_most = 1000;                          ///< most runs that train; a larger table is thinned at random
  bool observed_only = false;                    ///< leave out the outputs that no case observes or predicts
  std::optional<data::RunTable> low = {};        ///< runs of the cheaper level
  std::vector<FittedSurrogate> known = {};       ///< surrogates fitted before under the same options: not fitted again
};

/// Rows of every material and output that have any. Throws data::InputError (65): a table without a column of the
/// study, rows fewer than a surrogate needs (inputs + 2; three of the dear level where there are two).
std::vector<TrainingRows> training_rows(const data::Study& study, const data::RunTable& table,
                                        const std::optional<data::RunTable>& low = {});

/// Emulators that know what their runs cover, and predict nothing. They are enough to see whether a case or a plan is
/// possible. Throws as `training_rows` does.
std::vector<Emulator> outlines_of(const data::Study& study, const data::RunTable& table,
                                  const std::optional<data::RunTable>& low = {});

/// The places of the runs, those left out too, for each material that has a fitted surrogate.
std::vector<DesignReport> designs_of(const data::Study& study, const data::RunTable& table,
                                     const std::vector<FittedSurrogate>& fitted);

std::vector<FittedSurrogate> fit_surrogates(const data::Study& study, const data::RunTable& table,
                                            const SurrogateOptions& options = {});

/// Notes on observations outside the box of the surrogate's runs, one sentence each.
std::vector<std::string> extrapolation_notes(const data::Study& study, const TrainingRows& rows);

/// The key that leaves these runs out: "[training] leave_out = [...]".
std::string leave_out_key(const std::vector<OutlyingRun>& runs);

/// Warnings for the first lines of whatever rests on the surrogates: unusable, not converged, runs that the others
/// contradict.
std::vector<std::string> surrogate_warnings(const std::vector<FittedSurrogate>& fitted);

/// Remarks that do not make the status a warning: surrogates to be used with caution.
std::vector<std::string> surrogate_cautions(const std::vector<FittedSurrogate>& fitted);

/// The name by which a surrogate is saved: "carrier torque".
std::string surrogate_name(const data::Study& study, const TrainingRows& rows);

/// The fitted process, or the two-level one, as an emulator.
Emulator emulator_of(const FittedSurrogate& fitted);
std::vector<Emulator> emulators_of(const std::vector<FittedSurrogate>& fitted);

}  // namespace uq
