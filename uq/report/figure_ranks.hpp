#pragma once
// The figure of simulation-based calibration.
#include <string>

#include "uq/findings/rank_check.hpp"
#include "uq/report/gnuplot.hpp"

namespace uq {

/// Difference of each unknown's rank distribution from the uniform one, with its bands.
Figure rank_figure(const SimulationCalibration& found, const std::string& stem);

}  // namespace uq
