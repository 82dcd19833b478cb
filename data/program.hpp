#pragma once
// Another program as a child process, without a shell: words in, and what it says out.
#include <string>
#include <vector>

#include "data/error.hpp"

namespace data {

struct ProgramCall {
  std::vector<std::string> words;         ///< its name (looked up in PATH) or path, then its arguments
  std::string folder = {};                ///< where it is started; empty: here
  std::vector<std::string> without = {};  ///< it gets no variable of the environment whose name begins so
  bool spared = false;                    ///< Ctrl-C does not reach it
};

struct ProgramEnd {
  int start_error = 0;  ///< errno of the start, or of reading what it said
  int exit_status = 0;  ///< of the program; 128 + signal when it was killed
  std::string out;      ///< on its standard output
  std::string err;      ///< on its standard error
};

/// Starts the program and waits for its end. Its standard input is empty.
ProgramEnd run_program(const ProgramCall& call);

/// What is said of a program with a start_error (69); `remedy` where it is not there.
InputError cannot_start(const std::string& program, const ProgramEnd& end, const std::string& remedy);

}  // namespace data
