#include "dem/rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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
  s.spheres.radius = std::move(rig.grains.radius);
  s.spheres.density = std::move(rig.grains.density);
  s.spheres.material = std::move(rig.grains.material);
  s.spheres.position = std::move(rig.position);
  s.spheres.velocity = std::move(rig.velocity);
  s.spheres.frozen = std::move(rig.frozen);
  s.bodies = std::move(rig.bodies);
  s.laws = make_force_pass(d.bed);
  s.gravity = c.run.gravity * rig.down;
  s.time_step = d.time_step;
  s.skin = d.skin;
  s.overlap_limit = c.run.overlap_limit;
  s.rest_steps = rest_steps;
  s.threads = threads;
  return s;
}

std::vector<data::Problem> rig_problems(const Case& c) { return c.rig.stl ? stl_rig_problems(c) : slice_problems(c); }

std::string rig_settings(const Case& c) {
  return c.rig.stl ? stl_rig_settings(*c.rig.stl) : fmt::format("rig.pitches = {}\n", c.rig.pitches);
}

std::vector<BodyLabel> body_labels(const Case& c) {
  if (!c.rig.stl) return {{"mixer", "wall"}, {"trough", "wall"}};
  std::vector<BodyLabel> labels;
  for (const RigMesh& m : c.rig.stl->meshes) labels.push_back({m.name, m.material});
  return labels;
}

std::vector<std::string> body_names(const Case& c) {
  std::vector<std::string> names{"wall"};
  for (const BodyLabel& b : body_labels(c)) {
    for (const std::string& name : {b.name, b.material})
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

double tool_speed(const Case& c) {
  return c.rig.stl ? mesh_speed(*c.rig.stl, c.rig.angular_velocity)
                   : std::abs(c.rig.angular_velocity) * c.rig.blade_radius;
}

double fill_depth(const Case& c) {
  const Rig& rig = c.rig;
  const double volume = summarise_bed(c).volume * 6.0 / std::numbers::pi;
  if (!rig.stl) return volume / (rig.pitches * rig.pitch * 2.0 * rig.trough_radius);
  const Vec3 size = rig.stl->high - rig.stl->low, down = rig.stl->down;
  const double height = std::abs(down.x) * size.x + std::abs(down.y) * size.y + std::abs(down.z) * size.z;
  const double box = size.x * size.y * size.z;
  return box > 0.0 ? volume * height / box : 0.0;
}

}  // namespace dem
