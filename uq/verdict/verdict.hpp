#pragma once
// From numbers to a word: the verdict on one parameter. Nothing here knows what the parameter is called or is.
//
//   not identified      the runs do not support a word, the sampler has not converged, or the surrogate is unusable
//   does not fit        the case's posterior predictive p or best-fit p is below its threshold: nothing is identified
//   not identified      the parameter has no influence (influence.hpp)
//   several values      the profile interval has several parts, closed on both sides, and within the parts the
//                       contraction is at least `contraction_weak`; or parts that begin or end where the range does,
//                       with `contraction_identified`
//   identified          the profile interval is closed on both sides, and contraction is at least
//                       `contraction_identified`
//   weakly identified   closed, and contraction is at least `contraction_weak`; or an upper limit: closed above, and
//                       open below only because the parameter cannot go below its physical bound 0
//   not identified      anything else
// The reason, and what can be done about it, is in uq/verdict/reason.hpp and remedies.hpp. Borderline: over repeats of
// the data (uq/verdict/repeats.hpp) another word has a probability of at least `borderline_probability`.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "uq/findings/parameter_results.hpp"
#include "uq/findings/thresholds.hpp"

namespace uq {

/// Name and value of each threshold, for the report.
std::vector<std::pair<std::string, std::string>> describe(const VerdictThresholds& thresholds);

/// The facts that decide the word of one parameter in a case that fits.
struct WordFacts {
  bool influences = true;
  int parts = 1;  ///< parts of the profile interval
  bool open_low = false, open_high = false;
  bool physical_low = false;  ///< open below only at a bound that nature sets (0), not the user, nor another's range
  bool open_beyond = false;   ///< open for more than its own range's end: another's, the end of the runs, the surrogate
  double contraction = 0.0;
  double contraction_within = 0.0;  ///< contraction within the parts, each about its own mean
  bool closed() const { return !open_low && !open_high; }
};
Verdict word_of(const WordFacts& facts, const VerdictThresholds& thresholds);

/// The evidence about one parameter.
struct ParameterEvidence {
  ParameterReport found;  ///< what its draws and its profile say; the fields of the verdict are not filled yet
  WordFacts facts = {};
  bool structural = false;          ///< a better measurement of the same kind would not close it
  std::string unsupported = {};     ///< why the runs cannot carry a verdict, a clause; empty: they can (support.hpp)
  bool unusable = false;            ///< the runs say too little anywhere: then a misfit is the stronger finding
  std::string conditional_on = {};  ///< another parameter whose range's end decides the value; may be empty
  bool undecided = false;           ///< the surrogate is not sharp enough to tell
  bool traded = false;              ///< the parameter is known only in a combination with others
  bool unknown_beyond = false;      ///< open since the surrogate knows too little beyond an end
  bool faint = false;               ///< a part of its range is excluded, though the surrogate shows no effect of it
  bool runs_could_tell = true;      ///< an exact surrogate may leave a width that is narrow enough for a word
  double surrogate_share = 0.0;     ///< the surrogate's share of the variance, where two values are compared
  bool hidden = false;              ///< without influence only since the data's errors are large
  double silent_sds = 0.0;  ///< of the data's errors: what the surrogate's own error leaves room for, without influence
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
  std::optional<Reason> reason;
  bool borderline = false;
  std::string sentence;
  WidthShares shares;
};

/// The share of each word among those drawn, the most frequent first; words that do not come are left out.
std::vector<WordProbability> probabilities_of(const std::vector<Verdict>& drawn);

/// The verdict on one parameter. `repeats`: the words' probabilities, or none.
ParameterVerdict judge(const ParameterEvidence& evidence, const FitEvidence& fit,
                       const std::vector<WordProbability>& repeats, const VerdictThresholds& thresholds);

}  // namespace uq
