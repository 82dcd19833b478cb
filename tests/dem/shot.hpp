#pragma once
// One collision through the whole Simulation, told as dem::collide tells it, and rows of dem/VERIFICATION.md.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <string>

#include "dem/contact/collision.hpp"
#include "tests/dem/scene.hpp"

namespace scene {

inline dem::Ball ball(double density, double radius) {
  return {density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius, radius, 0, {}, {}};
}

/// The coefficients of a case, for the spheres of an encounter.
inline dem::BedCoefficients bed_for(const dem::Case& c, const dem::Encounter& e) {
  dem::BedCoefficients bed = dem::make_bed(c, 1);
  const bool equal = !e.partner || (e.partner->mass == e.sphere.mass && e.partner->radius == e.sphere.radius);
  bed.equal_mass = equal ? e.sphere.mass : 0.0;
  bed.equal_radius = equal ? e.sphere.radius : 0.0;
  return bed;
}

struct Clock {
  double time_step = 0.0;  ///< s
  double phase = 0.5;      ///< of a step, by which the touch is shifted
};

/// The spheres touch (or the sphere the plane z = 0) with their line of centres along z.
inline dem::Collision shoot(const dem::BedCoefficients& bed, const dem::Encounter& e, Clock clock) {
  const auto laws = dem::make_force_pass(bed);
  const double largest = std::max(e.sphere.radius, e.partner ? e.partner->radius : 0.0);
  const double reach = e.sphere.radius + (e.partner ? e.partner->radius : 0.0), range = laws->range(largest);
  const dem::Vec3 before = e.sphere.velocity - (e.partner ? e.partner->velocity : dem::Vec3{});
  const double gap = range - before.z * clock.time_step * (1.0 + clock.phase), flight = gap / -before.z;
  const auto density = [](const dem::Ball& b) {
    return b.mass / (4.0 / 3.0 * std::numbers::pi * b.radius * b.radius * b.radius);
  };
  dem::Setup s;
  s.low = {-100.0 * largest, -100.0 * largest, -100.0 * largest};
  s.high = {100.0 * largest, 100.0 * largest, 100.0 * largest};
  s.periodic = {false, false, false};
  s.spheres.radius = {e.sphere.radius};
  s.spheres.density = {density(e.sphere)};
  s.spheres.position = {dem::Vec3{0.0, 0.0, reach + gap} - flight * dem::Vec3{before.x, before.y, 0.0}};
  s.spheres.velocity = {e.sphere.velocity};
  s.spheres.spin = {e.sphere.spin};
  if (e.partner) {
    s.spheres.radius.push_back(e.partner->radius);
    s.spheres.density.push_back(density(*e.partner));
    s.spheres.position.push_back({});
    s.spheres.velocity.push_back(e.partner->velocity);
    s.spheres.spin.push_back(e.partner->spin);
  } else {
    s.bodies.push_back(floor(50.0 * largest));
  }
  s.laws = laws;
  s.gravity = {};
  s.time_step = clock.time_step;
  s.skin = 0.1 * std::min(e.sphere.radius, e.partner ? e.partner->radius : largest);
  dem::Simulation sim(std::move(s));

  struct Now {
    double overlap, separating;
  };
  const auto now = [&] {
    const dem::Vec3 x = position_of(sim, 0) - (e.partner ? position_of(sim, 1) : dem::Vec3{});
    const dem::Vec3 v = motion_of(sim, 0).velocity - (e.partner ? motion_of(sim, 1).velocity : dem::Vec3{});
    const dem::Vec3 n = e.partner ? dem::unit(x) : dem::Vec3{0.0, 0.0, 1.0};
    return Now{reach - dot(x, n), dot(v, n)};
  };
  const auto touching = [&] { return sim.sums().contacts + sim.sums().wall_contacts > 0; };
  dem::Collision c;
  const auto longest = static_cast<std::uint64_t>(3000.0 * (range + 1e-3 * largest) / -before.z / clock.time_step) +
                       std::uint64_t{400000};
  while (!touching() && sim.state().step < longest && now().separating < 0.0) sim.step();
  if (!touching()) return c;
  Now here = now();
  const double touched = sim.time() + here.overlap / here.separating;
  while (touching()) {
    c.largest_overlap = std::max(c.largest_overlap, here.overlap);
    c.largest_push = std::max(c.largest_push, sim.state().load[row_of(sim, 0)].force.z);
    const double was = here.separating;
    sim.step();
    here = now();
    if ((was > 0.0 && here.separating <= 0.0) || sim.state().step > longest) {
      c.end = dem::CollisionEnd::sticks;
      return c;
    }
  }
  c.duration = sim.time() + here.overlap / here.separating - touched;
  while (here.overlap > -range) {
    sim.step();
    here = now();
    if (here.separating <= 0.0) {
      c.end = dem::CollisionEnd::sticks;
      return c;
    }
  }
  c.end = dem::CollisionEnd::parted;
  c.restitution = here.separating / -before.z;
  const dem::MotionRow m = motion_of(sim, 0);
  c.velocity = m.velocity;
  c.spin = m.spin;
  if (e.partner) {
    c.partner_velocity = motion_of(sim, 1).velocity;
    c.partner_spin = motion_of(sim, 1).spin;
  }
  return c;
}

struct Phases {
  double mean = 0.0, worst = 0.0;  ///< of the restitution; worst: largest relative miss of the wanted one
};

/// Over 40 phases of the touch within a time step.
inline Phases over_phases(const dem::BedCoefficients& bed, const dem::Encounter& e, double time_step, double wanted) {
  Phases p;
  constexpr int phases = 40;
  for (int k = 0; k < phases; ++k) {
    const double found = shoot(bed, e, {time_step, k / static_cast<double>(phases)}).restitution;
    p.mean += found / phases;
    p.worst = std::max(p.worst, std::abs(found / wanted - 1.0));
  }
  return p;
}

struct Tolerance {
  double relative = 0.0, absolute = 0.0;
};

/// Asserts, and prints a row of dem/VERIFICATION.md where DEMCAL_TABLE is set.
inline void row(const std::string& what, double expected, double got, Tolerance allowed) {
  const double error = got - expected;
  if (std::getenv("DEMCAL_TABLE") != nullptr) {
    const std::string off =
        expected != 0.0 ? fmt::format("{:+.3f} %", 100.0 * error / std::abs(expected)) : fmt::format("{:+.2e}", error);
    fmt::print("| {} | {:.5g} | {:.5g} | {} |\n", what, expected, got, off);
  }
  INFO(what << ": expected " << expected << ", got " << got);
  CHECK(std::abs(error) <= allowed.absolute + allowed.relative * std::abs(expected));
}

}  // namespace scene
