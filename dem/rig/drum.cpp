#include "dem/rig/drum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/rig/grow.hpp"
#include "dem/rig/level.hpp"
#include "dem/rig/rig_kind.hpp"
#include "dem/rig/rig_words.hpp"

namespace dem {
namespace {

using std::numbers::pi;

Vec3 at(double radius, double angle, double y) { return {radius * std::cos(angle), y, radius * std::sin(angle)}; }

/// A disc as a polygon around it, in a strip of triangles across: no fan of them meets at the centre.
void add_disc(TriangleMesh& mesh, double radius, double y) {
  constexpr std::uint32_t sides = 24;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t k = 0; k < sides; ++k)
    mesh.vertices.push_back(at(radius / std::cos(pi / sides), 2.0 * pi * k / sides, y));
  // 0, 1, n - 1, 2, n - 2, ...: every three in a row are a triangle.
  const auto corner = [&](std::uint32_t k) { return first + (k % 2 == 1 ? (k + 1) / 2 : (sides - k / 2) % sides); };
  for (std::uint32_t k = 0; k + 2 < sides; ++k) {
    if (k % 2 == 0)
      mesh.triangles.push_back({corner(k), corner(k + 1), corner(k + 2)});
    else
      mesh.triangles.push_back({corner(k + 1), corner(k), corner(k + 2)});
  }
}

}  // namespace

TriangleMesh shell_mesh(const Drum& drum, double smallest) {
  TriangleMesh mesh;
  const double inwards = std::min(0.01 * smallest / drum.radius, 0.5);
  const int sides = std::clamp(4 * static_cast<int>(std::ceil(0.25 * pi / std::acos(1.0 - inwards))), 48, 720);
  for (int k = 0; k < sides; ++k) {
    for (const double y : {0.0, drum.length}) mesh.vertices.push_back(at(drum.radius, 2.0 * pi * k / sides, y));
  }
  for (int k = 0; k < sides; ++k) {
    const auto a = static_cast<std::uint32_t>(2 * k), c = static_cast<std::uint32_t>(2 * ((k + 1) % sides));
    mesh.triangles.push_back({a, a + 1, c});
    mesh.triangles.push_back({c, a + 1, c + 1});
  }
  return mesh;
}

TriangleMesh end_plates_mesh(const Drum& drum) {
  TriangleMesh mesh;
  for (const double y : {0.0, drum.length}) add_disc(mesh, drum.radius, y);
  return mesh;
}

DrumFill fill_of_drum(const Case& c) {
  const Drum& drum = *c.rig.drum;
  DrumFill fill{summarise_bed(c).volume / packing_fraction / drum.volume(), drum.radius};
  // The share of a unit disc below z is (acos(-z) + z sqrt(1 - z^2)) / pi.
  double low = -1.0, high = 1.0;
  for (int k = 0; k < 60 && fill.share < 1.0; ++k) {
    const double z = 0.5 * (low + high), below = (std::acos(-z) + z * std::sqrt(1.0 - z * z)) / pi;
    (below < fill.share ? low : high) = z;
    fill.surface = z * drum.radius;
  }
  return fill;
}

double froude_number(const Case& c) {
  return c.rig.angular_velocity * c.rig.angular_velocity * c.rig.drum->radius / c.run.gravity;
}

