#pragma once
// What is odd in the data, as plain data: copies, failed runs, a unit that cannot be meant. Whoever looks at rows and
// observations returns findings; the commands say them, the report shows them, and the exit status follows from the
// gravest.
#include <string>
#include <vector>

#include "data/texts.hpp"

namespace data {

enum class Severity {
  note,     ///< said, and the result stands
  warning,  ///< said in the first lines; status 2
  refusal,  ///< no result could be right; nothing is computed
};
template <>
inline constexpr std::array texts_of<Severity> = {"note", "warning", "refusal"};

/// What is odd. The same oddity has the same kind, whoever finds it.
enum class FindingKind {
  copied_rows,    ///< the same row more than once
  failed_runs,    ///< a status column or zeros say so
  rows_left_out,  ///< rows left out because the study says so
  unread_columns,
  seed_column,                ///< a column of another code's seeds
  placeholder,                ///< the template's example still stands for a measurement
  contradicted_case,          ///< the study contradicts its data
  unit,                       ///< a unit other than the stated one is suspected
  exchanged_columns,          ///< headers that stand over each other's numbers
  outside_the_range,          ///< rows outside of an input's range
  range_not_covered,          ///< a range that the runs do not cover
  inputs_that_move_together,  ///< inputs that move together in all runs
  zero_standard_error,        ///< a run with a standard error of zero
  no_logarithm,               ///< no logarithm exists of an output that is 0 or less
  no_response,                ///< an output that does not vary
  copied_observations,        ///< the same readings more than once
  counted_twice,              ///< the same readings, or nearly, in two sets of one case
  shared_errors,              ///< readings of one setting that agree too well to be independent
  standard_errors,            ///< standard errors of readings, too small or too large to be meant
  prior_not_stated,           ///< no prior is stated for a parameter whose range spans decades
  errors_apart,               ///< common errors of several sets that may be one meter's
  error_left_out,             ///< an error that a file states and the study does not
  saturated,                  ///< several rows with one extreme value
  not_measured,               ///< an output that some rows of a file lack, or all
  run_table,                  ///< a run table in the place of a measurement
};
template <>
inline constexpr std::array texts_of<FindingKind> = {"copied rows",
                                                     "failed runs",
                                                     "rows left out",
                                                     "unread columns",
                                                     "seed column",
                                                     "placeholder",
                                                     "case",
                                                     "unit",
                                                     "exchanged columns",
                                                     "outside the range",
                                                     "range not covered",
                                                     "inputs that move together",
                                                     "standard error 0",
                                                     "no logarithm",
                                                     "no response",
                                                     "copied observations",
                                                     "counted twice",
                                                     "shared errors",
                                                     "standard errors",
                                                     "prior not stated",
                                                     "errors apart",
                                                     "error left out",
                                                     "saturated",
                                                     "not measured",
                                                     "run table"};

struct Finding {
  FindingKind kind = FindingKind::unit;
  std::string place;  ///< "runs.csv:31", or as much of it as there is
  Severity severity = Severity::warning;
  std::string what;                 ///< one sentence with its numbers
  std::string remedy;               ///< what to do about it
  std::vector<std::string> places;  ///< every row that it is about, where there are several
};

/// A finding about rows, at their places. Its `what` and `remedy` are still to be filled.
Finding about_rows(FindingKind kind, Severity severity, const std::vector<std::string>& places);

/// "PLACE: WHAT (REMEDY)".
std::string describe(const Finding& finding);

/// "runs.csv:4, 9, 12 and 7 more": rows of one or several files.
std::string list_places(const std::vector<std::string>& places, std::size_t most = 8);

bool has(const std::vector<Finding>& findings, Severity severity);

/// Throws InputError with every refusal, if there are any: 78 where all say that the study
/// contradicts its data, else 65.
void refuse(const std::vector<Finding>& findings);

}  // namespace data
