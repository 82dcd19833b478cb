#include "dem/forecast/effort.hpp"

#include <algorithm>
#include <ctime>
#include <numbers>

#include "data/random.hpp"
#include "dem/case/grains.hpp"
#include "dem/rig/rig.hpp"
#include "dem/walls/surface.hpp"

namespace dem {
namespace {

double thread_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Layers of spheres of the mean size, each of which overlaps its four neighbours by a hundredth, in a periodic box:
/// those that nothing attracts would part in any other, and cost less than a bed does. They start at speeds up to that
/// of a fall through one diameter.
Setup lattice(const Case& c, const Derived& d) {
  constexpr int side = 12;
  const double size = d.diameter, step = size * (1.0 - 1e-2), up = 1.05 * size;
  Setup s;
  s.high = {side * step, side * step, side * up};
  s.periodic = {true, true, true};
  data::RandomStream random(1, data::Purpose::packing, 3);
  const double speed = std::sqrt(2.0 * c.run.gravity * size);
  for (int k = 0; k < side * side * side; ++k) {
    const int x = k / (side * side), y = k / side % side, z = k % side;
    s.spheres.position.push_back({(x + 0.5) * step, (y + 0.5) * step, (z + 0.5) * up});
    s.spheres.velocity.push_back(speed *
                                 Vec3{random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)});
    if (d.bed.equal_radius > 0.0) continue;
    s.spheres.radius.push_back(0.5 * size);
    s.spheres.density.push_back(d.mass / (std::numbers::pi / 6.0 * size * size * size));
    s.spheres.material.push_back(0);
  }
  if (d.bed.equal_radius > 0.0) {
    s.spheres.radius = {d.bed.equal_radius};
    s.spheres.density = {components_of(c)[0].material.density};
  }
  s.laws = make_force_pass(d.bed);
  s.gravity = {};
  s.time_step = d.time_step;
  s.skin = d.skin;
  return s;
}

double area_of(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const auto& t : mesh.triangles)
    area += 0.5 * length(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]));
  return area;
}

double bytes_of(const Surface& s) {
  const auto bytes = [](const auto& rows) { return static_cast<double>(rows.capacity() * sizeof rows[0]); };
  return bytes(s.faces) + bytes(s.edges) + bytes(s.vertices) + bytes(s.inward) + bytes(s.spokes) + bytes(s.first) +
         bytes(s.features);
}

/// Time [s] to find the features in question of one sphere that lies on the mesh.
double time_to_list(const TriangleMesh& mesh, const Surface& surface, double radius, double reach) {
  constexpr std::size_t most = 400;
  const std::size_t every = mesh.triangles.size() / most + 1;
  std::vector<NearFeature> found;
  std::size_t asked = 0;
  const double start = thread_time();
  for (std::size_t t = 0; t < mesh.triangles.size(); t += every, ++asked)
    find_features(surface, mesh.vertices[mesh.triangles[t][0]] + radius * surface.faces[t].normal, reach, found);
  return (thread_time() - start) / static_cast<double>(asked);
}

/// Adds what the meshes cost that are too fine to be neglected.
void add_meshes(const Case& c, const Derived& d, Effort& effort) {
  constexpr std::size_t fine = 5000;             // triangles
  constexpr double bytes_of_a_triangle = 600.0;  // the mesh as it was read, and the tables that its edges are found by
  const double radius = 0.5 * d.diameter, reach = 0.5 * d.largest + d.skin;
  // Lists are made again when two spheres may have come nearer by the skin.
  const double interval = std::max(1.0, 0.5 * d.skin / (std::max(tool_speed(c), 1e-3) * d.time_step));
  for (const RigMesh& m : c.rig.stl->meshes) {
    if (m.mesh.triangles.size() < fine) continue;
    const Surface surface = make_surface(m.mesh, reach);
    const double at_wall = 0.5 * std::min(static_cast<double>(d.spheres), area_of(m.mesh) / (d.diameter * d.diameter));
    effort.seconds_at_walls += at_wall * time_to_list(m.mesh, surface, radius, reach) / interval;
    effort.bytes_of_meshes += bytes_of(surface) + bytes_of_a_triangle * static_cast<double>(m.mesh.triangles.size());
  }
}

}  // namespace

Effort measure_effort(const Case& c, const Derived& d) {
  Simulation simulation(lattice(c, d));
  for (int k = 0; k < 20; ++k) simulation.step();
  const double start = thread_time();
  double steps = 0.0, passed = 0.0;
  while (passed < 0.1 && steps < 20000.0) {
    for (int k = 0; k < 10; ++k) simulation.step();
    steps += 10.0;
    passed = thread_time() - start;
  }
  Effort effort{.rate = steps * static_cast<double>(simulation.state().particles()) / passed,
                .bytes_per_sphere = simulation.bytes_per_particle()};
  if (c.rig.stl) add_meshes(c, d, effort);
  return effort;
}

}  // namespace dem
