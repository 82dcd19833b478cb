#pragma once
// Questions about a mesh as a whole: the box that it fills, and which of two places it lies between.
#include "dem/walls/mesh.hpp"

namespace dem {

struct Extent {
  Vec3 low, high;  ///< m

  double volume() const { return (high.x - low.x) * (high.y - low.y) * (high.z - low.z); }  ///< m3
};
Extent extent_of(const TriangleMesh& mesh);

/// How often the way from a point goes through the mesh, up to `farthest` times `way` [m]: an odd number of a ray from
/// inside a closed mesh, and between two places on different sides of a wall.
int crossings(const TriangleMesh& mesh, Vec3 from, Vec3 way, double farthest);

}  // namespace dem
