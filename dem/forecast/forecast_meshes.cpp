#include "dem/forecast/forecast_meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/case/grains.hpp"
#include "dem/forecast/forecast_words.hpp"
#include "dem/forecast/mesh_shape.hpp"
#include "dem/forecast/room.hpp"
#include "dem/forecast/sweep.hpp"
#include "dem/rig/packing.hpp"
#include "dem/rig/rig.hpp"
#include "dem/rig/rig_words.hpp"
#include "dem/walls/surface.hpp"

namespace dem {
namespace {

std::string motion_text(const RigMesh& m, const Motion& motion) {
  std::string text;
  if (motion.programme.size() == 1 && motion.programme[0].angular_velocity != 0.0)
    text = fmt::format("turns at {:.4g} rpm", rpm(motion.programme[0].angular_velocity));
  else if (motion.programme.size() > 1)
    text = "turns by its programme";
  if (!text.empty())
    text += fmt::format(" about ({:.3g}, {:.3g}, {:.3g}) through {}", motion.axis.x, motion.axis.y, motion.axis.z,
                        mm(motion.point));
  for (const Oscillation& o : motion.oscillations)
    text += fmt::format("{}oscillates at {:.4g} Hz", text.empty() ? "" : ", ", o.frequency);
  if (text.empty()) text = m.speed_ratio != 0.0 ? "turns" : "rests";
  return text;
}

bool is_measured(const StlRig& rig, std::size_t mesh) {
  return std::find(rig.measured.begin(), rig.measured.end(), mesh) != rig.measured.end();
}

void say_bodies(const Case& c, const BuiltRig& rig, Forecast& f) {
  const StlRig& stl = *c.rig.stl;
  bool anything = false;
  for (std::size_t k = 0; k < stl.meshes.size(); ++k) {
    const RigMesh& m = stl.meshes[k];
    const Extent e = extent_of(m.mesh);
    const Vec3 size = e.high - e.low;
    f.bodies.push_back(fmt::format("{}: {} triangles, {} x {} x {} mm, {}{}", m.name, m.mesh.triangles.size(),
                                   mm(size.x), mm(size.y), mm(size.z), motion_text(m, rig.bodies[k].motion),
                                   !is_measured(stl, k)      ? ""
                                   : stl.measured.size() > 1 ? "; its torque counts for the output"
                                                             : "; its torque is the output"));
    anything = anything || moves(rig.bodies[k].motion);
  }
  if (!anything)
    f.warnings.push_back("nothing moves in this rig: give a mesh speed_ratio, rpm, programme or oscillation");
}

std::string axis_hint(const RigMesh& m) {
  return length(m.motion.point) > 0.0
             ? fmt::format("correct axis and point of rig.mesh.{}, or the mesh", m.name)
             : fmt::format("its axis goes through the origin: give rig.mesh.{}.point, or correct the axis", m.name);
}

void check_sweeps(const Case& c, const BuiltRig& rig, Forecast& f) {
  const std::vector<RigMesh>& meshes = c.rig.stl->meshes;
  const Sweeps sweeps = follow_bodies(rig, c.run, f.largest);
  for (const Excursion& e : sweeps.excursions) {
    const Motion& motion = rig.bodies[e.body].motion;
    if (!turns(motion) || e.least > 0.9 * e.most) continue;
    f.problems.push_back({"rig.mesh." + meshes[e.body].name,
                          fmt::format("leaves the box as it turns: {:.0f} % of its surface is inside at one time, "
                                      "{:.0f} % at another",
                                      100.0 * e.most, 100.0 * e.least),
                          axis_hint(meshes[e.body]) + ", or make rig.box larger"});
  }
  const auto is_in = [](const auto& all, std::size_t one, std::size_t other) {
    return std::any_of(all.begin(), all.end(), [&](const auto& found) {
      return std::minmax(found.body, found.other) == std::minmax(one, other);
    });
  };
  for (const Cut& cut : sweeps.cuts) {
    if (is_in(sweeps.throughs, cut.body, cut.other)) continue;  // said below
    const bool first = moves(rig.bodies[cut.body].motion);
    const RigMesh &one = meshes[first ? cut.body : cut.other], &other = meshes[first ? cut.other : cut.body];
    const std::string what = fmt::format("cuts {} by {} mm at {} as it moves, {:.3g} s after the start", other.name,
                                         mm(cut.depth), mm(cut.at), cut.time);
    if (cut.joined)
      f.warnings.push_back(one.name + " " + what + "; the two meet as they start (" + axis_hint(one) + ")");
    else
      f.problems.push_back({"rig.mesh." + one.name, what, axis_hint(one)});
  }
  for (const Through& one : sweeps.throughs)
    f.warnings.push_back(fmt::format(
        "{} sticks out by {} mm through {} at {} as it turns: spheres are pinched along the wall (correct the mesh's "
        "unit or size; or {})",
        meshes[one.body].name, mm(one.by), meshes[one.other].name, mm(one.at), axis_hint(meshes[one.body])));
  for (const Gap& gap : sweeps.gaps) {
    const std::size_t one = std::min(gap.body, gap.other), other = std::max(gap.body, gap.other);
    if (!is_in(sweeps.cuts, one, other) && !is_in(sweeps.throughs, one, other))
      say_gap(f, meshes[one].name + " and " + meshes[other].name, gap.width);
  }
}

/// Whether any of the points is in or beside a wet cell.
bool reaches(const Room& room, const std::vector<std::uint8_t>& wet, const std::vector<Vec3>& points) {
  std::vector<std::uint8_t> near = wet;
  for (std::size_t k = 0; k < room.total(); ++k) {
    if (!wet[k]) continue;
    for (int side = 0; side < 6; ++side)
      if (const std::size_t other = room.beyond(k, side); other != room.total()) near[other] = 1;
  }
  return std::any_of(points.begin(), points.end(), [&](Vec3 p) {
    const std::size_t k = room.at(p);
    return k != room.total() && near[k] != 0;
  });
}

/// Whether a bed lies on or beside a body where that starts.
bool lies_at(const Room& room, const std::vector<std::uint8_t>& wet, const Body& body) {
  const double near = length(room.cell);
  const Surface surface = make_surface(body.mesh, near);
  for (std::size_t k = 0; k < room.total(); ++k)
    if (wet[k] && std::isfinite(depth_in_bodies({&body, 1}, {&surface, 1}, room.centre(k), near))) return true;
  return false;
}

/// The height [m] of a bed's lowest cell.
double bottom_of(const Room& room, const std::vector<std::uint8_t>& wet) {
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < room.total(); ++k)
    if (wet[k]) lowest = std::min(lowest, room.height(k));
  return lowest;
}

/// Whether most of three rays, about square to each other, leave the mesh: the open top of a vessel, or the open end of
/// a tube, lets one of them out.
bool within(const TriangleMesh& mesh, Vec3 p, Vec3 down) {
  const Vec3 first = unit(down + Vec3{0.0137, 0.0261, 0.0091});
  const Vec3 second = unit(cross(first, unit(Vec3{0.5377, 0.2661, 0.8000}))), third = cross(first, second);
  int inside = 0;
  for (const Vec3 way : {first, second, third}) inside += crossings(mesh, p, way, INFINITY) % 2;
  return inside >= 2;
}

/// Whether a mesh lies inside another's box: inside in two directions, and beside it along at least half of itself in
/// the third, as a shaft through a wall does.
bool lies_in(const Extent& own, const Extent& other) {
  int inside = 0;
  bool beside = true;
  for (const auto axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const double low = own.low.*axis, high = own.high.*axis, a = other.low.*axis, b = other.high.*axis;
    inside += low > a && high < b;
    beside = beside && std::min(high, b) - std::max(low, a) >= 0.5 * (high - low);
  }
  return inside >= 2 && beside;
}

/// Spheres on both sides of a mesh's surface, between which no powder can pass: those inside are in a tool's material.
/// A vessel that stands in a casing has all of them, or those above its rim can come in.
void check_inside(const Case& c, const BuiltRig& rig, const Room& room, Forecast& f) {
  const std::vector<RigMesh>& meshes = c.rig.stl->meshes;
  const std::size_t every = rig.position.size() / 40 + 1;
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    const Extent own = extent_of(meshes[k].mesh);
    if (std::none_of(meshes.begin(), meshes.end(),
                     [&](const RigMesh& other) { return lies_in(own, extent_of(other.mesh)); }))
      continue;
    std::vector<Vec3> in, out;
    for (std::size_t s = 0; s < rig.position.size(); s += every)
      (within(meshes[k].mesh, rig.position[s], rig.down) ? in : out).push_back(rig.position[s]);
    if (in.size() * 10 <= in.size() + out.size()) continue;
    if (out.empty()) {
      if (moves(rig.bodies[k].motion))
        f.warnings.push_back(fmt::format(
            "all spheres start inside the mesh {}, which lies inside another: as they should where it is the vessel "
            "(if it is a tool, give a rig.region outside it)",
            meshes[k].name));
      continue;
    }
    const std::vector<std::uint8_t> reached = reached_from(room, room.at(in.front()));
    const bool joined = std::any_of(out.begin(), out.end(), [&](Vec3 p) {
      const std::size_t cell = room.at(p);
      return cell != room.total() && reached[cell] != 0;
    });
    if (joined) continue;
    f.problems.push_back({"rig.region",
                          fmt::format("makes spheres start inside the mesh {}, which lies inside another, and others "
                                      "outside it: {} of {} looked at are inside",
                                      meshes[k].name, in.size(), in.size() + out.size()),
                          "give a region in the vessel, outside its tools"});
  }
}

