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
#include <string>
#include <vector>

#include "uq/verdict/case_facts.hpp"

namespace uq {

/// The case's verdicts in one finding, what follows from it, and what to do.
struct Words {
  std::string finding, consequence;
  std::vector<std::string> remedies;  ///< sentences, the first to be done first; none where all is known
};
Words words_of(const CaseFacts& facts);

/// The remedies as they are shown; where there is none, the text that none is needed.
std::string shown_remedy(const Words& words);

}  // namespace uq
