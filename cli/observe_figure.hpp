#pragma once
// The picture of a reduced torque log.
#include <string>
#include <vector>

#include "data/torque_log.hpp"
#include "uq/report/gnuplot.hpp"

namespace cli {

/// Torque and speed against time. The figure marks what is dropped of each plateau and what is used, the means with two
/// standard errors, and the idle torque that is taken off (none: 0) at each plateau.
uq::Figure log_figure(const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus,
                      const std::vector<double>& idle, const data::Unit& torque_unit, const std::string& stem);

}  // namespace cli
