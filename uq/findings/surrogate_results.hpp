#pragma once
// Findings about the runs and what was learnt from them: surrogates, the runs that the others contradict, designs.
#include <limits>
#include <string>
#include <vector>

#include "uq/findings/kinds.hpp"

namespace uq {

/// A run that the others contradict (uq/emulate/outlying_runs.hpp).
struct OutlyingRun {
  std::string place;                      ///< "runs.csv:31"
  double observed = 0.0, expected = 0.0;  ///< unit of the output
  double deviations = 0.0;                ///< difference in robust standard deviations, signed
};

/// Validation of one surrogate.
struct SurrogateReport {
  std::string output, material;
  int runs = 0;
  double q2 = 0.0;           ///< Q2 of leave-one-out
  double q2_held_out = 0.0;  ///< Q2 of held-out folds, hyper-parameters refitted
  double coverage95 = 0.0;   ///< coverage of the 95 % leave-one-out intervals
  double nugget_sd = 0.0;    ///< unit of the output
  std::string unit;
  SurrogateWord verdict = SurrogateWord::unusable;
  std::string finding, consequence, remedy;
  std::vector<std::string> inputs;    ///< names of the active inputs
  std::vector<double> stretches;      ///< how the inputs' scales are stretched (surrogate/stretch.hpp), 1: as they are
  std::vector<double> length_scales;  ///< in units of the input's range, on the stretched scale
  std::vector<double> first_order, first_order_sd;        ///< Sobol indices of the inputs (uq/emulate/sensitivity.hpp)
  std::vector<double> total_order, total_order_sd;        ///< with their sd from the surrogate's uncertainty
  std::vector<double> observed, predicted, standardised;  ///< leave-one-out, per run
  std::vector<double> observed_se;
  std::vector<double> coverage_left_out, coverage_held_out;  ///< coverage of the 50, 90 and 95 % intervals
  // Held-out folds (Bastos & O'Hagan 2009): Mahalanobis distance, runs in the fold, tail probability of the distance.
  std::vector<double> fold_distance, fold_runs, fold_probability;
  std::vector<double> pivoted_errors;  ///< pivoted Cholesky errors, fold after fold, each in pivoting order
  std::vector<std::string> notes;      ///< hyper-parameter on its bound, jitter, multi-start outcomes
  std::string errors_in_doubt;         ///< says that the runs' standard errors cannot be meant so; empty: they can
  bool converged = true;               ///< whether the maximisation of the likelihood converged
  int low_runs = 0;                    ///< runs of the cheaper level, where there are two (surrogate/two_level.hpp)
  /// Ratio of this level's output to the cheaper level's.
  double rho = std::numeric_limits<double>::quiet_NaN(), rho_sd = std::numeric_limits<double>::quiet_NaN();
  std::vector<OutlyingRun> outlying;  ///< runs that the others contradict
  std::string outlying_together;      ///< that these lie at one end of an input, and what to try; empty: they do not
};

/// The places of a material's runs: the runs learnt from, and the runs left out.
struct DesignReport {
  std::string material;
  std::vector<std::string> inputs, units;           ///< inputs that vary
  std::vector<std::vector<double>> runs, left_out;  ///< per run its inputs, in their units
  std::vector<std::string> reasons;                 ///< reason for each run that was left out
};

}  // namespace uq
