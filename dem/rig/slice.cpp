#include "dem/rig/slice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "data/random.hpp"
#include "data/shuffle.hpp"
#include "dem/case/cross_section.hpp"
#include "dem/rig/auger.hpp"
#include "dem/rig/packing.hpp"
#include "dem/rig/rig_kind.hpp"
#include "dem/rig/rig_words.hpp"

namespace dem {
using std::numbers::pi;

TriangleMesh auger_mesh(const Rig& rig) {
  const Stretch all{0.0, rig.pitches * rig.pitch};
  return auger_mesh(rig, all, all, BladeEnds::open);
}

TriangleMesh trough_mesh(const Rig& rig, double top) {
  TriangleMesh mesh;
  const double length = rig.pitches * rig.pitch, r = rig.trough_radius;
  const int along = rows_per_pitch * rig.pitches;
  std::vector<Vec3> profile{{0.0, -r, top}};
  for (int a = 0; a <= facets; ++a) profile.push_back(about_axis(0.0, r, pi + pi * a / facets));
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
    data::shuffle(std::span(sites), random);
    for (const Vec3 p : sites) {
      if (taken.size() == parcels.sites()) break;
      taken.push_back(p + jitter / std::sqrt(3.0) *
                              Vec3{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)});
      packing.top = std::max(packing.top, p.z + clear);
    }
  }
  data::shuffle(std::span(taken), random);
  packing.position = place(parcels, taken, size);
  return packing;
}

TroughFill fill_of_slice(const Case& c) {
  const Rig& rig = c.rig;
  return level_out(rig, summarise_bed(c).volume / packing_fraction / (rig.pitches * rig.pitch),
                   [&](double z) { return trough_room_below(rig, z); });
}

namespace {

std::vector<RigBody> bodies(const Case& c) {
  const Motion turning{.programme = {{0.0, c.rig.angular_velocity}}};
  return {{{"mixer", "wall"}, turning, true}, {{"trough", "wall"}}};
}

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
  for (const RigBody& body : bodies(c)) {
    const TriangleMesh mesh = s.bodies.size() == mixer ? auger_mesh(rig) : trough_mesh(rig, top);
    s.bodies.push_back({body.label.name, with_copies(mesh, {{length, 0.0, 0.0}}, 1e-9 * length), body.motion});
  }
  const double way = rig.angular_velocity > 0.0 ? -1.0 : 1.0;
  const Vec3 axis{way, 0.0, 0.0};
  s.sensor = {{{mixer, axis}}, axis, length, period(s.bodies[mixer].motion), picture_along(-axis, {}, s.down)};
  return s;
}

std::vector<data::Problem> problems_of(const Case& c) {
  std::vector<data::Problem> found = auger_problems(c);
  const Rig& rig = c.rig;
  const double size = summarise_bed(c).largest, length = rig.pitches * rig.pitch;
  if (const double least = 4.0 * (1.0 + c.run.skin) * size; !(length >= least)) {
    found.push_back(
        {"rig.pitch",
         fmt::format("gives a periodic box of {:g} m, shorter than {:g} m: four of the largest sphere, each "
                     "with run.skin, {:g} of it",
                     length, least, c.run.skin),
         "raise pitches"});
  }
  if (!found.empty()) return found;
  check_fill(c, fill_of_slice(c), found);
  return found;
}

std::vector<NamedMesh> meshes(const Case& c) {
  return {{"mixer", auger_mesh(c.rig)}, {"trough", trough_mesh(c.rig, 2.0 * c.rig.blade_radius)}};
}

RigOutlook outlook(const Case& c) {
  const Rig& rig = c.rig;
  const TroughFill fill = fill_of_slice(c);
  RigOutlook found{.fill = fill.share, .surface = fill.surface, .up = "above the axis", .full_at = "the blade's top"};
  found.bodies = {
      fmt::format("mixer: turns about x at {:.4g} rpm; its torque is the output", rpm(rig.angular_velocity))};
  found.passages = {{"blade and trough", rig.trough_radius - rig.blade_radius},
                    {"two flights of the blade", rig.pitch - rig.blade_thickness}};
  found.tools = {{"the blade", -rig.blade_radius}};
  if (fill.share > 1.0) {
    found.warnings.push_back(
        fmt::format("the powder will stand {} mm above the blade: {:.2g} times what fits below its top",
                    mm(fill.surface - rig.blade_radius), fill.share));
  }
  Case loose = c;
  if (loose.rig.fill_mass) *loose.rig.fill_mass *= packing_fraction / loosest_bed;
  loose.rig.fill *= packing_fraction / loosest_bed;
  if (fill_of_slice(loose).surface + summarise_bed(c).largest < -rig.blade_radius) {
    found.problems.push_back(
        {"rig.fill",
         fmt::format("makes a bed up to {} mm above the axis, but the blade reaches down to {} mm: "
                     "it never touches the powder",
                     mm(fill.surface), mm(-rig.blade_radius)),
         "raise the fill"});
  }
  return found;
}

}  // namespace

const RigKind slice_rig{
    .name = "slice",
    .is = [](const Case&) { return true; },
    .fill_by = FillBy::fill,
    .quantities = auger_quantities,
    .read =
        [](const data::Section& s, const std::string&, Case& c) {
          c.rig.pitches = static_cast<int>(s.integer("pitches", {.low = 1, .high = 1000}, c.rig.pitches));
        },
    .build = build,
    .meshes = meshes,
    .warnings = [](const Case&) { return std::vector<std::string>{}; },
    .problems = problems_of,
    .settings = [](const Case& c) { return fmt::format("rig.pitches = {}\n", c.rig.pitches); },
    .bodies = bodies,
    .measured = [](const Case&) { return std::vector<std::size_t>{mixer}; },
    .channels = [](const Case&) { return Channels{}; },
    .has_picture = [](const Case&) { return true; },
    .tool_speed = [](const Case& c) { return std::abs(c.rig.angular_velocity) * c.rig.blade_radius; },
    .fill_depth = [](const Case& c,
                     double volume) { return volume / (c.rig.pitches * c.rig.pitch * 2.0 * c.rig.trough_radius); },
    .outlook = outlook};

}  // namespace dem
