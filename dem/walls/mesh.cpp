#include "dem/walls/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace dem {

TriangleMesh weld(const TriangleMesh& mesh, double tolerance) {
  // Vertices fall into cells far larger than the tolerance; those within it of a cell's border search both sides.
  const double size = 16.0 * tolerance;
  using Cell = std::array<long long, 3>;
  struct Hash {
    std::size_t operator()(const Cell& c) const {
      std::uint64_t h = 0;
      for (const long long x : c) h = (h ^ static_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15u + (h >> 29);
      return h;
    }
  };
  std::unordered_map<Cell, std::vector<std::uint32_t>, Hash> cells;
  TriangleMesh out;
  std::vector<std::uint32_t> index(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 p = mesh.vertices[v];
    const auto cell = [&](double x) { return static_cast<long long>(std::floor(x / size)); };
    bool found = false;
    for (long long x = cell(p.x - tolerance); x <= cell(p.x + tolerance); ++x) {
      for (long long y = cell(p.y - tolerance); y <= cell(p.y + tolerance); ++y) {
        for (long long z = cell(p.z - tolerance); z <= cell(p.z + tolerance); ++z) {
          const auto it = cells.find({x, y, z});
          if (found || it == cells.end()) continue;
          for (const std::uint32_t w : it->second) {
            if (found || length(out.vertices[w] - p) > tolerance) continue;
            index[v] = w;
            found = true;
          }
        }
      }
    }
    if (found) continue;
    index[v] = static_cast<std::uint32_t>(out.vertices.size());
    cells[{cell(p.x), cell(p.y), cell(p.z)}].push_back(index[v]);
    out.vertices.push_back(p);
  }
  for (const auto& t : mesh.triangles) {
    const std::array<std::uint32_t, 3> w{index[t[0]], index[t[1]], index[t[2]]};
    if (w[0] == w[1] || w[1] == w[2] || w[2] == w[0]) continue;
    const Vec3 a = out.vertices[w[1]] - out.vertices[w[0]], b = out.vertices[w[2]] - out.vertices[w[0]];
    if (length(cross(a, b)) <= tolerance * std::max(length(a), length(b))) continue;
    out.triangles.push_back(w);
  }
  return out;
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
}

TriangleMesh with_copies(const TriangleMesh& mesh, const std::vector<Vec3>& periods, double tolerance) {
  TriangleMesh all = mesh;
  for (const Vec3 period : periods) {
    const TriangleMesh one = all;
    for (const double sign : {-1.0, 1.0}) {
      TriangleMesh copy = one;
      for (Vec3& v : copy.vertices) v += sign * period;
      append(all, copy);
    }
  }
  return weld(all, tolerance);
}

}  // namespace dem
