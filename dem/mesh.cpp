#include "dem/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <tuple>

#include "data/error.hpp"

namespace dem {

TriangleMesh weld(const TriangleMesh& mesh, double tolerance) {
  // Vertices fall into cells of the tolerance; the 27 cells around are searched, so no pair within it is missed.
  using Cell = std::tuple<long long, long long, long long>;
  std::map<Cell, std::vector<std::uint32_t>> cells;
  TriangleMesh out;
  std::vector<std::uint32_t> index(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 p = mesh.vertices[v];
    const auto cell = [&](double x) { return static_cast<long long>(std::floor(x / tolerance)); };
    const long long cx = cell(p.x), cy = cell(p.y), cz = cell(p.z);
    bool found = false;
    for (long long k = 0; k < 27 && !found; ++k) {
      const auto it = cells.find({cx + k % 3 - 1, cy + k / 3 % 3 - 1, cz + k / 9 - 1});
      if (it == cells.end()) continue;
      for (const std::uint32_t w : it->second) {
        if (length(out.vertices[w] - p) <= tolerance) {
          index[v] = w;
          found = true;
          break;
        }
      }
    }
    if (found) continue;
    index[v] = static_cast<std::uint32_t>(out.vertices.size());
    cells[{cx, cy, cz}].push_back(index[v]);
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

TriangleMesh with_copies(const TriangleMesh& mesh, Vec3 period) {
  TriangleMesh all = mesh;
  for (const double sign : {-1.0, 1.0}) {
    TriangleMesh copy = mesh;
    for (Vec3& v : copy.vertices) v += sign * period;
    append(all, copy);
  }
  return weld(all, 1e-9 * length(period));
}

void write_stl(const TriangleMesh& mesh, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  std::array<char, 80> header{};
  std::strncpy(header.data(), "demcal, metres", header.size() - 1);
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  file.write(header.data(), header.size());
  file.write(reinterpret_cast<const char*>(&count), sizeof count);
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    std::array<float, 12> row{};
    std::size_t k = 0;
    for (const Vec3 v : {unit(cross(b - a, c - a)), a, b, c}) {
      for (const double x : {v.x, v.y, v.z}) row[k++] = static_cast<float>(x);
    }
    const std::uint16_t attribute = 0;
    file.write(reinterpret_cast<const char*>(row.data()), sizeof row);
    file.write(reinterpret_cast<const char*>(&attribute), sizeof attribute);
  }
  file.close();
  if (!file) {
    throw data::InputError(data::ExitStatus::cannot_write,
                           data::Problem{path, "cannot be written", "check the folder and the space left"});
  }
}

}  // namespace dem
