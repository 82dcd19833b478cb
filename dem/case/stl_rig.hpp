#pragma once
// A rig of the user's own: triangle meshes from STL files that rest, turn or oscillate, in a box.
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dem/walls/mesh_check.hpp"
#include "dem/walls/motion.hpp"
#include "dem/walls/vec3.hpp"

namespace dem {

/// One mesh of the rig.
struct RigMesh {
  std::string name;
  std::string material = "wall";  ///< the name by which [[contact.pair]] knows it
  TriangleMesh mesh;              ///< m, checked; one box length of the mesh where the box is periodic
  double tolerance = 0.0;         ///< m, tolerance of the mesh's welding
  Motion motion;                  ///< with a programme of its own, or none; a mesh at rest has the axis of its torque
  double speed_ratio = 0.0;       ///< constant speed / the rig's angular velocity, instead of a programme
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
  std::vector<std::size_t> measured{0};  ///< the meshes whose torques, together, are the output
  Vec3 low, high;                        ///< m, the box; a sphere beyond it ends the run
  std::array<bool, 3> periodic{false, false, false};
  Vec3 down{0.0, 0.0, -1.0};  ///< unit, direction of gravity
  FillRegion region;
  std::vector<Vec3> packing;          ///< m, where the spheres start; empty: the region is filled
  std::vector<int> packing_line;      ///< line of each sphere of the packing in its file
  std::vector<Vec3> velocity;         ///< m/s, of the packing's spheres; empty: at rest
  std::vector<std::uint8_t> frozen;   ///< per sphere packed, 1: keeps its velocity whatever the load; empty: none
  std::vector<std::string> warnings;  ///< warnings of the meshes' check
  std::string content;                ///< hash of meshes and packing
  std::vector<double> diameter;       ///< m, of the packing's spheres, largest first, of one size in the order of the
                                      ///< mixture's components; empty: all are the bed's one size
};

/// Edges of the box along its periodic axes [m].
std::vector<Vec3> periods(const StlRig& rig);

/// Whether two motions have their axes, which may point either way, on one line to within `tolerance` [m].
bool same_line(const Motion& one, const Motion& other, double tolerance);

/// The mesh's motion at this speed of the rig [rad/s].
Motion motion_of(const RigMesh& mesh, double angular_velocity);

/// An upper bound of the speed [m/s] of any point of the meshes, at this speed of the rig [rad/s].
double mesh_speed(const StlRig& rig, double angular_velocity);

}  // namespace dem
