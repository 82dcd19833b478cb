#include "dem/run/outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace dem {
namespace {

double one(const Sampling&) { return 1.0; }
double mass(const Sampling& of) { return of.mass; }

/// The torque of the k-th measured body; NaN where there are fewer.
double torque_of(std::size_t k, const Sampling& of, const Simulation& now) {
  if (k >= of.sensor.driven.size()) return std::numeric_limits<double>::quiet_NaN();
  const Driven& d = of.sensor.driven[k];
  return dot(d.torque_axis, now.sums().body[d.body].torque);
}

/// Contacts of the spheres with some bodies in a step, and the sum of the speeds at which they slip [m/s].
struct OnBodies {
  double contacts = 0.0, slip = 0.0;

  void add(const BodyLoad& load) {
    contacts += static_cast<double>(load.contacts);
    slip += load.slip;
  }
  double mean_slip() const { return contacts > 0.0 ? slip / contacts : 0.0; }
};
OnBodies on_measured(const Sampling& of, const Simulation& now) {
  OnBodies sum;
  for (const Driven& d : of.sensor.driven) sum.add(now.sums().body[d.body]);
  return sum;
}
OnBodies on_others(const Sampling& of, const Simulation& now) {
  OnBodies sum;
  for (const std::size_t body : of.other_bodies) sum.add(now.sums().body[body]);
  return sum;
}

std::string no_other_bodies(const Case& c) {
  return measured_bodies(c).size() == rig_bodies(c).size()
             ? "is that of the bodies whose torque is not measured, and this rig measures all of its bodies"
             : "";
}

/// Momentum along the channels, of one of them [kg m/s]; not a number where there are none.
double flow_of(std::size_t channel, const Sampling& of, const Simulation& now) {
  return of.channels.exist() ? now.carried().flow[channel] : std::numeric_limits<double>::quiet_NaN();
}

double length_of_flow(const Sampling& of) { return of.channels.flow_to - of.channels.flow_from; }

std::string no_second_torque(const Case& c) {
  return measured_bodies(c).size() < 2
             ? "is that of a second body, and this rig measures one: name two meshes in rig.torque_of"
             : "";
}

std::string no_channels(const Case& c) {
  return channels_of(c).exist() ? "" : "is that of a channel, and this rig has no two bodies that turn side by side";
}

/// Why nothing is measured on the silhouette of this rig's bed, or "".
std::string no_silhouette(const Case& c) {
  if (channels_of(c).exist())
    return "is measured on the picture along one axis, and the bodies of this rig turn about two";
  return has_picture(c) ? ""
                        : "is measured on the picture along a horizontal axis, but this rig's axis is vertical, or its "
                          "box repeats across it";
}

/// Mass times the distance of its centre from the axis along a direction of the picture [kg m].
double moment(const Sampling& of, const Simulation& now, Vec3 direction) {
  return dot(direction, now.carried().moment) - of.mass * dot(direction, of.sensor.picture.origin);
}

}  // namespace

