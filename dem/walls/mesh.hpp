#pragma once
// Triangle meshes: vertices shared by index, welded, repeated along periodic axes.
#include <array>
#include <cstdint>
#include <vector>

#include "dem/walls/vec3.hpp"

namespace dem {

struct TriangleMesh {
  std::vector<Vec3> vertices;                           ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices, anticlockwise seen from outside
};

/// Merges vertices closer than `tolerance` [m] and drops triangles without area.
TriangleMesh weld(const TriangleMesh& mesh, double tolerance);

/// The mesh, then its copies shifted by -1, 0 and +1 of each period in all combinations, welded within `tolerance` [m]:
/// what a sphere of a periodic box meets.
TriangleMesh with_copies(const TriangleMesh& mesh, const std::vector<Vec3>& periods, double tolerance);

/// Appends one mesh to another (not welded).
void append(TriangleMesh& mesh, const TriangleMesh& other);

}  // namespace dem
