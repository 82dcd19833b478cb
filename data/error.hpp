#pragma once
// The three failures: bad input throws InputError (place, value, bound, remedy); a defect is an assertion;
// non-convergence is a field of a result and never an exception.
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace data {

/// Exit statuses of the program (BSD sysexits where one fits).
enum class ExitStatus : int {
  done = 0,
  warning = 2,
  usage = 64,
  bad_data = 65,
  missing_input = 66,
  missing_program = 69,
  defect = 70,
  cannot_write = 73,
  interrupted = 75,
  bad_study = 78,
};

/// One thing wrong with the input. `place` is "file:line: key" or as much of it as there is.
struct Problem {
  std::string place;
  std::string what;    ///< the value and the bound it breaks: "friction is -1, but must lie in [0, 10]"
  std::string remedy;  ///< what to do about it
};

/// "PLACE: WHAT (REMEDY)", one line per problem.
std::string describe(const std::vector<Problem>& problems);

/// Bad input, with every problem found; the program prints them all and leaves with `status`.
class InputError : public std::runtime_error {
 public:
  InputError(ExitStatus exit_status, std::vector<Problem> found)
      : std::runtime_error(describe(found)), status(exit_status), problems(std::move(found)) {}
  InputError(ExitStatus exit_status, Problem found) : InputError(exit_status, std::vector{std::move(found)}) {}
  ExitStatus status;
  std::vector<Problem> problems;
};

/// Throws the InputError of one problem in a file of data (status 65).
[[noreturn]] inline void refuse_data(std::string place, std::string what, std::string remedy) {
  throw InputError(ExitStatus::bad_data, Problem{std::move(place), std::move(what), std::move(remedy)});
}

}  // namespace data
