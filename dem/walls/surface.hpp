#pragma once
// A triangle mesh as spheres meet it. A contact is a local minimum of the distance from the sphere's centre to the
// whole surface, so a face, edge or vertex is counted once however the surface is cut into triangles:
//   face    s = n.(c - v), the foot inside the triangle (closed, with a tolerance);
//   edge    the foot between the ends, and (c - foot).inward <= 0 for the in-plane inward direction of every triangle
//           at the edge: only then is the edge nearer than the faces beside it. Edges between coplanar triangles never
//           are.
//   vertex  (c - v).e <= 0 for every edge direction e that leaves it.
// Feet that two features share within rounding, and the neighbouring facets of a tessellated smooth surface, give
// normals within `merge_angle` of each other: the deepest is the contact, the others are the same one.
//
// All lengths and directions are in the body's own frame: the grid is built once, and the mesh may move rigidly.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dem/walls/mesh.hpp"

namespace dem {

struct Face {
  Vec3 normal;                        ///< unit
  double offset = 0.0;                ///< normal . vertex [m]
  Vec3 out[3];                        ///< in-plane unit normals of the edges, pointing out
  double bound[3] = {0.0, 0.0, 0.0};  ///< out . point of that edge [m]
};
struct Edge {
  Vec3 start, direction;                             ///< m, unit
  double length = 0.0;                               ///< m
  std::uint32_t inward_first = 0, inward_count = 0;  ///< into Surface::inward
};
struct Vertex {
  Vec3 point;
  std::uint32_t edge_first = 0, edge_count = 0;  ///< into Surface::spokes
};

struct Surface {
  std::vector<Face> faces;
  std::vector<Edge> edges;       ///< only those that can be met before a face
  std::vector<Vertex> vertices;  ///< only those that can be met before an edge
  std::vector<Vec3> inward;      ///< in-plane unit directions into the triangles at an edge
  std::vector<Vec3> spokes;      ///< unit directions of the edges at a vertex
  // Static grid: features whose box, grown by `reach`, meets a cell. Features are numbered faces, edges, vertices.
  double reach = 0.0;  ///< m
  double cell = 1.0;   ///< m
  Vec3 low;            ///< m
  int cells[3] = {0, 0, 0};
  std::vector<std::uint32_t> first, features;
};

/// Makes the surface of a welded mesh. `reach` [m]: the largest distance from the surface at which a sphere's centre is
/// ever asked about.
Surface make_surface(const TriangleMesh& welded, double reach);

struct NearFeature {
  double distance = 0.0;  ///< m, from the point, at least
  std::uint32_t feature = 0;
};

/// Features within `distance` <= reach of `point`, nearest first.
void find_features(const Surface& surface, Vec3 point, double distance, std::vector<NearFeature>& found);

struct Touch {
  Vec3 normal;      ///< unit, from the surface to the sphere's centre
  double distance;  ///< m, centre to foot
};
inline constexpr int max_touches = 4;  ///< contacts of one sphere with one body
struct Touches {
  int count = 0;
  std::array<Touch, max_touches> touch;  ///< the first `count`
};

/// Cosine of the angle between normals below which two feet are one contact (20 degrees: neighbouring facets, and an
/// edge of the same plane up to an overlap of 6 % of the radius).
inline constexpr double merge_cosine = 0.939692620785908;

/// Contacts of the sphere at `point` with the features listed, those nearer than `distance` [m], into `found`, whose
/// memory is used again and again.
void find_touches(const Surface& surface, std::span<const std::uint32_t> features, Vec3 point, double distance,
                  Touches& found);

}  // namespace dem
