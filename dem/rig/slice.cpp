#include "dem/rig/slice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "data/random.hpp"
#include "dem/rig/packing.hpp"
#include "dem/rig/rig_kind.hpp"

namespace dem {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int facets = 48;      // of the shaft, the blade's rim and the trough's half circle
constexpr int blade_rings = 2;  // quadrilaterals from shaft to rim

/// Rows of points joined by triangles; `outside` is on the left of (along a row) x (to the next row).
void add_sheet(TriangleMesh& mesh, const std::vector<std::vector<Vec3>>& rows) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto width = static_cast<std::uint32_t>(rows[0].size());
  for (const auto& row : rows) mesh.vertices.insert(mesh.vertices.end(), row.begin(), row.end());
  for (std::uint32_t r = 0; r + 1 < rows.size(); ++r) {
    for (std::uint32_t k = 0; k + 1 < width; ++k) {
      const std::uint32_t a = base + r * width + k, b = a + 1, c = a + width, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
}

Vec3 at(double x, double radius, double angle) { return {x, radius * std::cos(angle), radius * std::sin(angle)}; }

}  // namespace

TriangleMesh auger_mesh(const Rig& rig) {
  TriangleMesh mesh;
  const double length = rig.pitches * rig.pitch;
  const int along = 4 * rig.pitches;
  std::vector<std::vector<Vec3>> shaft;
  for (int k = 0; k <= along; ++k) {
    shaft.emplace_back();
    for (int a = facets; a >= 0; --a)
      shaft.back().push_back(at(length * k / along, rig.shaft_radius, 2.0 * pi * a / facets));
  }
  add_sheet(mesh, shaft);
  // The blade winds from angle 0 at x = 0; it starts a little inside the shaft so that no gap opens between facets.
  const double root = rig.shaft_radius * std::cos(pi / facets) * 0.98;
  const int turns = facets * rig.pitches;
  const auto face = [&](double offset, bool reversed) {
    std::vector<std::vector<Vec3>> rows;
    for (int k = 0; k <= turns; ++k) {
      rows.emplace_back();
      const double angle = 2.0 * pi * k / facets;
      for (int r = 0; r <= blade_rings; ++r) {
        const double radius = root + (rig.blade_radius - root) * r / blade_rings;
        rows.back().push_back(at(rig.pitch * angle / (2.0 * pi) + offset, radius, angle));
      }
      if (reversed) std::reverse(rows.back().begin(), rows.back().end());
    }
    add_sheet(mesh, rows);
  };
  face(0.5 * rig.blade_thickness, false);
  face(-0.5 * rig.blade_thickness, true);
  std::vector<std::vector<Vec3>> rim;
  for (int k = 0; k <= turns; ++k) {
    const double angle = 2.0 * pi * k / facets, x = rig.pitch * angle / (2.0 * pi);
    rim.push_back({at(x + 0.5 * rig.blade_thickness, rig.blade_radius, angle),
                   at(x - 0.5 * rig.blade_thickness, rig.blade_radius, angle)});
  }
  add_sheet(mesh, rim);
  return weld(mesh, 1e-9 * rig.blade_radius);
}

TriangleMesh trough_mesh(const Rig& rig, double top) {
  TriangleMesh mesh;
  const double length = rig.pitches * rig.pitch, r = rig.trough_radius;
  const int along = 4 * rig.pitches;
  std::vector<Vec3> profile{{0.0, -r, top}};
  for (int a = 0; a <= facets; ++a) profile.push_back(at(0.0, r, pi + pi * a / facets));
  profile.push_back({0.0, r, top});
  // The ends of the half circle lie exactly under the side walls.
  profile[1] = {0.0, -r, 0.0};
  profile[profile.size() - 2] = {0.0, r, 0.0};
  std::vector<std::vector<Vec3>> rows;
  for (int k = 0; k <= along; ++k) {
    rows.push_back(profile);
    for (Vec3& p : rows.back()) p.x = length * k / along;
  }
  add_sheet(mesh, rows);
  return weld(mesh, 1e-9 * r);
}

Packing pack(const Case& c, std::uint64_t seed) {
  const BedSummary bed = summarise_bed(c);
  const Rig& rig = c.rig;
  Packing packing;
  packing.grains = draw_grains(c, seed);
  const Parcels parcels = make_parcels(packing.grains, bed.spheres);
  data::RandomStream random(seed, data::Purpose::packing);
  const double size = bed.largest, length = rig.pitches * rig.pitch;
  const double jitter = site_jitter * size, clear = parcels.clearance;
  // A simple cubic lattice whose spacing along x divides the box; sites keep clear of each other and of the walls.
  const int nx = static_cast<int>(length / (site_spacing * size));
  const double dx = length / nx, step = site_spacing * size;
  const double wall = rig.trough_radius * std::cos(pi / (2 * facets)) - clear;
  const int ny = static_cast<int>(std::floor(2.0 * wall / step)) + 1;
  const auto free = [&](Vec3 p) {
    const double rho = std::hypot(p.y, p.z);
    if (p.z < 0.0 ? rho > wall : std::abs(p.y) > wall) return false;
    if (rho < rig.shaft_radius + clear) return false;
    if (rho > rig.blade_radius + clear) return true;
    // Distance along x to the helicoid's faces; the true distance is that times the cosine of the helix angle, which
    // is least at the shaft.
    const double turn = std::atan2(p.z, p.y) / (2.0 * pi) * rig.pitch;
    const double off = std::abs(std::remainder(p.x - turn, rig.pitch));
    const double cosine = rig.shaft_radius * 2.0 * pi / std::hypot(rig.pitch, 2.0 * pi * rig.shaft_radius);
    return (off - 0.5 * rig.blade_thickness) * cosine > clear;
  };
  std::vector<Vec3> taken;
  for (int layer = 0; taken.size() < parcels.sites(); ++layer) {
    const double z = -wall + layer * step;
    std::vector<Vec3> sites;
    for (int ix = 0; ix < nx; ++ix) {
      for (int iy = 0; iy < ny; ++iy) {
        const Vec3 p{(ix + 0.5) * dx, (iy - 0.5 * (ny - 1)) * step, z};
        if (free(p)) sites.push_back(p);
      }
    }
    // Above the blade one layer is like the next: where none has a free site, no packing ever ends.
    if (sites.empty() && z > rig.blade_radius + clear) {
      throw data::InputError(data::ExitStatus::bad_study,
                             {"rig.trough_radius",
                              fmt::format("is {:g} m, which leaves no place for a sphere of {:g} m between the walls",
                                          rig.trough_radius, size),
                              "make the trough wider, or the spheres smaller"});
    }
    // The last layer is thinned at random.
    for (std::size_t k = sites.size(); k > 1; --k)
      std::swap(sites[k - 1], sites[static_cast<std::size_t>(random.uniform() * static_cast<double>(k))]);
    for (const Vec3 p : sites) {
      if (taken.size() == parcels.sites()) break;
      taken.push_back(p + jitter / std::sqrt(3.0) *
                              Vec3{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)});
      packing.top = std::max(packing.top, p.z + clear);
    }
  }
  for (std::size_t k = taken.size(); k > 1; --k)
    std::swap(taken[k - 1], taken[static_cast<std::size_t>(random.uniform() * static_cast<double>(k))]);
  packing.position = place(parcels, taken, size);
  return packing;
}

