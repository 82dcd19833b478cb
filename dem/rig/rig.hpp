#pragma once
// A rig as a run sees it, whatever its kind: bodies, box, where the spheres start, and what is measured. The kinds are
// listed in dem/rig/rig_kind.hpp.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "data/error.hpp"
#include "dem/case/case.hpp"
#include "dem/case/grains.hpp"
#include "dem/engine/simulation.hpp"

namespace dem {

/// Axes of the picture of a camera that looks along the axis: what it calls right and up.
struct Picture {
  Vec3 origin;  ///< m, on the axis
  Vec3 right;   ///< unit, horizontal, towards the side where the measured body rises; zero where the axis is vertical
  Vec3 up;      ///< unit, against gravity
};
/// The picture along the axis of a body that turns by the right hand about the unit vector `turning` through `point`
/// [m].
Picture picture_along(Vec3 turning, Vec3 point, Vec3 down);
/// Whether a camera sees the bed so: the axis is horizontal, and the box does not repeat across it.
bool shows_bed(const Picture& picture, const std::array<bool, 3>& periodic);

/// A body whose torque is measured.
struct Driven {
  std::size_t body = 0;
  Vec3 torque_axis;  ///< torque = torque_axis . moment of the powder on the body about its motion's point
};

/// The measured quantities of the rig.
struct Sensor {
  std::vector<Driven> driven;  ///< bodies whose torques, together, are the output
  Vec3 flow_axis;              ///< axial flow = flow_axis . momentum / flow_length
  double flow_length = 1.0;    ///< m, length of the box along that axis
  double period = 0.0;         ///< s, time of a turn (turn_of)
  Picture picture;
  bool circulates = false;  ///< the flow is that of both BuiltRig::channels, and flow_length both their lengths
};

struct BuiltRig {
  Vec3 low, high;  ///< m, the box
  std::array<bool, 3> periodic{false, false, false};
  Vec3 down{0.0, 0.0, -1.0};  ///< unit, direction of gravity
  std::vector<Body> bodies;
  Grains grains;
  std::vector<Vec3> position;        ///< m, of the spheres at the start
  std::vector<Vec3> velocity;        ///< m/s, empty: at rest
  std::vector<std::uint8_t> frozen;  ///< 1: that sphere does not move; empty: none
  Channels channels;                 ///< as channels_of says
  Sensor sensor;
};

/// "slice", "machine", "drum", "stl": what rig.kind says.
const char* rig_kind(const Case& c);

/// Throws data::InputError (78) when the spheres do not fit or start outside.
BuiltRig build_rig(const Case& c, std::uint64_t seed);

/// Name and material of a body, by which pairs of materials know it.
struct BodyLabel {
  std::string name, material;
};
/// A body of the rig, whatever its mesh.
struct RigBody {
  BodyLabel label;
  Motion motion;
  bool driven = false;  ///< whether it turns at the rig's angular velocity, or in a ratio to it
};
/// The rig's bodies, in the order of BuiltRig::bodies.
std::vector<RigBody> rig_bodies(const Case& c);
/// Whether the rig's angular velocity turns any of them.
bool drives_a_body(const Case& c);
/// Indices of the bodies whose torques, together, are the output.
std::vector<std::size_t> measured_bodies(const Case& c);

/// Whether outputs can be measured on a picture of the bed.
bool has_picture(const Case& c);

/// Where the powder goes along two measured bodies side by side; of length 0 where there are not two.
Channels channels_of(const Case& c);

/// One box length of each mesh, for the user to look at.
struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};
std::vector<NamedMesh> rig_meshes(const Case& c);

/// Warnings of the meshes' check; they are the same for every run.
std::vector<std::string> rig_warnings(const Case& c);

/// Problems of the rig alone that keep it from being simulated.
std::vector<data::Problem> rig_problems(const Case& c);

/// Settings that no target names, one "name = value" a line.
std::string rig_settings(const Case& c);

/// The labels of the rig's bodies, in their order.
std::vector<BodyLabel> body_labels(const Case& c);
/// All words by which a pair of materials may name a body: names, materials and "wall".
std::vector<std::string> body_names(const Case& c);

/// The highest speed of any point of a moving body [m/s].
double tool_speed(const Case& c);

/// How high the powder would stand in the box without bodies, its spheres on a cubic lattice [m].
double fill_depth(const Case& c);

}  // namespace dem
