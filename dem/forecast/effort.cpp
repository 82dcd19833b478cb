#include "dem/forecast/effort.hpp"

#include <ctime>
#include <numbers>

#include "data/random.hpp"
#include "dem/case/grains.hpp"

namespace dem {
namespace {

double thread_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Layers of spheres of the mean size, each of which overlaps its four neighbours by a hundredth, in a periodic box: those that nothing attracts would part in
/// any other, and cost less than a bed does. They start at speeds up to that of a fall through one diameter.
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
  return {steps * static_cast<double>(simulation.state().particles()) / passed, simulation.bytes_per_particle()};
}

}  // namespace dem