namespace {

std::vector<RigBody> bodies(const Case& c) {
  const Motion turning{.axis = {0.0, -1.0, 0.0}, .programme = {{0.0, c.rig.angular_velocity}}};
  const Motion resting{.axis = turning.axis};
  std::vector<RigBody> all{{{"shell", "wall"}, turning, true}};
  switch (c.rig.drum->end_plates) {
    case EndPlates::turning:
      all.push_back({{"plates", "wall"}, turning, true});
      break;
    case EndPlates::resting:
      all.push_back({{"plates", "wall"}, resting});
      break;
    case EndPlates::none:
      break;
  }
  return all;
}

std::vector<std::size_t> measured(const Case& c) {
  return c.rig.drum->end_plates == EndPlates::turning ? std::vector<std::size_t>{shell, plates}
                                                      : std::vector<std::size_t>{shell};
}

BuiltRig build(const Case& c, std::uint64_t seed) {
  const Drum& drum = *c.rig.drum;
  const BedSummary bed = summarise_bed(c);
  const bool open = drum.end_plates == EndPlates::none;
  BuiltRig built;
  built.low = {-drum.radius, 0.0, -drum.radius};
  built.high = {drum.radius, drum.length, drum.radius};
  built.periodic = {false, open, false};
  for (RigBody& body : bodies(c)) {
    TriangleMesh mesh = built.bodies.size() == shell ? shell_mesh(drum, bed.smallest) : end_plates_mesh(drum);
    if (open) mesh = with_copies(mesh, {{0.0, drum.length, 0.0}}, 1e-9 * drum.radius);
    built.bodies.push_back({body.label.name, std::move(mesh), std::move(body.motion)});
  }
  const Vec3 axis = built.bodies[shell].motion.axis, turning = c.rig.angular_velocity < 0.0 ? -axis : axis;
  for (const std::size_t k : measured(c)) built.sensor.driven.push_back({k, -turning});
  built.sensor.flow_axis = {0.0, 1.0, 0.0};
  built.sensor.flow_length = drum.length;
  built.sensor.period = period(built.bodies[shell].motion);
  built.sensor.picture = picture_along(turning, {}, built.down);

  built.grains = draw_grains(c, seed);
  FillRegion inside{.shape = FillRegion::Shape::cylinder, .from = {}, .to = {0.0, drum.length, 0.0}};
  inside.radius = drum.radius;
  built.position = grow({inside, built.low, built.high, built.periodic, built.down}, built.bodies, built.grains,
                        {bed.spheres, seed});
  if (built.position.empty()) {
    throw data::InputError(
        data::ExitStatus::bad_study,
        {"rig.fill",
         fmt::format("makes {} spheres up to {:.3g} m wide, for which the drum of {:.3g} m radius and {:.3g} m length "
                     "has no room",
                     bed.spheres, bed.largest, drum.radius, drum.length),
         "lower the fill, or make the drum larger"});
  }
  return built;
}

std::vector<data::Problem> problems_of(const Case& c) {
  std::vector<data::Problem> found;
  const Drum& drum = *c.rig.drum;
  const double size = summarise_bed(c).largest;
  if (!(drum.radius > 2.0 * size))
    found.push_back({"rig.drum_radius",
                     fmt::format("is {:.3g} m, less than two of the largest sphere, {:.3g} m", drum.radius, size),
                     "make the drum wider, or the spheres smaller"});
  const bool open = drum.end_plates == EndPlates::none;
  const double least = open ? 4.0 * (1.0 + c.run.skin) * size : 1.5 * size;
  if (!(drum.length >= least))
    found.push_back({"rig.drum_length",
                     fmt::format("is {:.3g} m, but must be at least {:.3g} m, {}", drum.length, least,
                                 open ? fmt::format("as the drum repeats along its axis, four of the largest sphere, "
                                                    "each with run.skin, {:g} of it",
                                                    c.run.skin)
                                      : "one and a half spheres"),
                     "make the drum longer, or the spheres smaller"});
  if (c.rig.angular_velocity == 0.0)
    found.push_back({"rig.rpm", "is zero: a drum at rest has no torque to measure", "give a speed"});
  if (!found.empty()) return found;
  if (const DrumFill fill = fill_of_drum(c); fill.share > fullest_drum) {
    const BedSummary bed = summarise_bed(c);
    found.push_back({c.rig.level ? "rig.level" : "rig.fill",
                     fmt::format("makes {} spheres, {:.3g} g, whose bed takes {:.3g} of the drum's volume; at most "
                                 "{:g} leaves a surface on which it can flow",
                                 bed.spheres, 1e3 * bed.mass, fill.share, fullest_drum),
                     fmt::format("lower the fill to {:.3g} g or less", 1e3 * bed.mass * fullest_drum / fill.share)});
  }
  return found;
}

std::vector<NamedMesh> meshes(const Case& c) {
  const Drum& drum = *c.rig.drum;
  std::vector<NamedMesh> all{{"shell", shell_mesh(drum, summarise_bed(c).smallest)}};
  if (drum.end_plates != EndPlates::none) all.push_back({"plates", end_plates_mesh(drum)});
  return all;
}

RigOutlook outlook(const Case& c) {
  const Drum& drum = *c.rig.drum;
  const DrumFill fill = fill_of_drum(c);
  RigOutlook found{.fill = fill.share, .surface = fill.surface, .up = "above the axis", .full_at = "the drum's top"};
  const bool both = drum.end_plates == EndPlates::turning;
  found.bodies = {
      fmt::format("shell: {} x {} mm, turns about -y at {:.4g} rpm; the output is its torque{}", mm(2.0 * drum.radius),
                  mm(drum.length), rpm(c.rig.angular_velocity), both ? " and that of the end plates" : ""),
      both                                    ? "plates: both end plates turn with the shell"
      : drum.end_plates == EndPlates::resting ? "plates: both end plates rest"
                                              : "no end plates: the drum repeats along its axis"};
  if (drum.end_plates != EndPlates::none) found.passages = {{"the end plates", drum.length}};
  if (const double froude = froude_number(c); froude > 1.0)
    found.warnings.push_back(fmt::format(
        "at {:.4g} rpm the Froude number is {:.3g}: from 1 on the powder goes round with the shell "
        "(the drum flows below {:.4g} rpm)",
        rpm(std::abs(c.rig.angular_velocity)), froude, rpm(std::abs(c.rig.angular_velocity)) / std::sqrt(froude)));
  return found;
}

template <double Drum::*Field>
constexpr RigQuantity drum_length(const char* key, double low, double high, const char* meaning) {
  return {key,
          "m",
          low,
          high,
          meaning,
          [](const Case& c) { return c.rig.drum.value_or(Drum{}).*Field; },
          [](Case& c, double si) { c.rig.drum.value().*Field = si; }};
}
constexpr RigQuantity drum_quantities[]{
    drum_length<&Drum::radius>("drum_radius", 1e-6, 10.0, "radius of the drum, inside"),
    drum_length<&Drum::length>("drum_length", 1e-6, 10.0, "length of the drum between its end plates"), level_quantity};

}  // namespace

const RigKind drum_rig{
    .name = "drum",
    .is = [](const Case& c) { return c.rig.drum.has_value(); },
    .fill_by = FillBy::fill_or_level,
    .quantities = drum_quantities,
    .read =
        [](const data::Section& s, const std::string&, Case& c) {
          Drum& drum = c.rig.drum.emplace();
          drum.end_plates = s.choice("end_plates", drum.end_plates);
          c.rig.level = 0.5;
        },
    .build = build,
    .meshes = meshes,
    .warnings = [](const Case&) { return std::vector<std::string>{}; },
    .problems = problems_of,
    .settings =
        [](const Case& c) { return fmt::format("rig.end_plates = {}\n", data::to_text(c.rig.drum->end_plates)); },
    .bodies = bodies,
    .measured = measured,
    .channels = [](const Case&) { return Channels{}; },
    .has_picture = [](const Case&) { return true; },
    .tool_speed = [](const Case& c) { return std::abs(c.rig.angular_velocity) * c.rig.drum->radius; },
    .fill_depth = [](const Case& c, double volume) { return volume / (c.rig.drum->length * 2.0 * c.rig.drum->radius); },
    .outlook = outlook};

}  // namespace dem
