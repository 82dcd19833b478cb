#include "dem/rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/derived.hpp"
#include "dem/slice.hpp"

namespace dem {

BuiltRig build_rig(const Case& c, std::uint64_t seed) {
  return c.rig.stl ? build_stl_rig(c, seed) : build_slice(c, seed);
}

std::vector<NamedMesh> rig_meshes(const Case& c) {
  std::vector<NamedMesh> meshes;
  if (c.rig.stl) {
    for (const RigMesh& m : c.rig.stl->meshes) meshes.push_back({m.name, m.mesh});
  } else {
    meshes.push_back({"mixer", auger_mesh(c.rig)});
    meshes.push_back({"trough", trough_mesh(c.rig, 2.0 * c.rig.blade_radius)});
  }
  return meshes;
}

std::vector<std::string> rig_warnings(const Case& c) {
  return c.rig.stl ? c.rig.stl->warnings : std::vector<std::string>{};
}

Setup make_setup(const Case& c, BuiltRig rig, std::uint64_t rest_steps, int threads) {
  const Derived d = derive(c);
  Setup s;
  s.low = rig.low;
  s.high = rig.high;
  s.periodic = rig.periodic;
  s.spheres.radius = {0.5 * c.material.diameter};
  s.spheres.density = {c.material.density};
  s.spheres.position = std::move(rig.position);
  s.spheres.velocity = std::move(rig.velocity);
  s.spheres.frozen = std::move(rig.frozen);
  s.bodies = std::move(rig.bodies);
  s.laws = make_force_pass(make_bed(c, s.bodies.size()));
  s.gravity = c.run.gravity * rig.down;
  s.time_step = d.time_step;
  s.skin = d.skin;
  s.rest_steps = rest_steps;
  s.threads = threads;
  return s;
}

std::vector<data::Problem> rig_problems(const Case& c) { return c.rig.stl ? stl_rig_problems(c) : slice_problems(c); }

std::string rig_settings(const Case& c) {
  return c.rig.stl ? stl_rig_settings(*c.rig.stl) : fmt::format("rig.pitches = {}\n", c.rig.pitches);
}

bool rig_has(const Case& c, std::string_view target_name) {
  if (!c.rig.stl || !target_name.starts_with("rig.")) return true;
  return target_name == "rig.rpm" || target_name == "rig.fill" || target_name == "rig.fill_mass";
}

double fill_depth(const Case& c) {
  const Derived d = derive(c);
  const Rig& rig = c.rig;
  const double volume = static_cast<double>(d.spheres) * std::pow(c.material.diameter, 3);
  if (!rig.stl) return volume / (rig.pitches * rig.pitch * 2.0 * rig.trough_radius);
  const Vec3 size = rig.stl->high - rig.stl->low, down = rig.stl->down;
  const double height = std::abs(down.x) * size.x + std::abs(down.y) * size.y + std::abs(down.z) * size.z;
  const double box = size.x * size.y * size.z;
  return box > 0.0 ? volume * height / box : 0.0;
}

}  // namespace dem
