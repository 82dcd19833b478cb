#pragma once
// A rig of the user's own: triangle meshes from STL files that rest, turn or oscillate, in a box.
//
// The spheres start at given positions, or on a cubic lattice of 1.1 diameters with a jitter of 0.04 diameters: of the
// sites in the fill region that keep clear of every mesh, the largest set of sites next to each other (so that nothing
// is put inside a shaft or a blade), filled from the bottom, the last layer thinned at random.
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "data/error.hpp"
#include "dem/mesh_check.hpp"
#include "dem/motion.hpp"
#include "dem/vec3.hpp"

namespace dem {

struct Case;
struct BuiltRig;

/// One mesh of the rig.
struct RigMesh {
  std::string name;
  TriangleMesh mesh;         ///< m, checked, one box length of it where the box is periodic
  double tolerance = 0.0;    ///< m, of its welding
  Motion motion;             ///< with its own programme, or none
  double speed_ratio = 0.0;  ///< constant speed / the rig's angular velocity, instead of a programme
};

/// Where the centres of the spheres may start.
struct FillRegion {
  enum class Shape { box, cylinder };
  Shape shape = Shape::box;
  Vec3 low, high;             ///< m, of a box
  Vec3 from, to;              ///< m, ends of a cylinder's axis
  double radius = 0.0;        ///< m
  double inner_radius = 0.0;  ///< m
};

struct StlRig {
  std::vector<RigMesh> meshes;
  std::size_t measured = 0;  ///< the mesh whose torque is the output
  Vec3 low, high;            ///< m, the box; a sphere beyond it ends the run
  std::array<bool, 3> periodic{false, false, false};
  Vec3 down{0.0, 0.0, -1.0};  ///< unit, direction of gravity
  FillRegion region;
  std::vector<Vec3> packing;          ///< m, where the spheres start; empty: the region is filled
  std::vector<Vec3> velocity;         ///< m/s, of the packing; empty: at rest
  std::vector<std::uint8_t> frozen;   ///< of the packing, 1: keeps its velocity whatever the load; empty: none
  std::vector<std::string> warnings;  ///< of the meshes' check
  std::string content;                ///< hash of meshes and packing
};

/// Edges of the box along its periodic axes [m].
std::vector<Vec3> periods(const StlRig& rig);

/// The mesh's motion at this speed of the rig [rad/s].
Motion motion_of(const RigMesh& mesh, double angular_velocity);

/// The torque is that about the measured mesh's axis: what its drive must supply, positive when the powder resists, or,
/// for a mesh that does not turn, the powder's moment on it. The flow is positive along that axis.
BuiltRig build_stl_rig(const Case& c, std::uint64_t seed);

/// What of this rig cannot be simulated, and its settings as text, one a line.
std::vector<data::Problem> stl_rig_problems(const Case& c);
std::string stl_rig_settings(const StlRig& rig);

}  // namespace dem
