#include "dem/forecast/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "dem/forecast/mesh_shape.hpp"
#include "dem/walls/surface.hpp"

namespace dem {
namespace {

constexpr std::size_t most_looks = 120000;  // of points at surfaces, for each pair of bodies

/// A point of a surface, and the direction along which the surface goes on there: its normal, or the edge's own.
struct Mark {
  enum class On { face, edge, corner };
  Vec3 at;         ///< m, in the body's frame
  Vec3 direction;  ///< unit: normal of a face, direction of an edge
  On on = On::face;
  bool apart = false;  ///< on the other side of a wall than the powder
};

/// About `count` points, evenly by area, by length along sharp edges, and corners; the same at every call.
std::vector<Mark> marks_of(const TriangleMesh& mesh, std::size_t count) {
  std::vector<Mark> marks;
  const auto corner = [&](std::size_t t, int k) { return mesh.vertices[mesh.triangles[t][k]]; };
  std::vector<double> area;  // summed
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Vec3>> normals;
  double all = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 across = cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
    area.push_back(all += 0.5 * length(across));
    // Edges are left out in a finer mesh, where the points on faces are close enough.
    for (std::size_t k = 0; k < 3 && mesh.triangles.size() <= 20000; ++k)
      normals[std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3])].push_back(unit(across));
  }
  // Points inside a triangle follow the additive recurrence of the plastic number rho, (1 / rho, 1 / rho^2), which has a
  // low discrepancy: M. Roberts, "The unreasonable effectiveness of quasirandom sequences" (2018).
  constexpr double step_u = 0.7548776662466927, step_v = 0.5698402909980532;
  const std::size_t on_faces = count / 2;
  for (std::size_t k = 0, t = 0; k < on_faces; ++k) {
    const double wanted = all * (static_cast<double>(k) + 0.5) / static_cast<double>(on_faces);
    while (t + 1 < area.size() && area[t] < wanted) ++t;
    double u = std::fmod(step_u * static_cast<double>(k + 1), 1.0);
    double v = std::fmod(step_v * static_cast<double>(k + 1), 1.0);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    const Vec3 one = corner(t, 1) - corner(t, 0), other = corner(t, 2) - corner(t, 0);
    marks.push_back({corner(t, 0) + u * one + v * other, unit(cross(one, other)), Mark::On::face});
  }
  double length_of_edges = 0.0;
  std::vector<std::pair<Vec3, Vec3>> edges;
  for (const auto& [ends, sides] : normals) {
    // Facets of a rounded surface are no edge.
    if (sides.size() == 2 && dot(sides[0], sides[1]) > std::cos(std::numbers::pi / 6.0)) continue;
    edges.emplace_back(mesh.vertices[ends.first], mesh.vertices[ends.second]);
    length_of_edges += length(edges.back().second - edges.back().first);
  }
  double passed = 0.0, next = 0.0;
  const double step = length_of_edges / static_cast<double>(std::max<std::size_t>(1, count / 4));
  for (const auto& [from, to] : edges) {
    const double long_is = length(to - from);
    for (; next < passed + long_is; next += step)
      marks.push_back({from + (next - passed) / long_is * (to - from), unit(to - from), Mark::On::edge});
    passed += long_is;
  }
  const std::size_t every = mesh.vertices.size() / std::max<std::size_t>(1, count / 4) + 1;
  for (std::size_t v = 0; v < mesh.vertices.size(); v += every)
    marks.push_back({mesh.vertices[v], {}, Mark::On::corner});
  return marks;
}

Vec3 to_box(const Motion& motion, const Pose& now, Vec3 in_body) {
  return now.point + rotate(now.rotation, in_body - motion.point);
}
Vec3 to_body(const Motion& motion, const Pose& now, Vec3 in_box) {
  return motion.point + rotate_back(now.rotation, in_box - now.point);
}

double fastest_of(const Motion& motion) {
  double speed = 0.0;
  for (const SpeedPoint& p : motion.programme) speed = std::max(speed, std::abs(p.angular_velocity));
  return speed;
}

/// Over which the body does all that it does: a turn at a steady speed, else its programme, and each oscillation once.
double duration_of(const Motion& motion, const RunControl& run) {
  double time = 0.0;
  const double speed = fastest_of(motion);
  if (speed > 0.0) time = motion.programme.size() == 1 ? 2.0 * std::numbers::pi / speed : run.longest;
  for (const Oscillation& o : motion.oscillations) time = std::max(time, 1.0 / o.frequency);
  return time;
}

