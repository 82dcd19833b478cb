#pragma once
// One run of a case: fill, settle, turn, sample until the mean torque is known well enough.
//
// Every sample is the mean over the steps since the last one, so that nothing aliases; those of the settling are not
// kept.
//   torque              N m, what the drive must supply: minus the powder's moment on the mixer about its axis,
//                       positive when the powder resists (a rig from STL says which mesh: dem/case/stl_rig.hpp)
//   torque_fluctuation  N m, standard deviation of the torque averaged over windows of RunControl::window; its error is
//                       that of n independent windows, sd / sqrt(2 (n - 1))
//   axial_flow          kg/s, sum of m v_x over the box / its length, positive the way the helix conveys (a rig
//                       from STL: along the axis)
//   coordination        touching spheres per sphere, walls not counted
//   kinetic_energy      J, translation and rotation, of the whole box
//   normal_stress       Pa, sum over sphere contacts of normal force * distance of the centres / (3 * volume of the
//                       spheres): the mean pressure divided by the solid fraction
//   centre_x, centre_z  m, the centre of mass seen along the axis: from the axis to the side where the measured body
//                       rises, and above it. In the steady flow of a drum whose turning parts are all measured, torque
//                       = weight * centre_x. Of a vertical axis centre_x is 0; across a periodic axis they say nothing.
//   first_torque, second_torque
//                       N m, of the parts of the torque: of the machine's two mixers, of a drum's shell and its turning
//                       end plates, of an STL rig's first two measured meshes. A rig with one measured body has no
//                       second.
//   first_flow, second_flow
//                       kg/s, of two channels side by side, as of the machine: sum of m v along the channel / its
//                       length, between the openings. Both are positive where the powder goes round, out along the
//                       first and back along the second; of an STL rig, out along the first mesh's axis. The machine's
//                       axial_flow is their mean, and the powder's mass over it the time of a lap.
//   tool_contacts       contacts with the measured bodies per sphere: how much of the powder the mixer has hold of
//   tool_slip, wall_slip
//                       m/s, speed at which surfaces slip where spheres touch the measured bodies, and the others (the
//                       trough): mean over the contacts, 0 in a step without any. A rig that measures all of its
//                       bodies has no wall_slip.
//   silhouette_x, silhouette_z, silhouette_area, upper_angle, lower_angle
//                       m, m, m2, rad, rad: of the silhouette that a camera sees along the axis
//                       (dem/run/silhouette.hpp). The time-averaged projection is of RunControl::window, and each
//                       window has a value. Their mean leaves out windows in which none is found, and is itself not
//                       measured where these are more than one in twenty. A rig whose axis is vertical, or whose box
//                       repeats across its axis, has none of them.
// What of the series is measured, and when the run has been long enough, is in dem/run/looks.hpp.
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "data/time_series.hpp"
#include "dem/bed/derived.hpp"
#include "dem/case/case.hpp"
#include "dem/contact/state.hpp"
#include "dem/engine/simulation.hpp"
#include "dem/run/looks.hpp"
#include "dem/run/silhouette.hpp"

