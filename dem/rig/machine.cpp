#include "dem/rig/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "dem/rig/auger.hpp"
#include "dem/rig/grow.hpp"
#include "dem/rig/level.hpp"
#include "dem/rig/rig_kind.hpp"
#include "dem/rig/rig_words.hpp"

namespace dem {
namespace {

using std::numbers::pi;

TriangleMesh shifted(TriangleMesh mesh, double y) {
  for (Vec3& v : mesh.vertices) v.y += y;
  return mesh;
}

/// Half of the trough's outline, at y >= 0, in the plane x = 0.
struct Outline {
  std::vector<Vec3> below;      ///< from the outer wall's top down and up again to the sill
  std::vector<Vec3> partition;  ///< from the sill to the partition's top: of the face that looks at the second trough
};

Outline outline(const Rig& rig, double top) {
  const Machine& m = rig.machine.value();
  const double r = rig.trough_radius, y = axis_offset(rig), inner = 0.5 * m.partition;
  const auto on_circle = [&](double angle) { return about_axis(0.0, r, angle) + Vec3{0.0, y, 0.0}; };
  Outline o;
  const Vec3 sill = m.sill < 0.0 ? on_circle(pi + std::asin(-m.sill / r)) : Vec3{0.0, inner, m.sill};
  o.below = {{0.0, y + r, top}, {0.0, y + r, 0.0}};
  const auto add = [&](Vec3 p) {
    // A point very near to the sill's point is taken as that point, so that no triangle is a sliver.
    if (length(p - sill) < 1e-4 * r) return;
    (o.partition.empty() ? o.below : o.partition).push_back(p);
  };
  const auto reach_sill = [&] {
    o.below.push_back(sill);
    o.partition.push_back(sill);
  };
  for (int k = facets - 1; k > 0; --k) {
    const Vec3 p = on_circle(pi + pi * k / facets);
    if (o.partition.empty() && k < facets / 2 && p.z > sill.z) reach_sill();
    add(p);
  }
  if (o.partition.empty() && m.sill <= 0.0) reach_sill();
  add({0.0, inner, 0.0});
  if (o.partition.empty()) reach_sill();
  o.partition.push_back({0.0, inner, m.partition_height});
  return o;
}

Vec3 mirrored(Vec3 p) { return {p.x, -p.y, p.z}; }
Vec3 at_x(Vec3 p, double x) { return {x, p.y, p.z}; }

/// The points from one outer wall to the other, over the sill or over the partition.
std::vector<Vec3> across(const Outline& o, bool partition) {
  std::vector<Vec3> half = o.below;
  if (partition) half.insert(half.end(), o.partition.begin() + 1, o.partition.end());
  std::vector<Vec3> all;
  std::transform(half.begin(), half.end(), std::back_inserter(all), mirrored);
  all.insert(all.end(), half.rbegin(), half.rend());
  return all;
}

void add_along(TriangleMesh& mesh, const std::vector<Vec3>& profile, Stretch stretch, double pitch) {
  const double length = stretch.to - stretch.from;
  const int along = std::max(1, static_cast<int>(std::lround(rows_per_pitch * length / pitch)));
  std::vector<std::vector<Vec3>> rows;
  for (int k = 0; k <= along; ++k) {
    rows.push_back(profile);
    for (Vec3& p : rows.back()) p.x = k == along ? stretch.to : stretch.from + length * k / along;
  }
  add_sheet(mesh, rows);
}

}  // namespace

double axis_offset(const Rig& rig) { return rig.trough_radius + 0.5 * rig.machine.value().partition; }

TriangleMesh first_auger(const Rig& rig) {
  const Machine& m = rig.machine.value();
  return shifted(auger_mesh(rig, {0.0, m.length}, {m.opening, m.length - end_gap(rig)}, BladeEnds::closed),
                 -axis_offset(rig));
}

TriangleMesh second_auger(const Rig& rig) {
  const Machine& m = rig.machine.value();
  return shifted(auger_mesh(rig, {0.0, m.length}, {end_gap(rig), m.length - m.opening}, BladeEnds::closed),
                 axis_offset(rig));
}

TriangleMesh double_trough(const Rig& rig, double top) {
  const Machine& m = rig.machine.value();
  const Outline o = outline(rig, top);
  TriangleMesh mesh;
  const double open = m.opening, last = m.length - m.opening;
  add_along(mesh, across(o, false), {0.0, open}, rig.pitch);
  add_along(mesh, across(o, true), {open, last}, rig.pitch);
  add_along(mesh, across(o, false), {last, m.length}, rig.pitch);
  for (const double x : {open, last}) {  // the partition's ends
    std::vector<std::vector<Vec3>> rows;
    for (const Vec3 p : o.partition) rows.push_back({at_x(mirrored(p), x), at_x(p, x)});
    if (x == last) std::reverse(rows.begin(), rows.end());
    add_sheet(mesh, rows);
  }
  const double side = axis_offset(rig) + rig.trough_radius, bottom = -rig.trough_radius;
  for (const double x : {0.0, m.length}) {
    std::vector<std::vector<Vec3>> rows{{{x, -side, bottom}, {x, side, bottom}}, {{x, -side, top}, {x, side, top}}};
    if (x == 0.0) std::reverse(rows.begin(), rows.end());
    add_sheet(mesh, rows);
  }
  return weld(mesh, 1e-9 * rig.trough_radius);
}

TroughFill fill_of_machine(const Case& c) {
  return level_out(c.rig, summarise_bed(c).volume / packing_fraction,
                   [&](double z) { return machine_room_below(c.rig, z); });
}

namespace {

Channels channels(const Case& c) {
  const Machine& m = *c.rig.machine;
  // An auger whose helix turns forward about +x conveys towards -x.
  const double conveys = c.rig.angular_velocity > 0.0 ? -1.0 : 1.0;
  Channels found{.along = {conveys, 0.0, 0.0}, .across = {0.0, 1.0, 0.0}};
  std::tie(found.from, found.to) = std::minmax({0.0, conveys * m.length});
  std::tie(found.flow_from, found.flow_to) = std::minmax({conveys * m.opening, conveys * (m.length - m.opening)});
  return found;
}

std::vector<RigBody> bodies(const Case& c) {
  const double y = axis_offset(c.rig);
  const auto turning = [&](double side) {
    return Motion{
        .point = {0.0, side * y, 0.0}, .axis = {-side, 0.0, 0.0}, .programme = {{0.0, c.rig.angular_velocity}}};
  };
  return {{{"first_mixer", "wall"}, turning(-1.0), true},
          {{"second_mixer", "wall"}, turning(1.0), true},
          {{"trough", "wall"}}};
}

std::vector<std::size_t> measured(const Case&) { return {first_mixer, second_mixer}; }

BuiltRig build(const Case& c, std::uint64_t seed) {
  const Rig& rig = c.rig;
  const Machine& m = *rig.machine;
  const BedSummary bed = summarise_bed(c);
  const double side = axis_offset(rig) + rig.trough_radius;
  // High enough that a grain which a blade pinches and lets go does not fly over the rim.
  const double top =
      std::max({fill_of_machine(c).surface, rig.blade_radius, m.partition_height}) + 8.0 * rig.blade_radius;
  BuiltRig built;
  built.low = {0.0, -side, -rig.trough_radius};
  built.high = {m.length, side, top};
  const std::array<TriangleMesh, 3> meshes{first_auger(rig), second_auger(rig), double_trough(rig, top)};
  for (RigBody& body : bodies(c))
    built.bodies.push_back({body.label.name, meshes[built.bodies.size()], std::move(body.motion)});
  const double resists = rig.angular_velocity > 0.0 ? -1.0 : 1.0;
  for (const std::size_t k : measured(c)) built.sensor.driven.push_back({k, resists * built.bodies[k].motion.axis});
  built.channels = channels(c);
  built.sensor.flow_axis = built.channels.along;
  built.sensor.flow_length = 2.0 * (m.length - 2.0 * m.opening);
  built.sensor.circulates = true;
  built.sensor.period = period(built.bodies[first_mixer].motion);
  built.sensor.picture = {{}, {}, -built.down};  // two that turn against each other have no rising side

  built.grains = draw_grains(c, seed);
  const FillRegion inside{.low = built.low, .high = built.high};
  built.position = grow({inside, built.low, built.high, built.periodic, built.down}, built.bodies, built.grains,
                        {bed.spheres, seed});
  if (built.position.empty()) {
    throw data::InputError(data::ExitStatus::bad_study,
                           {"rig.fill",
                            fmt::format("makes {} spheres up to {:.3g} m wide, for which the machine has no room",
                                        bed.spheres, bed.largest),
                            "lower the fill, or make the machine larger"});
  }
  return built;
}

std::vector<data::Problem> problems_of(const Case& c) {
  std::vector<data::Problem> found = auger_problems(c);
  const Rig& rig = c.rig;
  const Machine& m = *rig.machine;
  const double size = summarise_bed(c).largest;
  if (!(m.partition_height > std::max(0.0, m.sill)))
    found.push_back({"rig.partition_height",
                     fmt::format("is {:g} m above the axes, but must lie above them and above the sill, {:g} m",
                                 m.partition_height, m.sill),
                     "make the partition higher"});
  if (!(m.sill > -rig.trough_radius))
    found.push_back(
        {"rig.sill",
         fmt::format("is {:g} m, but must lie above the trough's bottom, {:g} m", m.sill, -rig.trough_radius),
         "raise the sill"});
  if (!(m.opening >= 3.0 * size))
    found.push_back({"rig.opening",
                     fmt::format("is {:g} m long, too short for three of the largest sphere, {:g} m", m.opening, size),
                     "make the openings longer"});
  if (!(m.length - m.opening - end_gap(rig) >= rig.pitch && m.length > 2.0 * m.opening))
    found.push_back(
        {"rig.machine_length",
         fmt::format("is {:g} m, which leaves no pitch of blade between openings of {:g} m", m.length, m.opening),
         fmt::format("make the machine at least {:g} m long",
                     std::max(2.0 * m.opening, m.opening + end_gap(rig)) + rig.pitch)});
  if (!found.empty()) return found;
  check_fill(c, fill_of_machine(c), found);
  return found;
}

std::vector<NamedMesh> meshes(const Case& c) {
  return {{"first_mixer", first_auger(c.rig)},
          {"second_mixer", second_auger(c.rig)},
          {"trough", double_trough(c.rig, 2.0 * c.rig.machine->partition_height)}};
}

RigOutlook outlook(const Case& c) {
  const Rig& rig = c.rig;
  const TroughFill fill = fill_of_machine(c);
  RigOutlook found{.fill = fill.share, .surface = fill.surface, .up = "above the axes", .full_at = "the blades' top"};
  for (const char* name : {"first_mixer", "second_mixer"})
    found.bodies.push_back(fmt::format("{}: turns at {:.4g} rpm; the sum of both mixers' torques is the output", name,
                                       rpm(rig.angular_velocity)));
  found.passages = {{"blade and trough", rig.clearance()},
                    {"two flights of the blade", rig.pitch - rig.blade_thickness}};
  found.tools = {{"each blade", -rig.blade_radius}};
  if (fill.surface < rig.machine->sill)
    found.warnings.push_back(fmt::format(
        "the bed's surface will lie at {} mm, below the openings' sill at {} mm: the powder goes round only "
        "where it heaps up",
        mm(fill.surface), mm(rig.machine->sill)));
  if (fill.surface > rig.machine->partition_height)
    found.warnings.push_back(fmt::format(
        "the powder will stand above the partition, at {} mm: it passes over it everywhere", mm(fill.surface)));
  // An auger carries its powder by a pitch a turn at most.
  if (const double round = 2.0 * rig.machine->length / rig.pitch; c.run.start_up_turns < round)
    found.warnings.push_back(fmt::format(
        "the powder goes round this machine once in {:.3g} turns at best, and run.start_up_turns is {:g}: where the "
        "bed lies is not yet what it will be (raise it)",
        round, c.run.start_up_turns));
  return found;
}

template <double Machine::*Field>
constexpr RigQuantity machine_length(const char* key, double low, double high, const char* meaning) {
  return {key,
          "m",
          low,
          high,
          meaning,
          [](const Case& c) { return c.rig.machine.value_or(Machine{}).*Field; },
          [](Case& c, double si) { c.rig.machine.value().*Field = si; }};
}
constexpr RigQuantity machine_quantities[]{
    auger_quantities[0],
    auger_quantities[1],
    auger_quantities[2],
    auger_quantities[3],
    auger_quantities[4],
    level_quantity,
    machine_length<&Machine::length>("machine_length", 1e-6, 100.0, "length of the machine between its end walls"),
    machine_length<&Machine::opening>("opening", 1e-6, 100.0, "length of the opening at each end of the partition"),
    machine_length<&Machine::partition>("partition", 1e-6, 10.0, "thickness of the partition"),
    machine_length<&Machine::partition_height>("partition_height", 1e-6, 10.0,
                                               "height of the partition above the axes"),
    machine_length<&Machine::sill>("sill", -10.0, 10.0, "height of the openings' lower edge above the axes"),
};

}  // namespace

const RigKind machine_rig{
    .name = "machine",
    .is = [](const Case& c) { return c.rig.machine.has_value(); },
    .fill_by = FillBy::fill_or_level,
    .quantities = machine_quantities,
    .read =
        [](const data::Section&, const std::string&, Case& c) {
          c.rig.machine.emplace();
          c.rig.fill_mass = 0.3;
        },
    .build = build,
    .meshes = meshes,
    .warnings = [](const Case&) { return std::vector<std::string>{}; },
    .problems = problems_of,
    .settings = [](const Case&) { return std::string{}; },
    .bodies = bodies,
    .measured = measured,
    .channels = channels,
    .has_picture = [](const Case&) { return false; },  // two axes
    .tool_speed = [](const Case& c) { return std::abs(c.rig.angular_velocity) * c.rig.blade_radius; },
    .fill_depth = [](const Case& c,
                     double volume) { return volume / (c.rig.machine->length * 4.0 * c.rig.trough_radius); },
    .outlook = outlook};

}  // namespace dem