/// Times at which bodies are looked at, so that no point moves more than `stride` between two of them, but at most
/// 400 and at least 24.
std::vector<double> looks(double duration, double way, double stride) {
  const int count = std::clamp(static_cast<int>(std::ceil(way / stride)), 24, 400);
  std::vector<double> times;
  for (int k = 0; k <= count; ++k) times.push_back(duration * k / count);
  return times;
}

double way_of(const Body& body, double duration) {
  double way = 0.0;
  Reach reach;
  for (const Vec3 v : body.mesh.vertices) {
    reach.from_axis = std::max(reach.from_axis, length(cross(body.motion.axis, v - body.motion.point)));
    reach.from_point = std::max(reach.from_point, length(v - body.motion.point));
  }
  for (int k = 0; k < 24; ++k) way += travelled(body.motion, duration * k / 24, duration * (k + 1) / 24, reach);
  return way;
}

bool in_box(const BuiltRig& rig, Vec3 p) {
  return (rig.periodic[0] || (p.x >= rig.low.x && p.x <= rig.high.x)) &&
         (rig.periodic[1] || (p.y >= rig.low.y && p.y <= rig.high.y)) &&
         (rig.periodic[2] || (p.z >= rig.low.z && p.z <= rig.high.z));
}

/// Follows one body's points beside another body's surface.
class Follower {
 public:
  Follower(const Surface& surface, double reach) : surface_(surface), reach_(reach) {}

  /// The nearest foot within reach: distance and the direction from it to the point.
  std::optional<Touch> nearest(Vec3 p) {
    find_features(surface_, p, reach_, near_);
    features_.clear();
    for (const NearFeature& f : near_) features_.push_back(f.feature);
    find_touches(surface_, features_, p, reach_, touches_);
    std::optional<Touch> best;
    for (int k = 0; k < touches_.count; ++k)
      if (!best || touches_.touch[k].distance < best->distance) best = touches_.touch[k];
    return best;
  }

  /// How often the way between two points, shorter than twice the reach, crosses the surface.
  int crossings(Vec3 a, Vec3 b) {
    int count = 0;
    each_crossing(a, b, [&](Vec3, Vec3) { ++count; });
    return count;
  }

  /// Calls visit(place, normal of the face) for each of these crossings.
  template <class Visit>
  void each_crossing(Vec3 a, Vec3 b, Visit&& visit) {
    const double half = 0.5 * length(b - a);
    if (half == 0.0) return;
    find_features(surface_, 0.5 * (a + b), std::min(reach_, half * (1.0 + 1e-9) + 1e-12), near_);
    for (const NearFeature& n : near_) {
      if (n.feature >= surface_.faces.size()) continue;
      const Face& f = surface_.faces[n.feature];
      const double before = dot(f.normal, a) - f.offset, after = dot(f.normal, b) - f.offset;
      if ((before > 0.0) == (after > 0.0)) continue;
      const Vec3 at = a + before / (before - after) * (b - a);
      bool inside = true;
      for (int k = 0; k < 3; ++k) inside = inside && dot(f.out[k], at) < f.bound[k];
      if (inside) visit(at, f.normal);
    }
  }

 private:
  const Surface& surface_;
  double reach_;
  std::vector<NearFeature> near_;
  std::vector<std::uint32_t> features_;
  Touches touches_;
};

/// Whether the gap's direction leads across it, not along the surface.
bool faces(const Mark& mark, Vec3 in_body_direction) {
  if (mark.on == Mark::On::corner) return false;
  const double cosine = std::abs(dot(mark.direction, in_body_direction));
  return mark.on == Mark::On::face ? cosine > std::numbers::sqrt2 / 2.0 : cosine < std::numbers::sqrt2 / 2.0;
}

/// A place where an edge of one body goes through the other's surface as they start.
struct Piercing {
  Vec3 at;      ///< m, in the box
  Vec3 normal;  ///< unit, of the face that is pierced
};

/// Some of the places where edges of `one` go through `other`.
std::vector<Piercing> piercings(const Body& one, const Body& other, double reach) {
  const Surface surface = make_surface(other.mesh, reach);
  Follower follower(surface, reach);
  const Pose mine = pose(one.motion, 0.0), its = pose(other.motion, 0.0);
  std::vector<Piercing> found;
  std::size_t asked = 0;
  for (const auto& t : one.mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      if (from > to) continue;  // the neighbour's
      const Vec3 a = to_body(other.motion, its, to_box(one.motion, mine, one.mesh.vertices[from]));
      const Vec3 b = to_body(other.motion, its, to_box(one.motion, mine, one.mesh.vertices[to]));
      const int parts = static_cast<int>(length(b - a) / (1.9 * reach)) + 1;
      for (int p = 0; p < parts; ++p) {
        follower.each_crossing(a + (1.0 * p / parts) * (b - a), a + ((p + 1.0) / parts) * (b - a),
                               [&](Vec3 at, Vec3 normal) {
                                 found.push_back({to_box(other.motion, its, at), rotate(its.rotation, normal)});
                               });
        if (found.size() > 1000 || ++asked > 50000) return found;
      }
    }
  }
  return found;
}