namespace dem {

struct Series {
  std::vector<double> time;             ///< s since the mixer started to turn, end of the sample
  std::vector<double> torque;           ///< N m
  std::vector<double> axial_flow;       ///< kg/s
  std::vector<double> coordination;     ///< 1
  std::vector<double> kinetic_energy;   ///< J
  std::vector<double> normal_stress;    ///< Pa
  std::vector<double> centre_x;         ///< m
  std::vector<double> centre_z;         ///< m
  std::vector<double> first_torque;     ///< N m
  std::vector<double> second_torque;    ///< N m
  std::vector<double> first_flow;       ///< kg/s
  std::vector<double> second_flow;      ///< kg/s
  std::vector<double> tool_contacts;    ///< 1
  std::vector<double> tool_slip;        ///< m/s
  std::vector<double> wall_slip;        ///< m/s
  std::vector<double> look_time;        ///< s, of the looks at the bed, each 0.05 s
  std::vector<double> bond_order;       ///< 1, dem/engine/order.hpp, at a look
  std::vector<double> mixing_index;     ///< 1, dem/run/mixing.hpp, at a look; empty without channels, as the next
  std::vector<double> channel_mass;     ///< kg, channel_places numbers a look
  std::vector<double> window_time;      ///< s, end of each window
  std::vector<double> silhouette_x;     ///< m, of a window, as all below
  std::vector<double> silhouette_z;     ///< m
  std::vector<double> silhouette_area;  ///< m2
  std::vector<double> upper_angle;      ///< rad
  std::vector<double> lower_angle;      ///< rad
};

struct Output {
  std::string name, unit;
};
/// The outputs of a run, torque first.
const std::vector<Output>& outputs();
bool has_output(std::string_view name);
const std::string& output_unit(std::string_view name);  ///< SI; of an output that there is
std::string output_names();                             ///< "torque, torque_fluctuation, ..."
/// Why the case's rig lacks an output of that name; empty where it has it.
std::string no_output_because(const Case& c, std::string_view name);

struct Diagnostics {
  Derived derived;  ///< pull-off, Bond number, time step, ...
  std::uint64_t steps = 0, rebuilds = 0;
  std::uint64_t deep_contacts = 0;  ///< contact-steps with an overlap beyond half the limit
  double max_overlap = 0.0;         ///< of a radius, while turning
  double simulated = 0.0;           ///< s of turning
  double bytes_per_particle = 0.0;  ///< of state and lists
  double steps_per_second = 0.0;    ///< particle-steps per second of processor time
  int threads = 1;
  std::string isa;  ///< of the contact forces (isa.hpp)
};

struct Summary {
  std::vector<data::SeriesMean> mean;  ///< in the order of outputs(); each with its own `reliable`
  double cpu_seconds = 0.0;
  bool reached_target = false;                         ///< the standard error of torque is the wanted one or smaller
  data::FlowState state = data::FlowState::too_short;  ///< whether the means are those of the steady flow
  std::string why;                                     ///< why it is not steady: what drifts or lacks
  double measured_from = 0.0;                          ///< s of turning, the start of what is measured
  double turns = 0.0;                                  ///< turns that were measured
  std::vector<double> drift_p;                         ///< of torque, coordination, kinetic energy (dem/run/looks.hpp)
  std::string ordering;                                ///< how the bed ordered; empty when it did not
};

/// The sums of a run since its last sample, and since its start.
struct Progressing {
  std::uint64_t steps = 0;   ///< steps in the sample under way
  std::vector<double> sums;  ///< in the order of mean_outputs() (dem/run/outputs.hpp)
  std::uint64_t deep_contacts = 0;
  double max_overlap = 0.0;
  double cpu_seconds = 0.0;
  Exposure exposure;  ///< exposure of the window under way
};

/// All that a run needs to go on as if nothing had happened, to the bit.
struct Checkpoint {
  State state;
  Series series;
  Progressing under_way;
};

enum class RunStatus { done, interrupted, failed };

struct RunResult {
  RunStatus status = RunStatus::done;
  std::string reason;  ///< reason of a failure: what, where, when
  std::vector<std::string> warnings;
  std::uint64_t seed = 0;
  Series series;
  Summary summary;
  Diagnostics diagnostics;
  Checkpoint checkpoint;  ///< the last state; the last good one where the run failed
};

struct RunProgress {
  double fraction = 0.0;   ///< share of the longest run
  double simulated = 0.0;  ///< s of turning
  double torque = 0.0;     ///< N m, mean since the start-up
  double relative_error = 1.0;
};

struct RunOptions {
  int threads = 1;
  std::stop_token stop = {};
  std::function<void(const RunProgress&)> progress = {};  ///< about every 50 ms of simulated time
  double checkpoint_interval = 60.0;                      ///< s of wall time
  std::function<void(const Checkpoint&)> checkpoint = {};
  const Checkpoint* resume = nullptr;  ///< go on from here; without a state where the series is long_enough
  /// Moments to be kept, evenly spaced from the start of turning to the earliest end of the run; `frame` is called at
  /// each with its number and the s of turning. A run that goes on from a checkpoint gives those that come after it.
  int frames = 0;
  std::function<void(int index, const Simulation& simulation, double time)> frame = {};
};

/// The steps of a run, settling included, at which its frames are taken.
std::vector<std::uint64_t> frame_steps(const PreparedCase& prepared, int frames);

/// Whether a run with this series has ended as a run of this case would now; it is then measured anew without its last
/// state.
bool long_enough(const PreparedCase& prepared, const Series& series);

/// A run that cannot go on is a result with status failed. Throws data::InputError (78) when the spheres do not fit.
RunResult run(const PreparedCase& prepared, std::uint64_t seed, const RunOptions& options = {});
/// Prepares the case first: throws data::InputError (78) with all that is wrong with it.
RunResult run(const Case& c, std::uint64_t seed, const RunOptions& options = {});

/// Mean and standard error of an output by name. Throws std::out_of_range.
const data::SeriesMean& output(const RunResult& result, std::string_view name);

}  // namespace dem
