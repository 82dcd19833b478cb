#pragma once
// Running another program as a child process, without a shell: words go in, and what it says comes out.
#include <string>
#include <vector>

#include "data/error.hpp"

namespace data {

struct ProgramCall {
  std::vector<std::string> words;         ///< the program's name (looked up in PATH) or path, then its arguments
  std::string folder = {};                ///< where it is started; empty: here
  std::vector<std::string> without = {};  ///< variables of the environment whose names begin so are not passed on
  bool spared = false;                    ///< Ctrl-C does not reach it
};

struct ProgramEnd {
  int start_error = 0;  ///< errno of the start, or of reading what it said
  int exit_status = 0;  ///< the program's; 128 + signal when it was killed
  std::string out;      ///< what it wrote to standard output
  std::string err;      ///< what it wrote to standard error
};

/// Starts the program and waits for its end. Its standard input is empty.
ProgramEnd run_program(const ProgramCall& call);

/// The error to throw for a program with a start_error (69); `remedy` is given where the program is not there.
InputError cannot_start(const std::string& program, const ProgramEnd& end, const std::string& remedy);

}  // namespace data