double farthest_from_axis(const Body& body) {
  double far = 0.0;
  for (const Vec3 v : body.mesh.vertices) far = std::max(far, length(cross(body.motion.axis, v - body.motion.point)));
  return far;
}

/// How far a body that turns sticks out through a wall along its axis. A shaft goes through walls across it, and is not
/// meant.
std::optional<Through> through_side(const BuiltRig& rig, std::size_t body, std::size_t other,
                                    const std::vector<Piercing>& pierced, double tolerance) {
  const Motion& motion = rig.bodies[body].motion;
  if (!turns(motion)) return {};
  std::optional<Through> worst;
  const double far = farthest_from_axis(rig.bodies[body]);
  for (const Piercing& one : pierced) {
    if (std::abs(dot(one.normal, motion.axis)) > 0.5 || !in_box(rig, one.at)) continue;
    const double by = far - length(cross(motion.axis, one.at - motion.point));
    if (by > tolerance && (!worst || by > worst->by)) worst = Through{body, other, by, one.at};
  }
  return worst;
}

/// Marks the points that a wall parts from the powder, of which `powder` [m] is a place.
void part_from_powder(std::vector<Mark>& marks, const Body& mine, const Body& wall, Vec3 powder) {
  const Pose here = pose(mine.motion, 0.0), its = pose(wall.motion, 0.0);
  const Vec3 to = to_body(wall.motion, its, powder);
  for (Mark& mark : marks) {
    const Vec3 from = to_body(wall.motion, its, to_box(mine.motion, here, mark.at));
    mark.apart = crossings(wall.mesh, from, to - from, 1.0) % 2 == 1;
  }
}

struct Pairing {
  std::size_t body, other;
  std::vector<double> times;
  double reach, tolerance, touching;  ///< m
};

/// Follows the points of `body` in the frame of `other`.
void follow(const BuiltRig& rig, const Pairing& of, const std::vector<Mark>& marks, Sweeps& found) {
  const Body &mine = rig.bodies[of.body], &its = rig.bodies[of.other];
  const Surface surface = make_surface(its.mesh, of.reach);
  Follower follower(surface, of.reach);
  std::vector<Pose> my_pose, its_pose;
  for (const double t : of.times) my_pose.push_back(pose(mine.motion, t)), its_pose.push_back(pose(its.motion, t));
  std::optional<Cut> cut;
  std::optional<Gap> gap;
  for (const Mark& mark : marks) {
    double deepest[2] = {0.0, 0.0};  // on either side
    int side = 0;
    std::optional<Vec3> clear;  // where it last was off the surface: on it, rounding decides the side
    for (std::size_t k = 0; k < of.times.size(); ++k) {
      const Vec3 here = to_box(mine.motion, my_pose[k], mark.at);
      const Vec3 p = to_body(its.motion, its_pose[k], here);
      const std::optional<Touch> nearest = follower.nearest(p);
      const double away = nearest ? nearest->distance : of.reach;
      if (!(away > of.touching)) continue;
      if (clear && length(p - *clear) < 2.0 * of.reach && follower.crossings(*clear, p) % 2 == 1) side = 1 - side;
      clear = p;
      deepest[side] = std::max(deepest[side], away);
      const double depth = std::min(deepest[0], deepest[1]);
      if (depth > of.tolerance && (!cut || depth > cut->depth) && in_box(rig, here))
        cut = Cut{of.body, of.other, depth, of.times[k], here};
      if (mark.apart || !nearest || side == 1 || (gap && away >= gap->width) || !in_box(rig, here)) continue;
      const Vec3 across = rotate_back(my_pose[k].rotation, rotate(its_pose[k].rotation, nearest->normal));
      if (faces(mark, across)) gap = Gap{of.body, of.other, away, here};
    }
  }
  if (cut) found.cuts.push_back(*cut);
  if (gap) found.gaps.push_back(*gap);
}

/// Keeps the worse of two findings about a pair of bodies.
template <class Found, class Worse>
void keep_worst(std::vector<Found>& all, std::size_t from, Worse worse) {
  while (all.size() > from + 1) {
    if (worse(all[from + 1], all[from])) all[from] = all[from + 1];
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(from) + 1);
  }
}

