#include "dem/walls/surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace dem {
namespace {

// Feet this close to the border of a feature (relative to the reach asked for) belong to it.
constexpr double border = 1e-9;
// Directions closer than this to opposite are one plane or one line.
constexpr double straight = 1e-6;
// A grid of large meshes is coarser than half the reach: of no more cells than this, or than 128 along its longest
// axis. One of many features, each of which stands in all cells within its reach, has cells as wide as the reach: some
// 30 entries for each instead of 100.
constexpr double many_cells = 1 << 17;
constexpr std::size_t many_features = 50000;

Face make_face(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  Face f;
  const Vec3 v[3] = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
  f.normal = unit(cross(v[1] - v[0], v[2] - v[0]));
  f.offset = dot(f.normal, v[0]);
  for (int k = 0; k < 3; ++k) {
    f.out[k] = unit(cross(v[(k + 1) % 3] - v[k], f.normal));
    f.bound[k] = dot(f.out[k], v[k]);
  }
  return f;
}

void add_edges_and_vertices(const TriangleMesh& mesh, Surface& s) {
  struct Sides {
    std::vector<Vec3> inward;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Sides> edges;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    for (int k = 0; k < 3; ++k) edges[std::minmax(t[k], t[(k + 1) % 3])].inward.push_back(-s.faces[i].out[k]);
  }
  std::vector<std::vector<Vec3>> spokes(mesh.vertices.size());
  std::vector<char> sharp(mesh.vertices.size(), 0);
  for (const auto& [ends, sides] : edges) {
    const Vec3 a = mesh.vertices[ends.first], b = mesh.vertices[ends.second];
    const Vec3 along = unit(b - a);
    spokes[ends.first].push_back(along);
    spokes[ends.second].push_back(-along);
    const bool flat = sides.inward.size() == 2 && length(sides.inward[0] + sides.inward[1]) < straight;
    if (flat) continue;
    sharp[ends.first] = sharp[ends.second] = 1;
    s.edges.push_back({a, along, length(b - a), static_cast<std::uint32_t>(s.inward.size()),
                       static_cast<std::uint32_t>(sides.inward.size())});
    s.inward.insert(s.inward.end(), sides.inward.begin(), sides.inward.end());
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!sharp[v]) continue;
    // On a straight line of edges the foot always slides along the line: the edges see it.
    bool on_line = false;
    for (std::size_t i = 0; i < spokes[v].size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) on_line = on_line || length(spokes[v][i] + spokes[v][j]) < straight;
    }
    if (on_line) continue;
    s.vertices.push_back(
        {mesh.vertices[v], static_cast<std::uint32_t>(s.spokes.size()), static_cast<std::uint32_t>(spokes[v].size())});
    s.spokes.insert(s.spokes.end(), spokes[v].begin(), spokes[v].end());
  }
}

/// A lower bound of the distance from a point to a feature [m]; where it is beyond `enough`, any bound that is too.
double distance_at_least(const Surface& s, std::uint32_t feature, Vec3 point, double enough) {
  const std::size_t faces = s.faces.size(), edges = s.edges.size();
  if (feature < faces) {
    const Face& f = s.faces[feature];
    const double height = dot(f.normal, point) - f.offset;
    if (std::abs(height) > enough) return std::abs(height);
    double beside = 0.0;
    for (int k = 0; k < 3; ++k) beside = std::max(beside, dot(f.out[k], point) - f.bound[k]);
    return std::sqrt(height * height + beside * beside);
  }
  if (feature < faces + edges) {
    const Edge& e = s.edges[feature - faces];
    const Vec3 w = point - e.start;
    const double u = dot(w, e.direction), beyond = std::max({0.0, -u, u - e.length});
    const Vec3 across = w - u * e.direction;
    return std::sqrt(dot(across, across) + beyond * beyond);
  }
  return length(point - s.vertices[feature - faces - edges].point);
}

struct Box {
  Vec3 low, high;
};

void make_grid(const std::vector<Box>& boxes, Surface& s) {
  if (boxes.empty()) return;
  Vec3 low = boxes[0].low, high = boxes[0].high;
  for (const Box& b : boxes) {
    low = {std::min(low.x, b.low.x), std::min(low.y, b.low.y), std::min(low.z, b.low.z)};
    high = {std::max(high.x, b.high.x), std::max(high.y, b.high.y), std::max(high.z, b.high.z)};
  }
  const Vec3 size = high - low;
  s.low = low;
  s.cell =
      std::max((boxes.size() < many_features ? 0.5 : 1.0) * s.reach,
               std::min(std::max({size.x, size.y, size.z}) / 128.0, std::cbrt(size.x * size.y * size.z / many_cells)));
  for (int a = 0; a < 3; ++a) s.cells[a] = static_cast<int>((a == 0 ? size.x : a == 1 ? size.y : size.z) / s.cell) + 1;
  const auto index = [&](double x, double origin, int n) {
    return std::clamp(static_cast<int>((x - origin) / s.cell), 0, n - 1);
  };
  const double near = s.reach + 0.5 * std::sqrt(3.0) * s.cell;
  const auto each_entry = [&](auto&& visit) {  // box by box, so that features ascend in every cell
    for (std::uint32_t f = 0; f < boxes.size(); ++f) {
      const Box& b = boxes[f];
      const int x_end = index(b.high.x, low.x, s.cells[0]), y_end = index(b.high.y, low.y, s.cells[1]),
                z_end = index(b.high.z, low.z, s.cells[2]);
      for (int x = index(b.low.x, low.x, s.cells[0]); x <= x_end; ++x) {
        for (int y = index(b.low.y, low.y, s.cells[1]); y <= y_end; ++y) {
          for (int z = index(b.low.z, low.z, s.cells[2]); z <= z_end; ++z) {
            const Vec3 centre = low + Vec3{(x + 0.5) * s.cell, (y + 0.5) * s.cell, (z + 0.5) * s.cell};
            if (distance_at_least(s, f, centre, near) > near) continue;
            visit((static_cast<std::size_t>(x) * s.cells[1] + y) * s.cells[2] + z, f);
          }
        }
      }
    }
  };
  // Counted first, so that a fine mesh's entries are in memory once.
  s.first.assign(static_cast<std::size_t>(s.cells[0]) * s.cells[1] * s.cells[2] + 1, 0);
  each_entry([&](std::size_t cell, std::uint32_t) { ++s.first[cell + 1]; });
  for (std::size_t c = 1; c < s.first.size(); ++c) s.first[c] += s.first[c - 1];
  std::vector<std::uint32_t> next = s.first;
  s.features.resize(s.first.back());
  each_entry([&](std::size_t cell, std::uint32_t f) { s.features[next[cell]++] = f; });
}

}  // namespace

