#pragma once
// The terminal's text after a calibration: the verdicts in words, and where the report is. Plain ASCII from the
// program (names and sentences are passed as they are), at most 96 columns where words allow.
#include <string>

#include "uq/findings/results.hpp"

namespace uq {

struct TerminalOptions {
  std::string report_file;  ///< named in the last line; empty: no such line
  int columns = 96;         ///< lines are folded at this many characters
};

std::string terminal_summary(const CalibrationReport& report, const TerminalOptions& options = {});

}  // namespace uq
