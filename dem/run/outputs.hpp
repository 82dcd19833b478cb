#pragma once
// The outputs of a run that are means over time, as a table: what a step adds to the sample under way, and what the
// sample's mean is divided by. A new output is a row here and a member of Series (dem/run/run.hpp), which says what it
// means. torque_fluctuation is made of the torque's series (dem/run/summary.hpp).
#include <vector>

#include "dem/engine/simulation.hpp"
#include "dem/rig/rig.hpp"
#include "dem/run/run.hpp"

namespace dem {

/// What does not change from sample to sample.
struct Sampling {
  Sensor sensor;
  double spheres = 0.0;
  double solid_volume = 0.0;  ///< m3
  double mass = 0.0;          ///< kg
};

struct MeanOutput {
  const char* name;
  const char* unit;
  std::vector<double> Series::*series;
  double (*at_step)(const Sampling& of, const Simulation& now);  ///< of the step just made
  double (*divisor)(const Sampling& of);
};

/// Torque first.
const std::vector<MeanOutput>& mean_outputs();

}  // namespace dem