Surface make_surface(const TriangleMesh& mesh, double reach) {
  Surface s;
  s.reach = reach;
  for (const auto& t : mesh.triangles) s.faces.push_back(make_face(mesh, t));
  add_edges_and_vertices(mesh, s);

  std::vector<Box> boxes;
  const auto add = [&](std::initializer_list<Vec3> points) {
    Box b{*points.begin(), *points.begin()};
    for (const Vec3 p : points) {
      b.low = {std::min(b.low.x, p.x), std::min(b.low.y, p.y), std::min(b.low.z, p.z)};
      b.high = {std::max(b.high.x, p.x), std::max(b.high.y, p.y), std::max(b.high.z, p.z)};
    }
    const Vec3 grow{reach, reach, reach};
    boxes.push_back({b.low - grow, b.high + grow});
  };
  for (const auto& t : mesh.triangles) add({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
  for (const Edge& e : s.edges) add({e.start, e.start + e.length * e.direction});
  for (const Vertex& v : s.vertices) add({v.point});
  make_grid(boxes, s);
  return s;
}

void find_features(const Surface& s, Vec3 point, double distance, std::vector<NearFeature>& found) {
  found.clear();
  const Vec3 p = point - s.low;
  if (!(p.x >= 0.0 && p.y >= 0.0 && p.z >= 0.0)) return;
  const int x = static_cast<int>(p.x / s.cell), y = static_cast<int>(p.y / s.cell), z = static_cast<int>(p.z / s.cell);
  if (x >= s.cells[0] || y >= s.cells[1] || z >= s.cells[2]) return;
  const std::size_t c = (static_cast<std::size_t>(x) * s.cells[1] + y) * s.cells[2] + z;
  for (std::uint32_t i = s.first[c]; i < s.first[c + 1]; ++i) {
    const double away = distance_at_least(s, s.features[i], point, distance);
    if (away < distance) found.push_back({away, s.features[i]});
  }
  std::sort(found.begin(), found.end(), [](const NearFeature& a, const NearFeature& b) {
    return a.distance < b.distance || (a.distance == b.distance && a.feature < b.feature);
  });
}

void find_touches(const Surface& s, std::span<const std::uint32_t> features, Vec3 point, double distance,
                  Touches& found) {
  found.count = 0;
  const double tolerance = border * distance;
  const auto add = [&](Vec3 normal, double gap) {
    for (int i = 0; i < found.count; ++i) {
      Touch& t = found.touch[i];
      if (dot(t.normal, normal) > merge_cosine) {
        if (gap < t.distance) t = {normal, gap};
        return;
      }
    }
    if (found.count < max_touches) {
      found.touch[found.count++] = {normal, gap};
      return;
    }
    Touch* shallow = std::max_element(found.touch.begin(), found.touch.end(),
                                      [](const Touch& a, const Touch& b) { return a.distance < b.distance; });
    if (gap < shallow->distance) *shallow = {normal, gap};
  };

  const std::size_t faces = s.faces.size(), edges = s.edges.size();
  for (const std::uint32_t feature : features) {
    if (feature < faces) {
      const Face& f = s.faces[feature];
      const double height = dot(f.normal, point) - f.offset;
      if (!(std::abs(height) < distance)) continue;
      const double outside = std::max(
          {dot(f.out[0], point) - f.bound[0], dot(f.out[1], point) - f.bound[1], dot(f.out[2], point) - f.bound[2]});
      if (outside <= tolerance) {
        add(height > 0.0 ? f.normal : -f.normal, std::abs(height));
      }
    } else if (feature < faces + edges) {
      const Edge& e = s.edges[feature - faces];
      const Vec3 w = point - e.start;
      const double u = dot(w, e.direction);
      if (u < -tolerance || u > e.length + tolerance) continue;
      const Vec3 away = w - u * e.direction;
      const double d2 = dot(away, away);
      if (!(d2 < distance * distance) || d2 == 0.0) continue;
      bool nearest = true;
      for (std::uint32_t k = 0; k < e.inward_count; ++k)
        nearest = nearest && dot(away, s.inward[e.inward_first + k]) <= tolerance;
      if (nearest) add((1.0 / std::sqrt(d2)) * away, std::sqrt(d2));
    } else {
      const Vertex& v = s.vertices[feature - faces - edges];
      const Vec3 away = point - v.point;
      const double d2 = dot(away, away);
      if (!(d2 < distance * distance) || d2 == 0.0) continue;
      bool nearest = true;
      for (std::uint32_t k = 0; k < v.edge_count; ++k)
        nearest = nearest && dot(away, s.spokes[v.edge_first + k]) <= tolerance;
      if (nearest) add((1.0 / std::sqrt(d2)) * away, std::sqrt(d2));
    }
  }
}

}  // namespace dem
