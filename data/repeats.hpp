#pragma once
// Readings of one setting that agree far better than their standard errors say.
//
// Of n independent readings of standard error s at one setting, the squares about their mean, over s^2, have a
// chi-squared law with n - 1 degrees of freedom; over all settings these add up. A sum far below it (threshold
// `unlikely`, and less than half the scatter that the errors state) says that the readings share their error: a torque
// cell's zero of that hour, one filling of the mixer read ten times, a table and its copy with fewer digits. Counted as
// independent, n of them would lessen an error that no repetition lessens. They are therefore averaged, and the mean
// has the error of one reading.
#include <cstddef>

#include "data/study.hpp"

namespace data {

struct RepeatThresholds {
  double unlikely = 1e-4;  ///< probability of so little scatter
  double share = 0.5;      ///< scatter over that stated, at most
};

/// The agreement of readings y_i with errors s_i in groups of one mean each: what their scatter is of what they state.
class Agreement {
 public:
  /// Adds the readings of one group: squares about their mean over their squared errors, and how many are free.
  void add(double chi_squared, std::size_t degrees);
  std::size_t degrees() const { return degrees_; }
  /// Scatter over that stated; 1 where it is as stated, 0 where all agree exactly.
  double scatter() const;
  bool too_good(const RepeatThresholds& thresholds = {}) const;

 private:
  double chi_squared_ = 0.0;
  std::size_t degrees_ = 0;
};

/// Averages the readings of each setting in the outputs in which they share their error, and notes it in set.repeats.
/// Left alone are outputs whose errors a case estimates (noise), and rows without a partner. Other outputs of averaged
/// rows have the mean and error of independent readings.
void average_shared_errors(ObservationSet& set, const Study& study, const RepeatThresholds& thresholds = {});

}  // namespace data
