#pragma once
// The findings of a calibration as plain data: made by uq/calibrate/calibrate.cpp, kept by report_file.hpp, shown by
// uq/report. Values of parameters, controls and outputs are in the study's units (Parameter::unit and so on), not in
// SI, as findings are for the reader.
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "data/finding.hpp"
#include "uq/findings/kinds.hpp"
#include "uq/findings/thresholds.hpp"

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

/// One connected part of a parameter's 95 % profile interval, with the posterior inside it.
struct ValueRange {
  double low = 0.0, high = 0.0;               ///< the range's end where the part is open
  bool low_open = false, high_open = false;   ///< a range ends it (its own or another parameter's), not the data
  double weight = 0.0, mean = 0.0, sd = 0.0;  ///< posterior probability of the part; mean and sd within it
};

/// Values between two parts of a profile interval.
struct ProfileHole {
  double low = 0.0, high = 0.0;
  double deviance = 0.0;  ///< largest in between
  bool in_doubt = false;  ///< the surrogate cannot tell what it predicts there from what it predicts beside it
};

/// The probability that a repeated measurement gives this verdict (uq/verdict/repeats.hpp).
struct WordProbability {
  Verdict verdict = Verdict::not_identified;
  double probability = 0.0;
};

/// What a candidate measurement is expected to teach of one parameter (uq/plan).
struct PlannedParameter {
  std::string name, unit;
  double information = 0.0, information_error = 0.0;  ///< nats; the error is that of a 95 % interval
  double sd_now = 0.0, sd_after = 0.0;                ///< posterior sd, and what it is expected to be
  std::vector<WordProbability> words;                 ///< probabilities of the verdict afterwards; empty: not asked
  std::optional<int> repeats_needed;                  ///< readings for "identified" with 90 % probability
  std::optional<int> repeats_low, repeats_high;       ///< its range; no high: the probability stays near 90 %
  std::string floor;  ///< why no number of readings is enough; empty: some is, or not asked
};

/// Another level of coarse graining of a candidate's powder, and how far its output lies from the candidate's there
/// (uq/plan/levels.hpp), in errors of a reading.
struct PlanLevel {
  std::string material;
  std::optional<double> difference;  ///< none: its runs do not have the output there
  std::optional<double> doubt;       ///< the surrogates' error of the difference
  bool agrees() const { return difference && doubt && *difference * *difference + *doubt * *doubt <= 1.0; }
};

/// A measurement that could be made next.
struct PlanCandidate {
  std::string name;  ///< as the terminal shows it: "torque at 300 rpm"
  CandidateKind kind = CandidateKind::setting;
  std::string material;
  std::vector<std::string> outputs;
  std::vector<std::map<std::string, double>> settings;  ///< controls of each of its points, in their units
  double cost = 1.0;
  bool model_only = false;                            ///< the output need not mean the same in the real powder
  std::vector<PlanLevel> levels;                      ///< the powder's other levels of coarse graining
  bool assumed_error = false;                         ///< nobody stated an error of this output
  std::string error;                                  ///< "2 %"
  double information = 0.0, information_error = 0.0;  ///< about all parameters together, nats
  std::vector<PlannedParameter> parameters;
  bool teaches = true;  ///< whether it teaches about the parameter asked for
};

/// Several candidates together.
struct PlanBatch {
  std::vector<std::string> candidates;
  double information = 0.0, information_error = 0.0;  ///< about the parameter asked for, nats
  double greedy = 0.0;                                ///< information of the batch that picks one after the other
  double sd_after = 0.0;
  double cost = 0.0;
};

/// Training runs instead of a measurement.
struct PlannedRuns {
  std::vector<std::string> points;                     ///< "carrier friction 0.4, hamaker 9e-18 J, rpm 50 rpm"
  double seconds = 0.0;                                ///< of processor time, where the rows tell
  double variance_before = 0.0, variance_after = 0.0;  ///< of the posterior density, shares of its mean square
  std::vector<PlannedParameter> parameters;            ///< with an exact surrogate: the most that runs can do
};

/// How a reading changes when a parameter changes by its prior's sd, at the best fit (before any measurement: at the
/// prior's mean), in errors of one reading.
struct PlanArrow {
  std::string output, parameter;
  std::map<std::string, double> setting;
  double change = 0.0;
};

