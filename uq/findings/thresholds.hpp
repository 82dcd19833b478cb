#pragma once
// The numbers at which a verdict, its reason, its remedy or a warning of the report changes. Nothing here knows a
// parameter's name.
namespace uq {

/// Chi-squared with one degree of freedom: the deviance at the ends of a 95 % profile interval.
inline constexpr double deviance_95 = 3.841458820694124;

struct VerdictThresholds {
  double contraction_identified = 0.9;  ///< at least: 1 - posterior variance / prior variance
  double contraction_weak = 0.5;        ///< at least
  double profile_drop = deviance_95;    ///< deviance at the ends of a profile interval
  double predictive_p = 0.01;           ///< posterior predictive p of the case; a case below does not fit
  /// Chi-squared tail of the best fit; a case below does not fit. The predictive p is conservative with few data, since
  /// the same data chose the parameters.
  double best_fit_p = 0.001;
  double poor_fit_p = 0.05;  ///< the same tail; a case between both values fits, and is said to fit poorly
  /// In sds of the surrogate: a change of the prediction below this cannot be told from none.
  double told_apart_sd = 3.0;
  /// Deviance that a parameter's whole range brings about: below it the data say nothing of the parameter.
  double silent_deviance = 0.3;
  /// The factor by which the data's errors might be lowered. An effect that would be silent even then is no effect; an
  /// effect that would not be silent then is hidden by the errors.
  double errors_lowered = 30.0;
  /// Deviance at an interval's end, in profile_drops, with the parameter that stands at the end of its range held in
  /// the middle of what the data allow it: from here on most of the interval is that parameter's range.
  double pinned_drops = 2.0;
  /// In units of a value's own error. Where the value would move by as much as this if another parameter's range were
  /// longer, the value depends on that range.
  double range_shift = 0.5;
  /// Structural: the predictions along the interval stay the same to this share of what the parameter does alone, the
  /// surrogate's own error counted in.
  double same_share = 0.06;
  double structural_span = 0.5;    ///< share of the interval along which the predictions stay the same, at least
  double combination_share = 0.5;  ///< sd of a combination over that of its terms in it, at most
  double curve_share = 0.3;        ///< share of the room that independent values fill, at most: a curved relation
  double mode_weight = 0.01;       ///< posterior probability of a separate region, at least
  double prior_conflict_sd = 3.0;  ///< between the data and a stated prior; from here on they contradict each other
  double outlying_chance = 0.01;   ///< chance of a reading as far off, errors of unknown size; below, it is named
  double borderline_probability = 0.2;  ///< probability of another verdict over repeats of the data, at least
};

/// Shares of a posterior variance, and what the report says from there on.
inline constexpr double mostly_share = 0.5;   ///< a source with this share decides the width, and is improved first
inline constexpr double named_share = 0.25;   ///< the source is named beside the measurement's own error
inline constexpr double notable_share = 0.1;  ///< the source is worth a remedy
inline constexpr double whole_share = 0.995;  ///< the share's number says nothing more
/// In sds of the data's errors: where the surrogate could miss an effect of this size, it may hide an effect that the
/// data could see.
inline constexpr double hiding_sds = 2.0;
/// Posterior sds between the mean and the end of the range: from here on the prior ends the posterior, not the range.
inline constexpr double ended_by_prior_sds = 2.5;

/// Collinearity of the parameters' effects on the data, from which the effects are said to be nearly the same.
inline constexpr double collinearity_said = 10.0;
/// A run that all others contradict decides a value where, without the run, the mean moves by this many of its sds, or
/// the sd changes by this factor.
inline constexpr double decided_shift = 0.5, decided_factor = 1.5;
inline constexpr double energy_fraction_poor = 0.3;  ///< E-BFMI of the chains; below, they explore the energies slowly
inline constexpr double evidence_error_poor = 0.2;   ///< error of the log evidence, from which it is reported
inline constexpr double prior_kept = 0.99;  ///< share of a prior's mass within the range; below, the loss is reported

}  // namespace uq
