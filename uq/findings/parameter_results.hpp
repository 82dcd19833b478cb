#pragma once
// Findings about one parameter, or one unknown of the measurement: its draws, its interval and its verdict.
#include <optional>
#include <string>
#include <vector>

#include "uq/findings/kinds.hpp"
#include "uq/findings/thresholds.hpp"

namespace uq {

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

/// The verdict on a parameter when the case was calibrated again.
struct ParameterAgain {
  std::string name;
  Verdict verdict = Verdict::not_identified;
  std::optional<Reason> reason;
  bool borderline = false;
  double mean = 0.0, sd = 0.0;
};

}  // namespace uq
