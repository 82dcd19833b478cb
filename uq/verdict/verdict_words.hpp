#pragma once
// The words of the report: one table of why a parameter is not known and what can be done about it.
//
//   reason        because                                                      what can be done
//   structural    other parameters do the same to all that was measured        another kind of quantity, or fix one
//   practical     the measurement's error is as large as what would tell       a smaller error, more settings
//   common error  an error that repeats share: offset, gain, setting, ...      find that error by itself
//   traded        other parameters do much the same to all that was measured   another kind of quantity, or fix one
//   surrogate     the surrogate's error is                                     training runs
//   one-sided     the data no longer change towards the range's end            wider range, other settings
//   bound         it cannot be told from its physical bound                    a smaller error lowers the limit
//   no influence  nothing that was measured depends on it                      a quantity that does, or fix it
//   range of      another parameter sits at the end of its range, and the     wider range of that one
//    another      value depends on where that is
//   unsupported   no run speaks where the posterior lies                       training runs there
//   (none) several values                                                      the measurement that parts them
//
// A case's remedy starts with that of the largest share of the widths. No remedy says what another denies: where one
// parameter needs another quantity, its partner is not told to be measured better.
#include <optional>
#include <string>
#include <vector>

#include "uq/findings/results.hpp"
#include "uq/verdict/verdict.hpp"

namespace uq {

/// Why a word other than "identified" or "several values"; nothing for these two.
std::optional<Reason> find_reason(const ParameterEvidence& parameter, Verdict verdict);

/// The clause that ends a parameter's sentence: "; the measurement's noise hides it".
std::string because(Reason reason, const ParameterEvidence& parameter);

/// What the shares of a width are, given the reason.
WidthShares find_shares(const ParameterEvidence& parameter, std::optional<Reason> reason);

/// How errors that repeated readings share are found by themselves: "calibrate the meter (the gain g)"; empty for none.
std::string remedy_of(const std::vector<CommonError>& errors);

/// The case's verdicts in one finding, what follows from it, and what to do.
struct Words {
  std::string finding, consequence;
  std::vector<std::string> remedies;  ///< sentences, the first to be done first; none where all is known
};

/// The remedies as they are shown; of none, that none is needed.
std::string shown_remedy(const Words& words);

/// What the words of a case that fits hang on.
struct CaseFacts {
  std::vector<ParameterReport> parameters;
  std::vector<TradedPair> traded;
  std::string parted_by;  ///< uq/verdict/modes.hpp; may be empty
  double collinearity = 1.0;
  bool own_engine = true;  ///< demcal makes the runs, not another code
};
Words words_of(const CaseFacts& facts);

}  // namespace uq
