#pragma once
// From numbers to a word: the verdict on one parameter. Nothing here knows what the parameter is called or is.
//
//   does not fit        the case's posterior predictive p or best-fit p is below its threshold: nothing is identified
//   identified          the profile interval is closed on both sides, and contraction is at least
//   `contraction_identified` weakly identified   closed, and contraction is at least `contraction_weak`; or an upper
//   limit: closed above, and open below
//                       only because the parameter cannot go below its physical bound 0
//   not identified      anything else; and whatever is not supported by runs, or rests on an unusable surrogate
// Reasons: structural (no better measurement of the same kind would close the interval), one-sided (open on one side at
// the end of the range), bound (open at the physical bound 0), practical (the noise), unsupported (no
// run speaks there). Borderline: a threshold lies
// within the scatter that another data set of the same kind would bring.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "uq/results.hpp"

namespace uq {

struct VerdictThresholds {
  double contraction_identified = 0.9;  ///< at least: 1 - posterior variance / prior variance
  double contraction_weak = 0.5;        ///< at least
  double profile_drop = 3.841459;       ///< deviance at the ends of a 95 % profile interval
  double predictive_p = 0.01;           ///< a case below does not fit
  double best_fit_p = 0.001;  ///< chi-squared tail of the best fit; a case below does not fit. The predictive p is
                              ///< conservative with few data, since the same data chose the parameters
  double traded_correlation = 0.8;         ///< of a pair, plain, in logarithms or as a ratio, at least
  double noise_free_factor = 1.0 / 900.0;  ///< of the measurement variance: 30 times better
  double noise_free_share = 0.5;           ///< of the interval that is left by such a measurement, at least: structural
  double surrogate_share =
      1.0 / 3.0;  ///< of the measurement's sd: a surrogate less certain than this cannot show a structural confounding
  double borderline_variance =
      0.35;  ///< |log ratio| of a residual variance to its threshold's, below which the verdict is borderline
  double borderline_deviance = 2.0;  ///< |difference| of a bound's deviance from profile_drop, likewise
};

/// Name and value of each, for the report.
std::vector<std::pair<std::string, std::string>> describe(const VerdictThresholds& thresholds);

/// What is known of one parameter; values in the study's unit.
struct ParameterEvidence {
  std::string name, unit;
  double mean = 0.0, sd = 0.0, q95 = 0.0;
  double contraction = 0.0;
  std::optional<double> profile_low, profile_high;
  double range_low = 0.0, range_high = 0.0;  ///< the support
  double deviance_at_low = 0.0, deviance_at_high = 0.0;
  bool physical_low = false;                  ///< the support's low end is a bound that nature sets (0), not the user
  std::string low_pinned_by, high_pinned_by;  ///< another parameter whose range ends an open side; may be empty
  bool structural = false;                    ///< a better measurement of the same kind would not close it
  std::string unsupported = {};  ///< why the runs cannot carry a verdict, a clause; empty: they can (uq/support.hpp)
};

/// How well the case fits.
struct FitEvidence {
  double predictive_p = 1.0, best_fit_p = 1.0;
  bool fits(const VerdictThresholds& thresholds) const {
    return predictive_p >= thresholds.predictive_p && best_fit_p >= thresholds.best_fit_p;
  }
};

struct ParameterVerdict {
  Verdict verdict = Verdict::not_identified;
  std::optional<std::string> reason;
  bool borderline = false;
  std::string sentence;
};

ParameterVerdict judge(const ParameterEvidence& parameter, const FitEvidence& fit, const VerdictThresholds& thresholds);

/// A number to the digits that its error deserves.
std::string with_error(double value, double error);

}  // namespace uq
