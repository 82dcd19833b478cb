// A rig of meshes from STL files, as a run sees it (dem/case/stl_rig.hpp).
//
// The spheres start at given positions, or on a cubic lattice of 1.1 diameters with a jitter of 0.04 diameters: of the
// sites in the fill region that keep clear of every mesh, the largest set of sites next to each other (so that nothing
// is put inside a shaft or a blade), filled from the bottom, the last layer thinned at random. Where these sites are
// too few, the spheres grow to a dense bed (dem/rig/grow.hpp).
//
// The torque is that about the measured mesh's axis: what its drive must supply, positive when the powder resists, or,
// for a mesh that does not turn, the powder's moment on it. The flow is positive along that axis.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/rig/check_packing.hpp"
#include "dem/rig/drive.hpp"
#include "dem/rig/grow.hpp"
#include "dem/rig/packing.hpp"
#include "dem/rig/read_stl_rig.hpp"
#include "dem/rig/rig_kind.hpp"

namespace dem {
namespace {

std::array<double, 3> components(Vec3 a) { return {a.x, a.y, a.z}; }
constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};
std::string text(Vec3 a) { return fmt::format("({:.17g}, {:.17g}, {:.17g})", a.x, a.y, a.z); }

[[noreturn]] void fail(std::string place, std::string what, std::string remedy) {
  throw data::InputError(data::ExitStatus::bad_study, {std::move(place), std::move(what), std::move(remedy)});
}

/// The extent [m] of a box of these edges along an axis.
double extent_along(Vec3 axis, Vec3 size) {
  return std::abs(axis.x) * size.x + std::abs(axis.y) * size.y + std::abs(axis.z) * size.z;
}

/// The offset [m] from one axis to another, across them; both axes are parallel.
Vec3 offset_between(const Motion& first, const Motion& second) {
  const Vec3 apart = second.point - first.point;
  return apart - dot(apart, first.axis) * first.axis;
}

bool parallel(Vec3 a, Vec3 b) { return length(cross(a, b)) < 1e-6; }

std::vector<RigBody> bodies(const Case& c) {
  std::vector<RigBody> all;
  for (const RigMesh& m : c.rig.stl->meshes)
    all.push_back({{m.name, m.material}, motion_of(m, c.rig.angular_velocity), m.speed_ratio != 0.0});
  return all;
}

/// The measured meshes; a rig without meshes has none.
std::vector<std::size_t> measured(const Case& c) {
  return c.rig.stl->meshes.empty() ? std::vector<std::size_t>{} : c.rig.stl->measured;
}

/// How the k-th measured mesh moves.
Motion measured_motion(const Case& c, std::size_t k) {
  const StlRig& rig = *c.rig.stl;
  return motion_of(rig.meshes[rig.measured[k]], c.rig.angular_velocity);
}

/// Whether all measured meshes turn about the same line.
bool one_axis(const Case& c) {
  const StlRig& rig = *c.rig.stl;
  const Motion first = measured_motion(c, 0);
  for (std::size_t k = 1; k < rig.measured.size(); ++k) {
    if (!same_line(first, measured_motion(c, k), 1e-6 * length(rig.high - rig.low))) return false;
  }
  return true;
}

/// The channels of two measured meshes that turn about parallel axes. They meet halfway between the axes, and are as
/// long as the box.
Channels channels(const Case& c) {
  const StlRig& rig = *c.rig.stl;
  if (rig.measured.size() != 2 || one_axis(c)) return {};
  const Motion first = measured_motion(c, 0), second = measured_motion(c, 1);
  if (!parallel(first.axis, second.axis)) return {};
  const Vec3 apart = offset_between(first, second), middle = 0.5 * (rig.low + rig.high);
  const double half = 0.5 * extent_along(first.axis, rig.high - rig.low);
  Channels found{.along = first.axis, .across = unit(apart)};
  found.middle = dot(found.across, first.point) + 0.5 * length(apart);
  found.from = found.flow_from = dot(middle, first.axis) - half;
  found.to = found.flow_to = dot(middle, first.axis) + half;
  return found;
}

bool shows_picture(const Case& c) {
  const StlRig& rig = *c.rig.stl;
  if (rig.meshes.empty()) return true;
  const Motion motion = measured_motion(c, 0);
  return shows_bed(picture_along(motion.axis, motion.point, rig.down), rig.periodic);
}

void fill(const Case& c, std::uint64_t seed, BuiltRig& built) {
  const StlRig& rig = *c.rig.stl;
  const BedSummary bed = summarise_bed(c);
  built.grains = draw_grains(c, seed);
  const Parcels parcels = make_parcels(built.grains, bed.spheres);
  std::vector<Vec3> sites = free_sites(
      {rig.region, rig.low, rig.high, rig.periodic, rig.down, bed.largest, parcels.clearance}, built.bodies, seed);
  if (sites.size() < parcels.sites()) {
    built.position =
        grow({rig.region, rig.low, rig.high, rig.periodic, rig.down}, built.bodies, built.grains, {bed.spheres, seed});
    if (!built.position.empty()) return;
    const std::string parts = bed.equal ? "" : fmt::format(" ({} sites of the largest)", parcels.sites());
    fail("rig.fill",
         fmt::format("asks for {} spheres of {:g} m{}, but the fill region has room for {} clear of the meshes",
                     bed.spheres, bed.largest, parts, sites.size()),
         "lower the fill, or make rig.region larger");
  }
  built.position = place(parcels, jittered(std::move(sites), parcels.sites(), bed.largest, seed), bed.largest);
}

void check_mesh_in_box(const RigMesh& m, const Case& c, std::vector<data::Problem>& found) {
  const StlRig& rig = *c.rig.stl;
  const std::string place = fmt::format("rig.mesh.{}", m.name);
  Vec3 low = m.mesh.vertices.at(0), high = low;
  for (const Vec3 v : m.mesh.vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  if (!(length(high - low) > summarise_bed(c).smallest)) {
    found.push_back(
        {place, fmt::format("is {:g} m across, smaller than a sphere", length(high - low)), "correct the mesh's unit"});
  }
  if (constexpr double most = 30.0; length(high - low) > most * length(rig.high - rig.low)) {
    found.push_back(
        {place,
         fmt::format("is {:.3g} m across, but the box is {:.3g} m", length(high - low), length(rig.high - rig.low)),
         "correct the mesh's unit, or the box"});
    return;
  }
  const auto from = components(low), to = components(high), first = components(rig.low), last = components(rig.high);
  for (std::size_t a = 0; a < 3; ++a) {
    // Along a periodic axis a mesh may hang over, as its images do at the other end.
    const double over = rig.periodic[a] ? 0.5 * (last[a] - first[a]) : std::numeric_limits<double>::infinity();
    if (from[a] < first[a] - over || to[a] > last[a] + over || to[a] < first[a] || from[a] > last[a]) {
      found.push_back({place,
                       fmt::format("spans {:.6g} to {:.6g} m along {}, beyond the box of {:.6g} to {:.6g} m", from[a],
                                   to[a], axis_names[a], first[a], last[a]),
                       rig.periodic[a] ? "give one box length of the mesh, or another rig.box"
                                       : "correct the mesh's unit, or rig.box"});
    }
  }
}

void check_motion(const RigMesh& m, const Case& c, std::vector<data::Problem>& found) {
  const StlRig& rig = *c.rig.stl;
  const std::string place = fmt::format("rig.mesh.{}", m.name);
  const Motion motion = motion_of(m, c.rig.angular_velocity);
  for (std::size_t a = 0; a < 3; ++a) {
    if (!rig.periodic[a]) continue;
    const auto along = [&](Vec3 axis) { return std::abs(components(axis)[a]) > 1.0 - 1e-9; };
    bool fits = motion.programme.empty() || along(motion.axis);
    for (const Oscillation& o : motion.oscillations) fits = fits && (o.kind == OscillationKind::along || along(o.axis));
    if (!fits) {
      found.push_back({place,
                       fmt::format("turns about an axis across {}, along which the box is periodic", axis_names[a]),
                       "turn it about that axis, or make the box not periodic"});
    }
    for (const Oscillation& o : motion.oscillations) {
      const double way = std::abs(components(o.axis)[a]) * o.amplitude;
      const double size = components(rig.high - rig.low)[a];
      if (o.kind == OscillationKind::along && way > 0.25 * size) {
        found.push_back({place,
                         fmt::format("oscillates by {:g} m along the periodic box of {:g} m, but at most a quarter of "
                                     "the box is followed",
                                     way, size),
                         "lower the amplitude, or make the box longer"});
      }
    }
  }
}

BuiltRig build(const Case& c, std::uint64_t seed) {
  const StlRig& rig = *c.rig.stl;
  BuiltRig built;
  built.low = rig.low;
  built.high = rig.high;
  built.periodic = rig.periodic;
  built.down = rig.down;
  for (RigBody& body : bodies(c)) {
    const RigMesh& m = rig.meshes[built.bodies.size()];
    built.bodies.push_back({m.name, with_copies(m.mesh, periods(rig), m.tolerance), std::move(body.motion)});
  }
  if (rig.packing.empty()) {
    fill(c, seed, built);
  } else {
    built.grains = draw_grains(c, seed);
    check_packing(rig, {built.bodies, built.grains.radius, c.run.overlap_limit});
    built.position = rig.packing;
    built.velocity = rig.velocity;
    built.frozen = rig.frozen;
  }
  Sensor& sensor = built.sensor;
  for (const std::size_t k : measured(c)) {
    const Motion& motion = built.bodies[k].motion;
    sensor.driven.push_back({k, drive_sign(motion, c.run) * motion.axis});
  }
  const Motion first = sensor.driven.empty() ? Motion{} : built.bodies[sensor.driven.front().body].motion;
  sensor.flow_axis = first.axis;
  sensor.flow_length = extent_along(first.axis, rig.high - rig.low);
  sensor.period = turn_of(c);
  sensor.picture = {{}, {}, -rig.down};  // bodies about several axes have no side on which they rise
  if (!sensor.driven.empty() && one_axis(c))
    sensor.picture = picture_along(-sensor.driven.front().torque_axis, first.point, rig.down);
  built.channels = channels(c);
  return built;
}

std::vector<data::Problem> problems_of(const Case& c) {
  std::vector<data::Problem> found;
  const StlRig& rig = *c.rig.stl;
  const auto low = components(rig.low), high = components(rig.high);
  const BedSummary bed = summarise_bed(c);
  for (std::size_t a = 0; a < 3; ++a) {
    const double size = high[a] - low[a], least = rig.periodic[a] ? 4.0 * (1.0 + c.run.skin) * bed.largest : 0.0;
    if (!(size > least)) {
      found.push_back(
          {"rig.box",
           fmt::format("is {:g} m long along {}, but must be longer than {:g} m{}", size, axis_names[a], least,
                       rig.periodic[a] ? fmt::format(" (as it is periodic, four of the largest sphere, "
                                                     "each with run.skin, {:g} of it)",
                                                     c.run.skin)
                                       : ""),
           "correct rig.box"});
    }
  }
  if (rig.meshes.size() > max_bodies) {
    found.push_back({"rig.mesh", fmt::format("comes {} times, but at most {}", rig.meshes.size(), max_bodies),
                     "join meshes that move together into one file"});
  }
  if (!found.empty()) return found;
  for (const RigMesh& m : rig.meshes) {
    check_mesh_in_box(m, c, found);
    check_motion(m, c, found);
  }
  if (drives_a_body(c) && c.rig.angular_velocity == 0.0)
    found.push_back({"rig.rpm", "is zero: a mixer at rest has no torque to measure", "give a speed"});
  if (!rig.packing.empty() && !bed.equal && rig.diameter.empty()) {
    found.push_back({"rig.packing", "does not say which sphere is how large, and those of the bed differ",
                     "give it a column diameter, or remove packing, and give a fill"});
  } else if (!rig.packing.empty() && bed.spheres != rig.packing.size()) {
    found.push_back({"rig.fill",
                     fmt::format("makes {} spheres, but rig.packing has {} positions", bed.spheres, rig.packing.size()),
                     "leave fill away, or remove packing"});
  }
  return found;
}

std::string settings(const Case& c) {
  const StlRig& rig = *c.rig.stl;
  std::string lines = fmt::format("rig.box = {} {} {}{}{}\nrig.down = {}\nrig.content = {}\n", text(rig.low),
                                  text(rig.high), rig.periodic[0] ? "x" : "", rig.periodic[1] ? "y" : "",
                                  rig.periodic[2] ? "z" : "", text(rig.down), rig.content);
  for (const RigMesh& m : rig.meshes) {
    if (m.material != "wall") lines += fmt::format("rig.mesh.{}.material = {}\n", m.name, m.material);
    lines += fmt::format("rig.mesh.{} = about {} through {} ratio {:.17g}", m.name, text(m.motion.axis),
                         text(m.motion.point), m.speed_ratio);
    for (const SpeedPoint& p : m.motion.programme)
      lines += fmt::format(" [{:.17g}, {:.17g}]", p.time, p.angular_velocity);
    for (const Oscillation& o : m.motion.oscillations) {
      lines += fmt::format(" {} {} {:.17g} {:.17g} {:.17g}", o.kind == OscillationKind::along ? "along" : "about",
                           text(o.axis), o.amplitude, o.frequency, o.phase);
    }
    lines += "\n";
  }
  std::vector<std::string> names;
  for (const std::size_t k : measured(c)) names.push_back(rig.meshes[k].name);
  lines += fmt::format("rig.torque_of = {}\n", fmt::join(names, ", "));
  const FillRegion& r = rig.region;
  if (!rig.packing.empty()) return lines;
  if (r.shape == FillRegion::Shape::box)
    return lines + fmt::format("rig.region = box {} {}\n", text(r.low), text(r.high));
  return lines + fmt::format("rig.region = cylinder {} {} {:.17g} {:.17g}\n", text(r.from), text(r.to), r.radius,
                             r.inner_radius);
}

std::vector<NamedMesh> meshes(const Case& c) {
  std::vector<NamedMesh> all;
  for (const RigMesh& m : c.rig.stl->meshes) all.push_back({m.name, m.mesh});
  return all;
}

double fill_depth(const Case& c, double volume) {
  const StlRig& rig = *c.rig.stl;
  const Vec3 size = rig.high - rig.low, down = rig.down;
  const double height = std::abs(down.x) * size.x + std::abs(down.y) * size.y + std::abs(down.z) * size.z;
  const double box = size.x * size.y * size.z;
  return box > 0.0 ? volume * height / box : 0.0;
}

}  // namespace

const RigKind stl_rig{.name = "stl",
                      .is = [](const Case& c) { return c.rig.stl != nullptr; },
                      .fill_by = FillBy::fill,
                      .quantities = {},
                      .read =
                          [](const data::Section& s, const std::string& folder, Case& c) {
                            c.rig.stl = read_stl_rig(s, folder);
                            if (!c.rig.stl->packing.empty())
                              c.rig.fill = static_cast<double>(c.rig.stl->packing.size());
                          },
                      .build = build,
                      .meshes = meshes,
                      .warnings = [](const Case& c) { return c.rig.stl->warnings; },
                      .problems = problems_of,
                      .settings = settings,
                      .bodies = bodies,
                      .measured = measured,
                      .channels = channels,
                      .has_picture = shows_picture,
                      .tool_speed = [](const Case& c) { return mesh_speed(*c.rig.stl, c.rig.angular_velocity); },
                      .fill_depth = fill_depth,
                      .outlook = nullptr};

}  // namespace dem
