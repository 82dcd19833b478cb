#pragma once
// The facts that decide the words of a case: its parameters' findings, and the same sorted by what is said of them.
#include <string>
#include <vector>

#include "uq/findings/case_results.hpp"

namespace uq {

/// The facts of a case that fits.
struct CaseFacts {
  std::vector<ParameterReport> parameters;
  std::vector<TradedPair> traded;
  std::string parted_by;  ///< uq/verdict/modes.hpp; may be empty
  double collinearity = 1.0;
  bool own_engine = true;  ///< demcal makes the runs, not another code
};

using Names = std::vector<std::string>;

/// Parameters sorted by what is said of them.
struct SortedParameters {
  Names known, several, weak, unknown;                                               ///< by word
  Names silent, structural, practical, surrogate, traded, one_sided, bound, common;  ///< by reason
  Names beyond_runs, wanted_runs;  ///< values that go on where no run is, and the runs that would tell
  Names conditional, ends_of;      ///< values that depend on where another's range ends, and whose ranges these are
  double of_structure = 0.0, of_measurement = 0.0, of_surrogate = 0.0, of_range = 0.0, of_common = 0.0;
  double largest_surrogate = 0.0;  ///< largest share of any one parameter
  CommonShare largest_common;      ///< of a parameter that is held, at least partly, by common errors
};

SortedParameters sort_parameters(const std::vector<ParameterReport>& parameters);

/// Adds a name that is not among the others.
void add_name(Names& names, const std::string& name);

/// The form of words that goes with one name, or with several.
inline const char* one_or(const Names& names, const char* one, const char* more) {
  return names.size() == 1 ? one : more;
}

}  // namespace uq
