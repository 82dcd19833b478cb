#pragma once
// Small scenes for the tests: a few spheres, a plane of triangles, and a contact law from a Case's coefficients.
#include <xxhash.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "dem/bed/derived.hpp"
#include "dem/bed/setup.hpp"
#include "dem/engine/simulation.hpp"
#include "dem/rig/rig.hpp"
#include "dem/walls/mesh.hpp"

namespace scene {

/// A box without walls, bodies or gravity; laws and time step from the case.
inline dem::Setup box(const dem::Case& c, std::vector<dem::Vec3> position, std::vector<dem::Vec3> velocity) {
  const dem::Derived d = dem::derive(c);
  const double size = 100.0 * c.material.diameter;
  dem::Setup s;
  s.low = {-size, -size, -size};
  s.high = {size, size, size};
  s.periodic = {false, false, false};
  s.spheres.radius = {0.5 * c.material.diameter};
  s.spheres.density = {c.material.density};
  s.spheres.position = std::move(position);
  s.spheres.velocity = std::move(velocity);
  s.laws = dem::make_force_pass(dem::make_bed(c, dem::max_bodies));
  s.gravity = {};
  s.time_step = d.time_step;
  s.skin = 0.1 * c.material.diameter;
  return s;
}

/// The plane z = 0 for |x|, |y| < half, as nx by ny rectangles of two triangles.
inline dem::TriangleMesh plane(double half, int nx, int ny) {
  dem::TriangleMesh mesh;
  for (int i = 0; i <= nx; ++i) {
    for (int j = 0; j <= ny; ++j)
      mesh.vertices.push_back({half * (2.0 * i / nx - 1.0), half * (2.0 * j / ny - 1.0), 0.0});
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (ny + 1) + j); };
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

inline dem::Body floor(double half, int nx = 1, int ny = 1) { return {"floor", plane(half, nx, ny), {}}; }

inline constexpr std::uint64_t at_rest = ~std::uint64_t{0};

/// The case's rig and filling; its bodies move from the first step, or are at rest.
inline dem::Setup rig(const dem::Case& c, std::uint64_t seed, std::uint64_t rest_steps = 0, int threads = 1) {
  return dem::make_setup(c, dem::derive(c), dem::build_rig(c, seed), rest_steps, threads);
}

/// Row of the particle that was given first, second, ...: particles are sorted as they move.
inline std::size_t row_of(const dem::Simulation& s, std::uint32_t id) {
  std::size_t i = 0;
  while (s.state().id[i] != id) ++i;
  return i;
}
inline dem::MotionRow motion_of(const dem::Simulation& s, std::uint32_t id) { return s.motion(row_of(s, id)); }
inline dem::Vec3 position_of(const dem::Simulation& s, std::uint32_t id) {
  return s.state().position[row_of(s, id)].at;
}

/// Of everything that moves: who is where, how fast, and pushed how.
inline std::uint64_t hash(const dem::State& s) {
  std::uint64_t h = XXH3_64bits(s.id.data(), s.id.size() * sizeof s.id[0]);
  const auto add = [&](dem::Vec3 v) {
    const double x[3] = {v.x, v.y, v.z};
    h = XXH3_64bits_withSeed(x, sizeof x, h);
  };
  for (std::size_t i = 0; i < s.id.size(); ++i) {
    add(s.position[i].at);
    add(s.half[i].velocity);
    add(s.half[i].spin);
    add(s.load[i].force);
    add(s.load[i].torque);
  }
  return h;
}

}  // namespace scene
