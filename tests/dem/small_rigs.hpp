#pragma once
// Rigs of a few hundred to two thousand spheres, so that seconds are enough, and how they are brought to turn steadily.
#include <cmath>
#include <utility>
#include <vector>

#include "dem/bed/derived.hpp"
#include "dem/bed/setup.hpp"
#include "dem/engine/simulation.hpp"
#include "dem/rig/rig.hpp"

namespace scene {

/// A third of the mass of each diameter (m).
inline std::vector<dem::SizeShare> thirds(double small, double medium, double large) {
  return {{small, 1.0 / 3.0}, {medium, 1.0 / 3.0}, {large, 1.0 / 3.0}};
}

/// 20 mm wide and 6 mm long, two fifths full of a few hundred spheres of three sizes, at 60 rpm.
inline dem::Case small_drum(dem::EndPlates end_plates = dem::EndPlates::turning) {
  dem::Case c;
  c.rig.drum = dem::Drum{.radius = 10e-3, .length = 6e-3, .end_plates = end_plates};
  c.rig.level = 0.4;
  c.rig.angular_velocity = 2.0 * M_PI;
  c.material.density = 2500.0;
  c.material.sizes = thirds(1.1e-3, 1.2e-3, 1.3e-3);
  c.contact.stiffness = 200.0;
  c.contact.friction = 0.5;
  c.run.settle = 0.05;
  c.run.steps_per_contact = 15.0;
  return c;
}

/// The drum's run to a mean of steady flow: half a second of start-up, then one to `longest` seconds.
inline dem::Case steady(dem::Case drum, double longest) {
  drum.run.start_up = 0.5;
  drum.run.start_up_turns = 0.5;
  drum.run.shortest = 1.0;
  drum.run.shortest_turns = 1.0;
  drum.run.longest = longest;
  drum.run.standard_error = 0.05;
  return drum;
}

/// A case's rig that has settled at rest and then turned for `start_up` seconds.
struct Turning {
  Turning(const dem::Case& c, std::uint64_t seed, double start_up) : Turning(c, dem::build_rig(c, seed), start_up) {}

  dem::Sensor sensor;
  double time_step;  ///< s
  dem::Simulation simulation;

 private:
  Turning(const dem::Case& c, dem::BuiltRig rig, double start_up)
      : sensor(rig.sensor),
        time_step(dem::derive(c).time_step),
        simulation(dem::make_setup(c, dem::derive(c), std::move(rig),
                                   static_cast<std::uint64_t>(std::llround(c.run.settle / time_step)), 1)) {
    while (simulation.time() < c.run.settle + start_up) simulation.step();
  }
};

}  // namespace scene
