#pragma once
// A rig as a run sees it, whatever its kind: bodies, box, where the spheres start, and what is measured. Kinds: the
// auger slice (dem/slice.hpp) and meshes from STL (dem/stl_rig.hpp).
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "data/error.hpp"
#include "dem/case.hpp"
#include "dem/simulation.hpp"

namespace dem {

/// What is measured.
struct Sensor {
  std::size_t body = 0;      ///< whose torque is the output
  Vec3 torque_axis;          ///< torque = torque_axis . moment of the powder on that body
  Vec3 flow_axis;            ///< axial flow = flow_axis . momentum / flow_length
  double flow_length = 1.0;  ///< m, of the box along that axis
  double period = 0.0;       ///< s of a turn of that body, 0 when it does not move
};

struct BuiltRig {
  Vec3 low, high;  ///< m, the box
  std::array<bool, 3> periodic{false, false, false};
  Vec3 down{0.0, 0.0, -1.0};  ///< unit, direction of gravity
  std::vector<Body> bodies;
  std::vector<Vec3> position;        ///< m, of the spheres at the start
  std::vector<Vec3> velocity;        ///< m/s, empty: at rest
  std::vector<std::uint8_t> frozen;  ///< 1: that sphere does not move; empty: none
  Sensor sensor;
};

/// Throws data::InputError (78) when the spheres do not fit or start outside.
BuiltRig build_rig(const Case& c, std::uint64_t seed);

/// One box length of each mesh, for the user to look at.
struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};
std::vector<NamedMesh> rig_meshes(const Case& c);

/// Of the meshes' check; the same for every run.
std::vector<std::string> rig_warnings(const Case& c);

/// The whole case; the bodies rest for `rest_steps`.
Setup make_setup(const Case& c, BuiltRig rig, std::uint64_t rest_steps, int threads);

/// What of the rig alone cannot be simulated.
std::vector<data::Problem> rig_problems(const Case& c);

/// Settings that no target names, one "name = value" a line.
std::string rig_settings(const Case& c);

/// Whether this rig has the quantity: the slice's dimensions mean nothing to another rig.
bool rig_has(const Case& c, std::string_view target_name);

/// How high the powder would stand in a box filled without gaps [m].
double fill_depth(const Case& c);

}  // namespace dem