struct PlanReport {
  std::string about;      ///< parameter that the plan ranks by
  bool prior = false;     ///< made before any measurement counts
  std::string sentence;   ///< the answer
  std::string cost_unit;  ///< "" where costs are plain numbers
  std::optional<double> budget;
  std::vector<PlanCandidate> candidates;  ///< best first: information about `about` per cost
  std::vector<PlanBatch> batches;         ///< of two, three, ... candidates
  PlannedRuns runs;
  std::vector<PlanArrow> arrows;
  std::vector<std::string> notes;
};

/// An error that all readings of a case share.
struct CommonError {
  CommonErrorKind kind = CommonErrorKind::offset;
  std::string name;  ///< name of the unknown; empty where the error is integrated out
};

/// The part of a parameter's width that such common errors hold (uq/posterior/common_share.hpp).
struct CommonShare {
  double share = 0.0;               ///< of the posterior variance, 0 to 1
  std::vector<CommonError> errors;  ///< errors that hold a notable part of it
};

/// The sources of a parameter's width, as shares that sum to one.
struct WidthShares {
  double measurement = 1.0, surrogate = 0.0, structure = 0.0, range = 0.0;
};

struct ParameterReport {
  std::string name, unit;
  double prior_low = 0.0, prior_high = 0.0, prior_mean = 0.0, prior_sd = 0.0;
  double mean = 0.0, sd = 0.0, mcse = 0.0, q05 = 0.0, q50 = 0.0, q95 = 0.0;
  double map = 0.0;
  double rhat = 0.0, ess_bulk = 0.0, ess_tail = 0.0;
  double contraction = 0.0;                          ///< 1 - posterior variance / prior variance
  std::optional<double> profile_low, profile_high;   ///< 95 % profile-likelihood interval; none: open on that side
  bool low_is_bound = false, high_is_bound = false;  ///< the range ended before the likelihood fell
  std::vector<double> profile_x, profile_deviance;   ///< the profile itself: 2 (log L_max - log L)
  double profile_drop = deviance_95;                 ///< deviance at which the interval ends
  Verdict verdict = Verdict::not_identified;
  std::optional<Reason> reason;  ///< why the parameter is not known
  bool borderline = false;
  std::string sentence;                       ///< the verdict in words with its numbers
  std::vector<ValueRange> intervals;          ///< the parts of the profile interval, rising; holes in doubt are filled
  std::vector<ProfileHole> holes;             ///< holes between the parts, those in doubt too
  std::string low_pinned_by, high_pinned_by;  ///< parameter whose range ends an open side; may be empty
  std::optional<double> runs_end_low, runs_end_high;  ///< where the runs end on an open side, short of the range
  std::vector<WordProbability> word_probabilities;    ///< the largest first; none where they were not asked for
  WidthShares shares;
  CommonShare common;  ///< part of the width that is in the measurement's share, too
};

/// A summary of the draws of one unknown. In a report it is an unknown of the measurement that is sampled with the
/// parameters and integrated out.
struct NuisanceReport {
  std::string name, unit;
  double prior_mean = 0.0, prior_sd = 0.0;
  double mean = 0.0, sd = 0.0, q05 = 0.0, q50 = 0.0, q95 = 0.0;
  double rhat = 0.0, ess_bulk = 0.0, ess_tail = 0.0;
};

/// The discrepancy that a case finds in one observation set, against the set's first control.
struct DiscrepancyBand {
  std::string output, unit, control, control_unit, observation_set;
  double share = 0.0;  ///< share in the spread of the data about the model, 0 to 1
  std::vector<double> x, mean, q05, q95;
};

/// The posterior predictive of a measurement at an observed point, its error included.
struct PredictivePoint {
  std::map<std::string, double> controls;
  std::string output, unit;
  double mean = 0.0, q05 = 0.0, q95 = 0.0, observed = 0.0, standard_error = 0.0;
  std::string observation_set;  ///< set that the point belongs to
};

/// A curve of the posterior predictive of the model (without measurement error) against one control.
struct PredictiveCurve {
  std::string output, unit, control, control_unit, observation_set;
  std::vector<double> x, mean, q05, q95;
};

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

