#pragma once
// The outputs of a run that are means over time, as a table: what a step adds to the sample under way, and what the
// sample's mean is divided by. A new output is a row here and a member of Series (dem/run/run.hpp), which says what it
// means. torque_fluctuation is made of the torque's series (dem/run/summary.hpp). A second table has what is measured
// on the silhouette of each window.
#include <string>
#include <vector>

#include "dem/engine/simulation.hpp"
#include "dem/rig/rig.hpp"
#include "dem/run/run.hpp"

namespace dem {

/// The quantities of a run that do not change from sample to sample.
struct Sampling {
  Sensor sensor;
  std::vector<std::size_t> other_bodies;  ///< bodies whose torque is not measured
  double spheres = 0.0;
  double solid_volume = 0.0;  ///< m3
  double mass = 0.0;          ///< kg
  PicturePlane plane;
  Channels channels;
};

struct MeanOutput {
  const char* name;
  const char* unit;
  std::vector<double> Series::*series;
  double (*at_step)(const Sampling& of, const Simulation& now);  ///< the value of the step just made
  double (*divisor)(const Sampling& of);
  std::string (*lacking)(const Case& c) = nullptr;  ///< why the rig has no such output, or ""; null: every rig has it
};

/// All outputs that are means over time, torque first.
const std::vector<MeanOutput>& mean_outputs();

/// An output that is measured on the time-averaged projection of a window (dem/run/silhouette.hpp).
struct CameraOutput {
  const char* name;
  const char* unit;
  std::vector<double> Series::*series;
  double Silhouette::*value;
};
const std::vector<CameraOutput>& camera_outputs();

/// Samples in a window of RunControl::window. `time` is that of a sample [s], a whole number of steps, which
/// RunControl::sample_interval need not be.
std::size_t samples_in_window(const RunControl& run, double time);

}  // namespace dem
