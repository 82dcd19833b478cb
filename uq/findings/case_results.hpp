#pragma once
// Findings about a case: what holds for its parameters together, then all of it; and the case calibrated again.
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "uq/findings/kinds.hpp"
#include "uq/findings/parameter_results.hpp"
#include "uq/findings/plan_results.hpp"
#include "uq/findings/prediction_results.hpp"
#include "uq/findings/support_results.hpp"

namespace uq {

/// Parameters whose values are traded against each other: what the data know is a combination of them.
struct TradedPair {
  std::string first, second;            ///< the two of `parameters` that are traded most
  std::vector<std::string> parameters;  ///< all parameters of the combination
  std::string combination;              ///< "friction * hamaker^0.9", "a + b + c", or that the relation is curved
  CombinationForm form = CombinationForm::none;
  double value = std::numeric_limits<double>::quiet_NaN();  ///< posterior mean of the combination; NaN of a curve
  double error = std::numeric_limits<double>::quiet_NaN();  ///< posterior sd
  std::string unit;                                         ///< unit of value and error
  std::string statement;                                    ///< "a + b + c = 0.300 +- 0.006", or the combination alone
  double correlation = 0.0;
  std::vector<std::map<std::string, double>> equivalent;  ///< points along the ridge, each with every free parameter
  std::vector<std::vector<double>> equivalent_u;  ///< the same with every unknown, scaled (uq/posterior/prior.hpp's u)
  std::vector<PredictiveCurve> curves;            ///< the model's mean at each of these points; no band
};

/// A separate region of the posterior.
struct ModeReport {
  double weight = 0.0;                 ///< posterior probability
  std::map<std::string, double> mean;  ///< mean of each free parameter inside the region
  std::map<std::string, double> sd;
};

/// The case again with some free parameters held, beside the case itself.
struct ModelComparison {
  std::string held;               ///< "hamaker = 0 J"
  double log_bayes_factor = 0.0;  ///< natural log of evidence(free) / evidence(held)
  double error = 0.0;             ///< standard error, of both kinds together
  double sampling_error = 0.0;    ///< part of the error from Monte Carlo sampling
  double surrogate_error = 0.0;   ///< part of the error from the surrogate; more runs would make it smaller
  double sharper_factor = 0.0;    ///< mean of the ln Bayes factors that surrogates without error would give
  std::string sentence;           ///< the finding in words
};

/// The case again without the runs that the others contradict.
struct WithoutRuns {
  std::vector<std::string> places;
  std::vector<ParameterAgain> parameters;
  bool fits = true;
  std::string sentence;
};

struct CaseReport {
  std::string name;
  std::vector<std::string> observed_sets;  ///< names, with what the file's header says of each in observed_notes
  std::vector<std::string> observed_notes;
  double chi2 = 0.0;
  int dof = 0;
  double ppp = 0.0;  ///< posterior predictive p-value of chi2
  bool fits = true;
  bool converged = true;
  std::vector<ParameterReport> parameters;
  std::vector<std::vector<double>> correlation;
  double log_evidence = 0.0, log_evidence_error = 0.0;
  std::vector<ModelComparison> comparisons;
  int divergences = 0;
  int chains = 0, draws = 0;  ///< chains, and draws per chain
  std::optional<double>
      grid_difference;  ///< largest |mean or sd: sampler - quadrature| in posterior sd; two dimensions
  double fisher_condition = 0.0, collinearity = 0.0;
  std::vector<TradedPair> traded;
  std::vector<PredictivePoint> predictive;
  std::vector<PredictiveCurve> curves;
  std::vector<std::vector<double>> draws_for_plot;  ///< some hundred to few thousand rows, one column per parameter
  std::vector<std::string> linked;  ///< other cases sampled jointly (their data inform a shared parameter)
  std::string finding, consequence, remedy;
  std::vector<std::string> warnings;  ///< first lines of the report
  std::vector<NuisanceReport> nuisances;
  std::vector<DiscrepancyBand> discrepancies;
  std::vector<std::string> cuts;  ///< "friction from zirconia-800": taken without feedback
  std::string sampler;            ///< "mixture", "nuts", "cut"
  SupportReport support;
  std::optional<WithoutRuns> without;     ///< where runs are contradicted by the others
  std::string lone_reading;               ///< reading without which all others fit: "bench.csv:5"; empty: none
  std::string doubt;                      ///< why no verdict can rest on the surrogate; empty: it can
  bool unusable = false;                  ///< the surrogate itself is in doubt, and the values are not shown
  double surrogate_to_measurement = 0.0;  ///< sd of the surrogate over that of the measurement, median of the rows
  std::string search;                     ///< what was searched for beside the chains, and what could have escaped
  double energy_fraction = std::numeric_limits<double>::quiet_NaN();  ///< smallest of the chains (E-BFMI); NaN where
                                                                      ///< the sampler has no energy
  std::vector<ModeReport> modes;  ///< separate regions of the posterior, by falling weight; none where there is one
  std::string modes_parted_by;    ///< the measurement that would tell the modes apart
  std::vector<VerificationReport> verification;  ///< round by round, the last one decides; empty: not asked for
  std::optional<PlanReport> plan = {};           ///< what to measure next, where it was asked
  std::vector<PredictionReport> predictions;     ///< predictions of data that the case has not used
};

/// How the verdict changes when the measurement error is another one.
struct ErrorScan {
  std::string case_name;
  double relative_error = 0.0;             ///< error as a share of the measured values
  std::vector<ParameterAgain> parameters;  ///< none where the posterior could not be sampled
  double ppp = 0.0;
};

}  // namespace uq
