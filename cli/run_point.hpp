#pragma once
// One DEM run of a point, kept in a file: finished and failed runs are read back, interrupted ones go on from their
// checkpoint.
#include <functional>
#include <stop_token>
#include <string>

#include "cli/point.hpp"

namespace cli {

struct PointRun {
  std::string path;  ///< of the run's file
  int threads = 1;
  bool keep_state = true;  ///< the finished run's file holds its last state, to look at or go on from
  std::stop_token stop = {};
  std::function<void(const dem::RunProgress&)> progress = {};
};

/// The result, which the file holds too. A file of another point, seed or setting is replaced.
dem::RunResult run_point(const Workspace& workspace, const Point& point, const PointRun& options);

}  // namespace cli
