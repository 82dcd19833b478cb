#pragma once
// One DEM run of a point, kept in a file: finished and failed runs are read back, interrupted ones go on from their
// checkpoint.
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "campaign/point.hpp"

namespace campaign {

struct PointRun {
  std::string path;  ///< path of the run's file
  std::string from =
      {};  ///< where `path` holds no run of this course: a file whose run, of another length, this one goes on from
  int threads = 1;
  bool keep_state = true;  ///< a steady run's file holds its last state, to look at; other runs' files always do
  int frames = 0;          ///< moments kept as files for ParaView (dem/run/frame_file.hpp)
  std::string frames_folder = {};
  std::stop_token stop = {};
  std::function<void(const dem::RunProgress&)> progress = {};
};

/// The result of this run, finished or failed, when the file holds it and it ended as it would end now.
std::optional<dem::RunResult> ended_run(const Workspace& workspace, const Point& point, const std::string& path);
/// The result of a finished run of this point that the file holds, whenever the study would have it end now.
std::optional<dem::RunResult> finished_run(const Workspace& workspace, const Point& point, const std::string& path);
/// Whether the file holds this run, ended as it would end now.
bool is_done(const Workspace& workspace, const Point& point, const std::string& path);

/// The file of the folder's run*.h5 that holds the most of a run of this point's course, whenever it was to end; empty
/// where none does.
std::string longest_run(const Workspace& workspace, const Point& point, const std::string& folder);

/// How many steps of this run the file holds, ended or interrupted; 0 where it holds another run or none.
std::uint64_t steps_made(const Workspace& workspace, const Point& point, const std::string& path);

/// Makes the run, and returns the result, which the file holds too. A finished run of which the study now wants more,
/// or less, goes on from its last state or is cut short: to the same bits as a new run. A file of another point, seed
/// or setting is replaced.
/// A point whose rig cannot be simulated (a blade wider than its trough) is a failed run with the reason: the other
/// points of a campaign are made. Throws InputError (73) where the file cannot be written.
dem::RunResult run_point(const Workspace& workspace, const Point& point, const PointRun& options);

}  // namespace campaign
