#include "dem/rig/auger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/case/grains.hpp"

namespace dem {
namespace {

using std::numbers::pi;
constexpr int blade_rings = 2;  // quadrilaterals from shaft to rim

}  // namespace

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

Vec3 about_axis(double x, double radius, double angle) {
  return {x, radius * std::cos(angle), radius * std::sin(angle)};
}

TriangleMesh auger_mesh(const Rig& rig, Stretch shaft, Stretch blade, BladeEnds ends) {
  TriangleMesh mesh;
  const double length = shaft.to - shaft.from;
  const int along = std::max(1, static_cast<int>(std::lround(rows_per_pitch * length / rig.pitch)));
  std::vector<std::vector<Vec3>> rows;
  for (int k = 0; k <= along; ++k) {
    rows.emplace_back();
    for (int a = facets; a >= 0; --a)
      rows.back().push_back(about_axis(shaft.from + length * k / along, rig.shaft_radius, 2.0 * pi * a / facets));
  }
  add_sheet(mesh, rows);
  // The blade starts a little inside the shaft so that no gap opens between facets.
  const double root = rig.shaft_radius * std::cos(pi / facets) * 0.98, half = 0.5 * rig.blade_thickness;
  constexpr double rounding = 1e-9;
  const int first = static_cast<int>(std::ceil(facets * blade.from / rig.pitch - rounding));
  const int last = static_cast<int>(std::floor(facets * blade.to / rig.pitch + rounding));
  const auto on_face = [&](int k, int ring, double offset) {
    const double angle = 2.0 * pi * k / facets;
    return about_axis(rig.pitch * angle / (2.0 * pi) + offset, root + (rig.blade_radius - root) * ring / blade_rings,
                      angle);
  };
  for (const double offset : {half, -half}) {
    rows.clear();
    for (int k = first; k <= last; ++k) {
      rows.emplace_back();
      for (int r = 0; r <= blade_rings; ++r) rows.back().push_back(on_face(k, r, offset));
      if (offset < 0.0) std::reverse(rows.back().begin(), rows.back().end());
    }
    add_sheet(mesh, rows);
  }
  rows.clear();
  for (int k = first; k <= last; ++k) rows.push_back({on_face(k, blade_rings, half), on_face(k, blade_rings, -half)});
  add_sheet(mesh, rows);
  if (ends == BladeEnds::closed) {
    for (const int k : {first, last}) {
      rows.clear();
      for (int r = 0; r <= blade_rings; ++r) {
        rows.push_back({on_face(k, r, half), on_face(k, r, -half)});
        if (k == first) std::swap(rows.back()[0], rows.back()[1]);
      }
      add_sheet(mesh, rows);
    }
  }
  return weld(mesh, 1e-9 * rig.blade_radius);
}

std::vector<data::Problem> auger_problems(const Case& c) {
  std::vector<data::Problem> found;
  const Rig& rig = c.rig;
  const double size = summarise_bed(c).largest;
  if (!(rig.shaft_radius < rig.blade_radius))
    found.push_back({"rig.shaft_radius",
                     fmt::format("is {:g} m, but the blade reaches from the shaft to rig.blade_radius, {:g} m",
                                 rig.shaft_radius, rig.blade_radius),
                     "make the shaft thinner, or the blade wider"});
  if (!(rig.blade_radius < rig.trough_radius))
    found.push_back({"rig.blade_radius",
                     fmt::format("is {:g} m, but the blade turns inside rig.trough_radius, {:g} m", rig.blade_radius,
                                 rig.trough_radius),
                     "make the blade narrower, or the trough wider"});
  if (!(rig.blade_thickness < rig.pitch - 2.0 * size)) {
    found.push_back({"rig.blade_thickness", "leaves no room for two spheres between the flights",
                     "make the blade thinner or the pitch longer"});
  }
  if (!(rig.trough_radius - rig.shaft_radius > size)) {
    found.push_back({"rig.trough_radius",
                     fmt::format("leaves {:.3g} m between trough and shaft, but the largest sphere is {:.3g} m wide",
                                 rig.trough_radius - rig.shaft_radius, size),
                     "make the trough wider, or the spheres smaller"});
  }
  if (rig.angular_velocity == 0.0)
    found.push_back({"rig.rpm", "is zero: a mixer at rest has no torque to measure", "give a speed"});
  return found;
}

void check_fill(const Case& c, const TroughFill& fill, std::vector<data::Problem>& found) {
  if (!(fill.share > most_fill)) return;
  const BedSummary bed = summarise_bed(c);
  const char* const key = c.rig.level ? "rig.level" : c.rig.fill_mass ? "rig.fill_mass" : "rig.fill";
  found.push_back({key,
                   fmt::format("makes {} spheres, {:.3g} g, which fill the trough up to {:.3g} times the room below "
                               "the blade's top",
                               bed.spheres, 1e3 * bed.mass, fill.share),
                   fmt::format("lower the fill to {:.2g} g, or check density, diameter and the {}'s lengths",
                               1e3 * bed.mass / fill.share, rig_kind(c))});
}

}  // namespace dem