/// Warns where the region reaches beyond the box, as only the part inside is filled.
void check_region(const Case& c, Forecast& f) {
  const StlRig& rig = *c.rig.stl;
  if (!rig.packing.empty()) return;
  Vec3 low = rig.region.low, high = rig.region.high;
  if (rig.region.shape == FillRegion::Shape::cylinder) {
    low = {std::min(rig.region.from.x, rig.region.to.x), std::min(rig.region.from.y, rig.region.to.y),
           std::min(rig.region.from.z, rig.region.to.z)};
    high = {std::max(rig.region.from.x, rig.region.to.x), std::max(rig.region.from.y, rig.region.to.y),
            std::max(rig.region.from.z, rig.region.to.z)};
  }
  const double slack = 1e-9 + 0.5 * f.largest;
  if (low.x < rig.low.x - slack || low.y < rig.low.y - slack || low.z < rig.low.z - slack ||
      high.x > rig.high.x + slack || high.y > rig.high.y + slack || high.z > rig.high.z + slack)
    f.warnings.push_back("rig.region reaches beyond rig.box: only the part inside is filled");
}

std::string where_filled(const BuiltRig& rig) {
  Vec3 low = rig.position.at(0), high = low;
  for (const Vec3 p : rig.position) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return fmt::format("{} to {}", mm(low), mm(high));
}

