#pragma once
// Outlying runs, which the others contradict: a torque written ten times too large, a run that failed and gave half of
// it.
//
// One such run spoils a surrogate for all: it stretches the nugget or shortens the length scales until its own
// standardised leave-one-out error looks harmless (masking). The surrogate is therefore fitted again without the
// suspects:
//   1  leave-one-out errors e_i / s_i of the process fitted to the runs kept, robustly scaled:
//        z_i = (e_i / s_i - median) / max(1, 1.4826 median |e / s - median|)
//   2  the runs with |z| above `screen`, the largest first and at most a few at a time, are put aside; at the very
//      first those, too, whose output is equal to the last digit in three runs or more (failed runs, written as one
//      number), and those that may be a multiple of what the others say (scaled_runs.hpp)
//   3  fitted again, the runs put aside are predicted; those within `screen` come back
//   until nothing changes. What is still aside, and further than `outlying` from what the others predict, is outlying.
// P. J. Rousseeuw & A. M. Leroy, Robust Regression and Outlier Detection (1987), chapter 6, for deletion and masking;
// the standardised errors are those of surrogate/gaussian_process.hpp (O. Dubrule 1983).
// A run is only called outlying where the process without it is sharp (its predictive sd, nugget included, is at most a
// part of the spread of all runs), the difference is a part of that spread that could spoil a result, and the suspects
// together do harm: with them the leave-one-out errors of all other runs are larger than without. A lone run on a peak
// surprises the others, too, but helps to predict them.
//
// Runs that went wrong lie anywhere. Where a process does not bend as the model does, good runs are accused, and these
// lie together at an end of the input. Whether they do is asked by the rank-sum test of each input (F. Wilcoxon,
// Biometrics Bull. 1 (1945) 80): with R the sum of the ranks of the m accused among n runs, tied ones sharing their
// mean rank,
//   z = (R - m (n + 1) / 2) / sqrt(m (n - m) / 12 (n + 1 - sum over ties (t^3 - t) / (n (n - 1))))
// is about normal. The smallest two-sided p counts once for each input (Bonferroni).
#include <optional>
#include <vector>

#include "surrogate/fit.hpp"

namespace uq {

struct OutlierOptions {
  double screen = 3.0;     ///< robust standard deviations beyond which a run is put aside
  double outlying = 8.0;   ///< robust standard deviations from the others' prediction, beyond which it is named
  double share_max = 0.2;  ///< share of the runs that may be put aside
  double spread = 0.35;    ///< predictive sd over the sd of the runs kept, at most
  double least = 0.15;     ///< difference over the sd of the runs kept, at least: less spoils nothing
  double harm = 1.3;       ///< rms leave-one-out error of the others with the suspects over that without, at least
  int rounds = 12;
};

struct OutlyingRuns {
  std::vector<int> runs;                     ///< indices in the training set, the worst first
  std::vector<double> expected, deviations;  ///< prediction from the others (unit of y), and z
  double harm = 1.0;                         ///< number that is compared with OutlierOptions::harm
  double scatter = 1.0;                      ///< 1.4826 median |e / s| of the runs kept: below 1, errors are overstated
};

/// The finding that accused runs lie at one end of an input.
struct OneEnd {
  int input = 0;    ///< column of x
  bool low = true;  ///< at the low end, not the high one
  double p = 1.0;   ///< chance that randomly chosen runs lie so, in any of the inputs
};
inline constexpr std::size_t one_end_least = 4;  ///< least number of accused runs
inline constexpr double one_end_p = 0.01;        ///< largest p
/// The end at which accused runs lie. None for fewer runs, a larger p, or a middle run of the accused that is not in
/// the outer quarter.
std::optional<OneEnd> at_one_end(const Eigen::MatrixXd& x, const std::vector<int>& runs);

/// Finds outlying runs. It never throws for odd runs, and finds none where the process cannot be fitted without the
/// suspects.
OutlyingRuns find_outlying(const surrogate::TrainingSet& training, const surrogate::GaussianProcess& process,
                           const surrogate::FitOptions& fit, const OutlierOptions& options = {});

}  // namespace uq
