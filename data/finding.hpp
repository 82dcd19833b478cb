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

struct Finding {
  std::string kind;   ///< "copied rows", "failed runs", "unit"; the same word for the same oddity
  std::string place;  ///< "runs.csv:31", or as much of it as there is
  Severity severity = Severity::warning;
  std::string what;                 ///< one sentence with its numbers
  std::string remedy;               ///< what to do about it
  std::vector<std::string> places;  ///< every row that it is about, where there are several
};

/// "PLACE: WHAT (REMEDY)".
std::string describe(const Finding& finding);

/// "runs.csv:4, 9, 12 and 7 more": rows of one or several files.
std::string list_places(const std::vector<std::string>& places, std::size_t most = 8);

bool has(const std::vector<Finding>& findings, Severity severity);

/// Throws InputError with every refusal, if there are any: 78 where all are of the kind "case" (the study contradicts
/// its data), else 65.
void refuse(const std::vector<Finding>& findings);

}  // namespace data