/// How many percent of the spheres have no wall under them, of 2000 looked at.
double percent_lost(const Room& room, const BuiltRig& rig) {
  const std::size_t every = rig.position.size() / 2000 + 1;
  std::size_t lost = 0, asked = 0;
  for (std::size_t k = 0; k < rig.position.size(); k += every, ++asked) lost += falls_out(room, rig.position[k]);
  return 100.0 * static_cast<double>(lost) / static_cast<double>(asked);
}

/// A bed of this volume [m3], poured where the spheres start, first where the lowest one does.
Poured pour_bed(const Room& room, const BuiltRig& rig, double volume) {
  constexpr std::size_t looked_at = 200;
  const Vec3 lowest = *std::min_element(rig.position.begin(), rig.position.end(),
                                        [&](Vec3 a, Vec3 b) { return dot(rig.down, a) > dot(rig.down, b); });
  std::vector<std::size_t> starts{room.at(lowest)};
  const std::size_t every = rig.position.size() / looked_at + 1;
  for (std::size_t k = 0; k < rig.position.size(); k += every)
    if (const std::size_t cell = room.at(rig.position[k]); cell != room.total()) starts.push_back(cell);
  return pour(room, starts, volume);
}

/// Problems of powder that does not stay in the vessel.
void check_held(const Case& c, const BuiltRig& rig, const Room& room, const Poured& bed, Forecast& f) {
  const std::string place = c.rig.stl->packing.empty() ? "rig.region" : "rig.packing";
  const std::string remedy = "give a rig.region inside the vessel, close the vessel, or correct rig.down";
  const double solids = summarise_bed(c).volume;
  if (const double lost = percent_lost(room, rig); lost > 0.0) {
    f.problems.push_back({place,
                          fmt::format("makes {:.0f} % of the spheres, which start in {}, fall out of the box: no wall "
                                      "is under them",
                                      std::max(1.0, lost), where_filled(rig)),
                          remedy});
  } else if (bed.leaves && bed.held < 0.25 * solids / packing_fraction) {
    f.problems.push_back({place,
                          fmt::format("makes spheres start in {} that nothing holds: the powder runs out of the box at "
                                      "{}",
                                      where_filled(rig), mm(bed.leaves_at)),
                          remedy});
  } else if (bed.leaves) {
    f.problems.push_back({c.rig.fill_mass ? "rig.fill_mass" : "rig.fill",
                          fmt::format("is {:.3g} times what the vessel holds: {:.3g} cm3 of bed, of which {:.3g} cm3 "
                                      "stay in and the rest runs out of the box at {}",
                                      solids / packing_fraction / bed.held, 1e6 * solids / packing_fraction,
                                      1e6 * bed.held, mm(bed.leaves_at)),
                          fmt::format("lower the fill to {:.2g} g or less, or close the vessel",
                                      1e3 * f.mass * bed.held * packing_fraction / solids)});
  }
}

