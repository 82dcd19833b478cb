#pragma once
// Programs of others, run as children without a shell: gnuplot, povray.
#include <string>
#include <vector>

namespace data {

struct ChildResult {
  int start_error = 0;  ///< errno of the start
  int exit_status = 0;  ///< of the program; 128 + signal when it was killed
  std::string out;      ///< on its standard output
  std::string err;      ///< on its standard error
};

/// Runs the program `words[0]`, looked up in PATH, with the other words as its arguments, in `folder`, and waits for it.
/// Its standard input is empty.
ChildResult run_child(const std::string& folder, const std::vector<std::string>& words);

}  // namespace data
