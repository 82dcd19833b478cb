#include "dem/walls/mesh_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "data/error.hpp"

namespace dem {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

std::array<double, 3> components(Vec3 a) { return {a.x, a.y, a.z}; }

struct Bounds {
  Vec3 low, high;
};
Bounds bounds(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  Bounds b{mesh.vertices[mesh.triangles[triangles[0]][0]], mesh.vertices[mesh.triangles[triangles[0]][0]]};
  for (const std::uint32_t t : triangles) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      const Vec3 p = mesh.vertices[v];
      b.low = {std::min(b.low.x, p.x), std::min(b.low.y, p.y), std::min(b.low.z, p.z)};
      b.high = {std::max(b.high.x, p.x), std::max(b.high.y, p.y), std::max(b.high.z, p.z)};
    }
  }
  return b;
}
bool within(const Bounds& inner, const Bounds& outer) {
  return inner.low.x > outer.low.x && inner.low.y > outer.low.y && inner.low.z > outer.low.z &&
         inner.high.x < outer.high.x && inner.high.y < outer.high.y && inner.high.z < outer.high.z;
}

double weld_tolerance(const TriangleMesh& mesh) {
  double extent = 0.0, farthest = 0.0;
  const Vec3 first = mesh.vertices.empty() ? Vec3{} : mesh.vertices[0];
  for (const Vec3 v : mesh.vertices) {
    for (const double x : components(v - first)) extent = std::max(extent, std::abs(x));
    for (const double x : components(v)) farthest = std::max(farthest, std::abs(x));
  }
  return std::max({1e-6 * extent, 4.0 * 0x1p-24 * farthest, 1e-30});
}

/// Drops all but the first of triangles with the same three corners, whichever way round.
std::size_t drop_duplicates(TriangleMesh& mesh) {
  std::set<Triangle> seen;
  return std::erase_if(mesh.triangles, [&](Triangle t) {
    std::sort(t.begin(), t.end());
    return !seen.insert(t).second;
  });
}

/// The triangles at each edge, and whether they run along it from the lower index to the higher.
struct Side {
  std::uint32_t triangle;
  bool forward;
};
using Edges = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Side>>;
Edges edges_of(const TriangleMesh& mesh) {
  Edges edges;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corner = mesh.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corner[k], b = corner[(k + 1) % 3];
      edges[std::minmax(a, b)].push_back({t, a < b});
    }
  }
  return edges;
}

/// A part of the mesh connected by edges that two triangles share.
struct Part {
  std::vector<std::uint32_t> triangles;
  std::vector<char> turned;  ///< against the first triangle's orientation
  bool closed = true;
  bool one_sided = false;  ///< has no orientation (a Moebius strip)
};
std::vector<Part> parts_of(const TriangleMesh& mesh, const Edges& edges) {
  struct Neighbour {
    std::uint32_t triangle;
    bool opposed;  ///< the two are oriented against each other
  };
  std::vector<std::vector<Neighbour>> neighbours(mesh.triangles.size());
  std::vector<char> border(mesh.triangles.size(), 0);
  for (const auto& [ends, sides] : edges) {
    if (sides.size() != 2) {
      for (const Side& s : sides) border[s.triangle] = 1;
      continue;
    }
    const bool opposed = sides[0].forward == sides[1].forward;
    neighbours[sides[0].triangle].push_back({sides[1].triangle, opposed});
    neighbours[sides[1].triangle].push_back({sides[0].triangle, opposed});
  }
  std::vector<Part> parts;
  constexpr char unknown = 2;
  std::vector<char> turned(mesh.triangles.size(), unknown);
  for (std::uint32_t seed = 0; seed < turned.size(); ++seed) {
    if (turned[seed] != unknown) continue;
    Part part;
    turned[seed] = 0;
    part.triangles.push_back(seed);
    for (std::size_t next = 0; next < part.triangles.size(); ++next) {
      const std::uint32_t t = part.triangles[next];
      part.closed = part.closed && border[t] == 0;
      for (const Neighbour& n : neighbours[t]) {
        const char wanted = n.opposed ? !turned[t] : turned[t];
        if (turned[n.triangle] == unknown) {
          turned[n.triangle] = wanted;
          part.triangles.push_back(n.triangle);
        } else if (turned[n.triangle] != wanted) {
          part.one_sided = true;
        }
      }
    }
    for (const std::uint32_t t : part.triangles) part.turned.push_back(turned[t]);
    parts.push_back(std::move(part));
  }
  return parts;
}