namespace {

/// Area of a disc of this radius about the axis that lies below the height z [m2].
double disc_below(double radius, double z) {
  if (z <= -radius) return 0.0;
  if (z >= radius) return pi * radius * radius;
  return radius * radius * std::acos(-z / radius) + z * std::sqrt(radius * radius - z * z);
}

/// Area of the trough below z, less the mixer's mean over its length [m2].
double room_below(const Rig& rig, double z) {
  const double r = rig.trough_radius;
  const double trough = z <= 0.0 ? disc_below(r, z) : 0.5 * pi * r * r + 2.0 * r * z;
  const double shaft = disc_below(rig.shaft_radius, z);
  const double blade = disc_below(rig.blade_radius, z) - shaft;
  return trough - shaft - rig.blade_thickness / rig.pitch * blade;
}

}  // namespace

SliceFill fill_of_slice(const Case& c) {
  const Rig& rig = c.rig;
  const double area = summarise_bed(c).volume / packing_fraction / (rig.pitches * rig.pitch);
  double low = -rig.trough_radius, high = rig.blade_radius;
  SliceFill fill{area / room_below(rig, high), 0.0};
  while (room_below(rig, high) < area)
    high += rig.trough_radius + 0.5 * (area - room_below(rig, high)) / rig.trough_radius;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (room_below(rig, middle) < area ? low : high) = middle;
  }
  fill.surface = high;
  return fill;
}

