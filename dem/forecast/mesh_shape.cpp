#include "dem/forecast/mesh_shape.hpp"

#include <algorithm>

namespace dem {

Extent extent_of(const TriangleMesh& mesh) {
  Extent e{mesh.vertices.at(0), mesh.vertices.at(0)};
  for (const Vec3 v : mesh.vertices) {
    e.low = {std::min(e.low.x, v.x), std::min(e.low.y, v.y), std::min(e.low.z, v.z)};
    e.high = {std::max(e.high.x, v.x), std::max(e.high.y, v.y), std::max(e.high.z, v.z)};
  }
  return e;
}

int crossings(const TriangleMesh& mesh, Vec3 from, Vec3 way, double farthest) {
  int count = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - from, b = mesh.vertices[t[1]] - from, c = mesh.vertices[t[2]] - from;
    const double u = dot(way, cross(a, b)), v = dot(way, cross(b, c)), w = dot(way, cross(c, a));
    if (!((u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0))) continue;
    const double share = dot(a, cross(b, c)) / (u + v + w);
    count += share > 0.0 && share < farthest;
  }
  return count;
}

}  // namespace dem