/// The runs of one input beside the posterior.
struct InputSupport {
  std::string name, unit;
  std::string material;                    ///< material whose runs these are
  double runs_low = 0.0, runs_high = 0.0;  ///< range that the runs cover
  double outside = 0.0;                    ///< share of the posterior beyond that range
  double gap = 0.0;                        ///< share of the posterior in a gap between runs
  double gap_low = 0.0, gap_high = 0.0;    ///< ends of the gap; equal: there is none
  bool operator==(const InputSupport&) const = default;
};

/// A point to run next.
struct NextRun {
  std::string material;
  std::map<std::string, double> point;  ///< every parameter and control of the study
};

/// Whether the runs speak where the posterior lies (uq/posterior/support.hpp).
struct SupportReport {
  bool known = false;                                             ///< the emulators are learnt from runs
  bool supported = true;                                          ///< the unsupported share is below its threshold
  double unsupported = 0.0;                                       ///< share of the draws
  double outside = 0.0, gap = 0.0, empty = 0.0, uncertain = 0.0;  ///< share of the draws that each test rejects
  double distance = 0.0;        ///< distance to the nearest run, in length scales; median over the draws
  double variance_ratio = 0.0;  ///< median over the draws: surrogate's variance over that without any runs
  std::vector<InputSupport> inputs;
  std::string sentence;            ///< what is not supported, and how far; empty where all is
  std::vector<NextRun> next_runs;  ///< points of the posterior far from the runs, the first the most useful
};

/// The verdict on a parameter when the case was calibrated again.
struct ParameterAgain {
  std::string name;
  Verdict verdict = Verdict::not_identified;
  std::optional<Reason> reason;
  bool borderline = false;
  double mean = 0.0, sd = 0.0;
};

/// The case again without the runs that the others contradict.
struct WithoutRuns {
  std::vector<std::string> places;
  std::vector<ParameterAgain> parameters;
  bool fits = true;
  std::string sentence;
};

/// One output of a run of the simulation at a point of the posterior, beside what the surrogate said before the run.
struct VerifiedValue {
  std::map<std::string, double> inputs;  ///< parameters and controls
  std::string material, output, unit;
  std::string label;  ///< "draw 3", "equivalent point 2"
  double predicted = 0.0, predicted_sd = 0.0;
  double simulated = 0.0, standard_error = 0.0;
  double z = 0.0;
};

/// One round of verification (uq/refine/verification.hpp).
struct VerificationReport {
  int runs = 0, points = 0;
  double chi2 = 0.0;
  int dof = 0;
  double p = 1.0, z_limit = 0.0;
  bool agrees = false;
  std::string sentence;
  std::vector<VerifiedValue> values;
};

struct PredictedPoint {
  PredictivePoint point;
  double z = 0.0;  ///< measured minus predicted, over the predictive standard deviation
};

/// Data that a case has not used, beside what it predicts of them (uq/posterior/unused_data.hpp).
struct PredictionReport {
  std::string name;
  std::vector<std::string> observed_sets;
  std::vector<PredictedPoint> points;
  int inside = 0;        ///< points inside their 90 % intervals
  double chi2 = 0.0;     ///< chi-squared of all points together
  double p = 1.0;        ///< probability that a prediction is as far off
  bool predicts = true;  ///< p is above its threshold
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

/// The places of a material's runs: the runs learnt from, and the runs left out.
struct DesignReport {
  std::string material;
  std::vector<std::string> inputs, units;           ///< inputs that vary
  std::vector<std::vector<double>> runs, left_out;  ///< per run its inputs, in their units
  std::vector<std::string> reasons;                 ///< reason for each run that was left out
};

struct CalibrationReport {
  std::string study_name, study_description, study_file;
  bool warning = false;
  std::vector<std::string> warnings;
  std::vector<SurrogateReport> surrogates;
  std::vector<DesignReport> designs;
  std::vector<CaseReport> cases;
  std::vector<ErrorScan> error_scan;
  std::vector<std::pair<std::string, std::string>> thresholds;  ///< "contraction for identified" -> "0.9"
  std::vector<std::pair<std::string, std::string>>
      provenance;                       ///< version, hashes, instruction set, seeds, table, times
  std::vector<std::string> notes;       ///< choices the source does not give, shown beside the verdicts
  std::vector<data::Finding> findings;  ///< findings about rows and observations
  std::vector<std::string> cautions;    ///< said on the first screen, without making the status a warning
};

}  // namespace uq
