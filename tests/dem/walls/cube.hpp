#pragma once
// The mesh that walls are tried on.
#include "dem/walls/mesh.hpp"

/// A unit cube's twelve triangles, outward, corners shared.
inline dem::TriangleMesh cube(double size = 1.0, dem::Vec3 at = {}) {
  dem::TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) mesh.vertices.push_back(at + size * dem::Vec3{k % 2 * 1.0, k / 2 % 2 * 1.0, k / 4 * 1.0});
  const std::uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

inline double volume(const dem::TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles)
    sum += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]])) / 6.0;
  return sum;
}
