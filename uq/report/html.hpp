#pragma once
// report.html: one self-contained page (no script, nothing fetched) that a process engineer can read from the top:
// warnings, the verdicts at a glance, then each case with its verdict in words before its figures, then what the
// verdicts rest on: error scan, surrogates, sampler, thresholds, choices the source does not give, provenance.
#include <string>

#include "uq/findings/results.hpp"
#include "uq/report/gnuplot.hpp"

namespace uq {

struct HtmlOptions {
  GnuplotOptions gnuplot;
  std::size_t joint_figures = 6;       ///< per case, at most: pairs of parameters, traded ones first
  std::size_t rows_shown_openly = 12;  ///< a longer table of numbers behind a figure is folded away on the screen
};

/// Writes FOLDER/report.html, and FOLDER/figures/ with script, data and SVG of each figure.
/// Throws data::InputError: 69 gnuplot is missing or fails, 73 the files cannot be written.
void write_report_html(const CalibrationReport& report, const std::string& folder, const HtmlOptions& options = {});

}  // namespace uq