/// "z", or along which direction heights are counted.
std::string upwards(Vec3 up) {
  return up.z > 0.999   ? "z"
         : up.y > 0.999 ? "y"
         : up.x > 0.999 ? "x"
                        : fmt::format("along ({:.3g}, {:.3g}, {:.3g})", up.x, up.y, up.z);
}

/// Whether the meshes that move or are measured reach a bed as loose as it may come to lie.
void check_reach(const Case& c, const BuiltRig& rig, const Room& room, Forecast& f) {
  const Poured loose = pour_bed(room, rig, summarise_bed(c).volume / loosest_bed);
  const double bottom = bottom_of(room, loose.wet);
  const std::vector<RigMesh>& meshes = c.rig.stl->meshes;
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    const bool measured = is_measured(*c.rig.stl, k);
    if (!measured && !moves(rig.bodies[k].motion)) continue;
    const std::vector<Vec3> points = swept_points(rig, k, c.run);
    double lowest_point = std::numeric_limits<double>::infinity();
    for (const Vec3 p : points) lowest_point = std::min(lowest_point, dot(-rig.down, p));
    if (reaches(room, loose.wet, points) || lies_at(room, loose.wet, rig.bodies[k])) {
      // A bed settles away from a tool that dips into it, not from what it lies on.
      if (measured && lowest_point > bottom) say_immersion(f, meshes[k].name, lowest_point);
      continue;
    }
    const std::string what =
        fmt::format("never touches the powder: it reaches down to {} mm, and the bed's surface will lie at {} mm ({})",
                    mm(lowest_point), mm(*f.surface), f.up);
    // Spheres that the user has placed may lie on a mesh; where the bed is poured, its surface is foretold.
    if (measured && c.rig.stl->packing.empty())
      f.problems.push_back({"rig.mesh." + meshes[k].name, what + ", so its torque would be 0",
                            "raise the fill, lower the mesh, fill the chamber that it is in, or measure another mesh "
                            "(rig.torque_of)"});
    else
      f.warnings.push_back(meshes[k].name + " " + what);
  }
}

/// Where the powder comes to rest, and what it touches there.
void check_powder(const Case& c, const BuiltRig& rig, const Room& room, Forecast& f) {
  const double volume = summarise_bed(c).volume / packing_fraction;
  const Poured bed = pour_bed(room, rig, volume);
  check_held(c, rig, room, bed, f);
  if (!f.problems.empty()) return;
  f.fill = volume / bed.held;
  f.surface = bed.surface;
  f.full_at = "where the vessel runs over";
  f.up = upwards(-rig.down);
  check_reach(c, rig, room, f);
}

}  // namespace

Forecast forecast_of_meshes(const Case& c, std::uint64_t seed, Forecast f) {
  const BuiltRig rig = build_rig(c, seed);
  say_bodies(c, rig, f);
  check_region(c, f);
  check_sweeps(c, rig, f);
  const Room room = make_room(rig, summarise_bed(c).smallest);
  check_inside(c, rig, room, f);
  if (f.problems.empty()) check_powder(c, rig, room, f);
  return f;
}

}  // namespace dem
