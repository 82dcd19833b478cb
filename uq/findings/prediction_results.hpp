#pragma once
// A posterior's predictions, beside what was measured or simulated there.
#include <map>
#include <string>
#include <vector>

namespace uq {

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

/// The discrepancy that a case finds in one observation set, against the set's first control.
struct DiscrepancyBand {
  std::string output, unit, control, control_unit, observation_set;
  double share = 0.0;  ///< share in the spread of the data about the model, 0 to 1
  std::vector<double> x, mean, q05, q95;
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
  int unsupported = 0;   ///< points where no run speaks
  double chi2 = 0.0;     ///< chi-squared of all points together
  double p = 1.0;        ///< probability that a prediction is as far off
  bool predicts = true;  ///< p is above its threshold
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

}  // namespace uq