void turn_over(Triangle& t) { std::swap(t[1], t[2]); }

double volume(const TriangleMesh& mesh, const Part& part) {
  double sum = 0.0;
  for (const std::uint32_t t : part.triangles) {
    const Triangle& corner = mesh.triangles[t];
    sum += dot(mesh.vertices[corner[0]], cross(mesh.vertices[corner[1]], mesh.vertices[corner[2]])) / 6.0;
  }
  return sum;
}

struct Turned {
  std::size_t against_neighbours = 0;  ///< triangles
  std::size_t inside_out = 0;          ///< triangles of closed parts
  std::size_t one_sided = 0;           ///< parts
};
Turned orient(TriangleMesh& mesh, const std::vector<Part>& parts) {
  Turned result;
  std::vector<Bounds> box;
  for (const Part& part : parts) {
    box.push_back(bounds(mesh, part.triangles));
    if (part.one_sided) {
      ++result.one_sided;
      continue;
    }
    const auto against = static_cast<std::size_t>(std::count(part.turned.begin(), part.turned.end(), 1));
    const bool most = 2 * against > part.triangles.size();
    result.against_neighbours += most ? part.triangles.size() - against : against;
    for (std::size_t k = 0; k < part.triangles.size(); ++k) {
      if ((part.turned[k] != 0) != most) turn_over(mesh.triangles[part.triangles[k]]);
    }
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!parts[p].closed || parts[p].one_sided || volume(mesh, parts[p]) >= 0.0) continue;
    bool cavity = false;
    for (std::size_t q = 0; q < parts.size(); ++q) cavity = cavity || (parts[q].closed && within(box[p], box[q]));
    if (cavity) continue;
    for (const std::uint32_t t : parts[p].triangles) turn_over(mesh.triangles[t]);
    result.inside_out += parts[p].triangles.size();
  }
  return result;
}

}  // namespace

CheckedMesh check_mesh(const TriangleMesh& given, const std::string& name, const std::vector<Vec3>& periods) {
  CheckedMesh checked;
  checked.tolerance = weld_tolerance(given);
  TriangleMesh& mesh = checked.mesh;
  const auto warn = [&](std::size_t count, std::string_view what) {
    if (count > 0) checked.warnings.push_back(fmt::format("{}: {} {}", name, count, what));
  };
  mesh = weld(given, checked.tolerance);
  warn(given.triangles.size() - mesh.triangles.size(), "triangles without area, left out");
  warn(drop_duplicates(mesh), "triangles given twice, left out");
  if (mesh.triangles.empty()) {
    throw data::InputError(data::ExitStatus::bad_data,
                           data::Problem{name, "has no triangle with an area", "export the mesh again"});
  }

  const Turned turned = orient(mesh, parts_of(mesh, edges_of(mesh)));
  warn(turned.against_neighbours, "triangles oriented against their neighbours, turned");
  warn(turned.inside_out, "triangles of closed surfaces oriented inwards, turned");
  warn(turned.one_sided, "parts without an orientation (one-sided), left as they are");

  std::size_t open = 0, crowded = 0;
  for (const auto& [ends, sides] : edges_of(with_copies(mesh, periods, checked.tolerance))) {
    const bool own =
        std::any_of(sides.begin(), sides.end(), [&](const Side& s) { return s.triangle < mesh.triangles.size(); });
    open += own && sides.size() == 1;
    crowded += own && sides.size() > 2;
  }
  warn(open, "open edges, allowed: spheres meet both sides");
  warn(crowded, "edges where more than two triangles meet, allowed");
  return checked;
}

}  // namespace dem