namespace {

BuiltRig build(const Case& c, std::uint64_t seed) {
  const Rig& rig = c.rig;
  BuiltRig s;
  Packing packing = pack(c, seed);
  // High enough that a grain which the blade pinches against the trough and lets go does not fly over the rim.
  const double top = std::max(packing.top, rig.blade_radius) + 8.0 * rig.blade_radius;
  const double length = rig.pitches * rig.pitch, side = rig.trough_radius;
  s.low = {0.0, -side, -side};
  s.high = {length, side, top};
  s.periodic = {true, false, false};
  s.grains = std::move(packing.grains);
  s.position = std::move(packing.position);
  const Vec3 shift{length, 0.0, 0.0};
  s.bodies.push_back({"mixer", with_copies(auger_mesh(rig), {shift}, 1e-9 * length), {}});
  s.bodies[mixer].motion.programme = {{0.0, rig.angular_velocity}};
  s.bodies.push_back({"trough", with_copies(trough_mesh(rig, top), {shift}, 1e-9 * length), {}});
  const double way = rig.angular_velocity > 0.0 ? -1.0 : 1.0;
  const Vec3 axis{way, 0.0, 0.0};
  s.sensor = {{mixer}, axis, axis, length, period(s.bodies[mixer].motion), picture_along(-axis, {}, s.down)};
  return s;
}

std::vector<data::Problem> problems_of(const Case& c) {
  std::vector<data::Problem> found;
  const Rig& rig = c.rig;
  const double size = summarise_bed(c).largest, length = rig.pitches * rig.pitch;
  if (!(rig.shaft_radius < rig.blade_radius && rig.blade_radius < rig.trough_radius)) {
    found.push_back({"rig",
                     fmt::format("has radii of shaft {:g}, blade {:g} and trough {:g} m, which must grow in this order",
                                 rig.shaft_radius, rig.blade_radius, rig.trough_radius),
                     "correct the radii"});
  }
  if (!(rig.blade_thickness < rig.pitch - 2.0 * size)) {
    found.push_back({"rig.blade_thickness", "leaves no room for two spheres between the flights",
                     "make the blade thinner or the pitch longer"});
  }
  if (!(length >= 4.0 * (1.0 + c.run.skin) * size)) {
    found.push_back({"rig.pitch", fmt::format("gives a periodic box of {:g} m, shorter than four spheres", length),
                     "raise pitches"});
  }
  if (!(rig.trough_radius - rig.shaft_radius > size)) {
    found.push_back({"rig.trough_radius",
                     fmt::format("leaves {:.3g} m between trough and shaft, but the largest sphere is {:.3g} m wide",
                                 rig.trough_radius - rig.shaft_radius, size),
                     "make the trough wider, or the spheres smaller"});
  }
  if (rig.angular_velocity == 0.0)
    found.push_back({"rig.rpm", "is zero: a mixer at rest has no torque to measure", "give a speed"});
  if (!found.empty()) return found;
  if (const SliceFill fill = fill_of_slice(c); fill.share > most_fill) {
    const BedSummary bed = summarise_bed(c);
    found.push_back({rig.fill_mass ? "rig.fill_mass" : "rig.fill",
                     fmt::format("makes {} spheres, {:.3g} g, which fill the trough up to {:.3g} times the room below "
                                 "the blade's top",
                                 bed.spheres, 1e3 * bed.mass, fill.share),
                     fmt::format("lower the fill to {:.2g} g, or check density, diameter and the slice's lengths",
                                 1e3 * bed.mass / fill.share)});
  }
  return found;
}

std::vector<NamedMesh> meshes(const Case& c) {
  return {{"mixer", auger_mesh(c.rig)}, {"trough", trough_mesh(c.rig, 2.0 * c.rig.blade_radius)}};
}

}  // namespace

const RigKind slice_rig{
    .name = "slice",
    .build = build,
    .meshes = meshes,
    .warnings = [](const Case&) { return std::vector<std::string>{}; },
    .problems = problems_of,
    .settings = [](const Case& c) { return fmt::format("rig.pitches = {}\n", c.rig.pitches); },
    .labels =
        [](const Case&) {
          return std::vector<BodyLabel>{{"mixer", "wall"}, {"trough", "wall"}};
        },
    .tool_speed = [](const Case& c) { return std::abs(c.rig.angular_velocity) * c.rig.blade_radius; },
    .fill_depth = [](const Case& c,
                     double volume) { return volume / (c.rig.pitches * c.rig.pitch * 2.0 * c.rig.trough_radius); }};

}  // namespace dem