/// Whether two bodies move as one.
bool move_together(const Body& a, const Body& b, double duration) {
  for (const double share : {0.1, 0.37, 0.73}) {
    const Pose one = pose(a.motion, share * duration), other = pose(b.motion, share * duration);
    for (const Vec3 v :
         {a.mesh.vertices.front(), a.mesh.vertices.back(), a.mesh.vertices[a.mesh.vertices.size() / 2]}) {
      const Vec3 moved =
          to_box(a.motion, one, v) -
          to_box(b.motion, other, to_body(b.motion, pose(b.motion, 0.0), to_box(a.motion, pose(a.motion, 0.0), v)));
      if (length(moved) > 1e-9 * (1.0 + length(v))) return false;
    }
  }
  return true;
}

}  // namespace

Sweeps follow_bodies(const BuiltRig& rig, const RunControl& run, double largest) {
  Sweeps found;
  const std::size_t bodies = rig.bodies.size();
  for (std::size_t a = 0; a < bodies; ++a) {
    const Body& one = rig.bodies[a];
    if (moves(one.motion)) {
      const double duration = duration_of(one.motion, run);
      const std::vector<Mark> marks = marks_of(one.mesh, 800);
      Excursion e{a, 0.0, 1.0};
      for (const double t : looks(duration, way_of(one, duration), largest)) {
        const Pose now = pose(one.motion, t);
        double inside = 0.0, all = 0.0;
        for (const Mark& m : marks) {
          if (m.on != Mark::On::face) continue;
          all += 1.0;
          inside += in_box(rig, to_box(one.motion, now, m.at));
        }
        e.most = std::max(e.most, inside / all);
        e.least = std::min(e.least, inside / all);
      }
      found.excursions.push_back(e);
    }
    for (std::size_t b = a + 1; b < bodies; ++b) {
      const Body& other = rig.bodies[b];
      if (!moves(one.motion) && !moves(other.motion)) continue;
      // Two that turn at speeds of their own meet in many ways: three turns of the slower.
      const double times = moves(one.motion) && moves(other.motion) ? 3.0 : 1.0;
      double duration = times * std::max(duration_of(one.motion, run), duration_of(other.motion, run));
      // No fewer than 36 looks at a turn of the faster.
      if (const double fastest = std::max(fastest_of(one.motion), fastest_of(other.motion)); fastest > 0.0)
        duration = std::min(duration, 11.0 * 2.0 * std::numbers::pi / fastest);
      if (move_together(one, other, duration)) continue;
      const double way = way_of(one, duration) + way_of(other, duration);
      const double stride = std::max(largest, way / 400.0);
      const std::vector<double> at = looks(duration, way, stride);
      const std::size_t points = std::clamp<std::size_t>(most_looks / at.size(), 200, 1500);
      const std::size_t cuts = found.cuts.size(), gaps = found.gaps.size();
      const Pairing pair{a, b, at, 2.0 * stride, 0.25 * largest, 0.02 * largest};
      const std::vector<Piercing> by_one = piercings(one, other, pair.reach),
                                  by_other = piercings(other, one, pair.reach);
      const bool joined = !by_one.empty() || !by_other.empty();
      for (const auto& through :
           {through_side(rig, a, b, by_one, pair.tolerance), through_side(rig, b, a, by_other, pair.tolerance)})
        if (through) found.throughs.push_back(*through);
      std::vector<Mark> marks = marks_of(one.mesh, points), others = marks_of(other.mesh, points);
      if (joined && !rig.position.empty()) {
        // What the smaller one has outside the larger one's wall is in no powder, and the gap there is none.
        const bool first = extent_of(one.mesh).volume() < extent_of(other.mesh).volume();
        part_from_powder(first ? marks : others, first ? one : other, first ? other : one, rig.position.front());
        for (Mark& mark : first ? others : marks) mark.apart = true;
      }
      follow(rig, pair, marks, found);
      follow(rig, {b, a, at, pair.reach, pair.tolerance, pair.touching}, others, found);
      keep_worst(found.cuts, cuts, [](const Cut& x, const Cut& y) { return x.depth > y.depth; });
      if (found.cuts.size() > cuts) found.cuts[cuts].joined = joined;
      keep_worst(found.gaps, gaps, [](const Gap& x, const Gap& y) { return x.width < y.width; });
    }
  }
  return found;
}

std::vector<Vec3> swept_points(const BuiltRig& rig, std::size_t body, const RunControl& run) {
  const Body& one = rig.bodies[body];
  const double duration = duration_of(one.motion, run);
  std::vector<Vec3> points;
  const std::vector<Mark> marks = marks_of(one.mesh, 3000);
  for (const double t : moves(one.motion) ? looks(duration, 0.0, 1.0) : std::vector<double>{0.0}) {
    const Pose now = pose(one.motion, t);
    for (const Mark& m : marks) points.push_back(to_box(one.motion, now, m.at));
  }
  return points;
}

}  // namespace dem
