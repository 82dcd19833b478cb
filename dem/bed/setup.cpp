#include "dem/bed/setup.hpp"

namespace dem {

Setup make_setup(const Case& c, const Derived& d, BuiltRig rig, std::uint64_t rest_steps, int threads) {
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
  s.channels = rig.channels;
  return s;
}

}  // namespace dem
