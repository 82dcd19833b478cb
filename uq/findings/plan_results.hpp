#pragma once
// A plan: what to measure next.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "uq/findings/kinds.hpp"
#include "uq/findings/parameter_results.hpp"

namespace uq {

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
  bool no_runs = false;                               ///< no run speaks there
  std::vector<PlanLevel> levels;                      ///< the powder's other levels of coarse graining
  bool assumed_error = false;                         ///< nobody stated an error of this output
  std::string error;                                  ///< "2 %"
  double information = 0.0, information_error = 0.0;  ///< about all parameters together, nats
  std::vector<PlannedParameter> parameters;
  bool teaches = true;  ///< whether it teaches about the parameter asked for

  /// Whether what is forecast of it need not hold, so that others come first.
  bool doubtful() const { return model_only || no_runs; }
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
  std::string about;                                               ///< parameter that the plan ranks by
  bool prior = false;                                              ///< made before any measurement counts
  std::string sentence;                                            ///< the answer
  std::string cost_unit;                                           ///< "" where costs are plain numbers
  std::vector<std::pair<std::string, std::string>> control_units;  ///< name and unit of each control
  std::optional<double> budget;
  std::vector<PlanCandidate> candidates;  ///< best first: information about `about` per cost
  std::vector<PlanBatch> batches;         ///< of two, three, ... candidates
  PlannedRuns runs;
  std::vector<PlanArrow> arrows;
  std::vector<std::string> notes;
};

}  // namespace uq