const std::vector<MeanOutput>& mean_outputs() {
  static const std::vector<MeanOutput> all{
      {"torque", "N m", &Series::torque,
       [](const Sampling& of, const Simulation& now) {
         double sum = 0.0;
         for (std::size_t k = 0; k < of.sensor.driven.size(); ++k) sum += torque_of(k, of, now);
         return sum;
       },
       one},
      {"axial_flow", "kg/s", &Series::axial_flow,
       [](const Sampling& of, const Simulation& now) {
         const Carried& carried = now.carried();
         return of.sensor.circulates ? carried.flow[0] - carried.flow[1] : dot(of.sensor.flow_axis, carried.momentum);
       },
       [](const Sampling& of) { return of.sensor.flow_length; }},
      {"coordination", "1", &Series::coordination,
       [](const Sampling&, const Simulation& now) { return static_cast<double>(now.sums().contacts); },
       [](const Sampling& of) { return 0.5 * of.spheres; }},  // a contact has two spheres
      {"kinetic_energy", "J", &Series::kinetic_energy,
       [](const Sampling&, const Simulation& now) { return now.carried().kinetic_energy; }, one},
      {"normal_stress", "Pa", &Series::normal_stress,
       [](const Sampling&, const Simulation& now) { return now.sums().virial; },
       [](const Sampling& of) { return 3.0 * of.solid_volume; }},
      {"centre_x", "m", &Series::centre_x,
       [](const Sampling& of, const Simulation& now) { return moment(of, now, of.sensor.picture.right); }, mass},
      {"centre_z", "m", &Series::centre_z,
       [](const Sampling& of, const Simulation& now) { return moment(of, now, of.sensor.picture.up); }, mass},
      {"first_torque", "N m", &Series::first_torque,
       [](const Sampling& of, const Simulation& now) { return torque_of(0, of, now); }, one},
      {"second_torque", "N m", &Series::second_torque,
       [](const Sampling& of, const Simulation& now) { return torque_of(1, of, now); }, one, no_second_torque},
      {"first_flow", "kg/s", &Series::first_flow,
       [](const Sampling& of, const Simulation& now) { return flow_of(0, of, now); }, length_of_flow, no_channels},
      {"second_flow", "kg/s", &Series::second_flow,
       [](const Sampling& of, const Simulation& now) { return -flow_of(1, of, now); }, length_of_flow, no_channels},
      {"tool_contacts", "1", &Series::tool_contacts,
       [](const Sampling& of, const Simulation& now) { return on_measured(of, now).contacts; },
       [](const Sampling& of) { return of.spheres; }},
      {"tool_slip", "m/s", &Series::tool_slip,
       [](const Sampling& of, const Simulation& now) { return on_measured(of, now).mean_slip(); }, one},
      {"wall_slip", "m/s", &Series::wall_slip,
       [](const Sampling& of, const Simulation& now) {
         return of.other_bodies.empty() ? std::numeric_limits<double>::quiet_NaN() : on_others(of, now).mean_slip();
       },
       one, no_other_bodies},
  };
  return all;
}

const std::vector<CameraOutput>& camera_outputs() {
  static const std::vector<CameraOutput> all{
      {"silhouette_x", "m", &Series::silhouette_x, &Silhouette::x},
      {"silhouette_z", "m", &Series::silhouette_z, &Silhouette::z},
      {"silhouette_area", "m2", &Series::silhouette_area, &Silhouette::area},
      {"upper_angle", "rad", &Series::upper_angle, &Silhouette::upper_angle},
      {"lower_angle", "rad", &Series::lower_angle, &Silhouette::lower_angle},
  };
  return all;
}

std::size_t samples_in_window(const RunControl& run, double time) {
  return static_cast<std::size_t>(std::max(1.0, std::round(run.window / time)));
}

const std::vector<Output>& outputs() {
  static const std::vector<Output> all = [] {
    std::vector<Output> made;
    for (const MeanOutput& o : mean_outputs()) {
      made.push_back({o.name, o.unit});
      if (made.size() == 1) made.push_back({"torque_fluctuation", o.unit});
    }
    for (const CameraOutput& o : camera_outputs()) made.push_back({o.name, o.unit});
    return made;
  }();
  return all;
}

bool has_output(std::string_view name) {
  return std::any_of(outputs().begin(), outputs().end(), [&](const Output& o) { return o.name == name; });
}

const std::string& output_unit(std::string_view name) {
  return std::find_if(outputs().begin(), outputs().end(), [&](const Output& o) { return o.name == name; })->unit;
}

std::string no_output_because(const Case& c, std::string_view name) {
  for (const MeanOutput& o : mean_outputs())
    if (o.name == name) return o.lacking != nullptr ? o.lacking(c) : "";
  for (const CameraOutput& o : camera_outputs())
    if (o.name == name) return no_silhouette(c);
  return "";
}

std::string output_names() {
  std::string text;
  for (const Output& o : outputs()) text += (text.empty() ? "" : ", ") + o.name;
  return text;
}

const data::SeriesMean& output(const RunResult& result, std::string_view name) {
  for (std::size_t k = 0; k < outputs().size(); ++k) {
    if (outputs()[k].name == name) return result.summary.mean.at(k);
  }
  throw std::out_of_range(fmt::format("no output named {}", name));
}

}  // namespace dem
