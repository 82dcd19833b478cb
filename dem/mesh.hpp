#pragma once
// Triangle meshes: vertices shared by index, welded, repeated along periodic axes.
#include <array>
#include <cstdint>
#include <vector>

#include "dem/vec3.hpp"

namespace dem {

struct TriangleMesh {
  std::vector<Vec3> vertices;                           ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices, anticlockwise seen from outside
};

/// Merges vertices closer than `tolerance` [m] and drops triangles without area.
TriangleMesh weld(const TriangleMesh& mesh, double tolerance);

/// The mesh and its copies shifted by -period and +period, welded within `tolerance` [m]: what a sphere of a periodic
/// box meets.
TriangleMesh with_copies(const TriangleMesh& mesh, Vec3 period, double tolerance);

/// Appends one mesh to another (not welded).
void append(TriangleMesh& mesh, const TriangleMesh& other);

}  // namespace dem
