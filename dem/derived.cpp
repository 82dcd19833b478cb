#include "dem/derived.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dem {
namespace {

constexpr double pi = std::numbers::pi;

template <bool Clamped, class Attraction>
LinearLaw<Clamped, Attraction> make_law(const Contact& c, double stiffness, double friction, double reduced_mass,
                                        Attraction attraction) {
  LinearLaw<Clamped, Attraction> law;
  const double damping = 2.0 * damping_ratio(c.restitution) * std::sqrt(stiffness * reduced_mass);
  law.normal = {stiffness, damping};
  law.tangential = {c.tangential_ratio * stiffness, c.tangential_damping * damping, friction};
  law.attraction = attraction;
  law.cap_weight = c.cap == FrictionCap::net ? -1.0 : c.cap == FrictionCap::repulsion ? 0.0 : 1.0;
  return law;
}

template <class Attraction>
Laws make_pair(const Case& c, const Derived& d, Attraction grain, Attraction wall) {
  const Contact& k = c.contact;
  if (k.tension == DashpotTension::clamped) {
    return {make_law<true>(k, k.stiffness, k.friction, 0.5 * d.mass, grain),
            make_law<true>(k, d.wall_stiffness, d.wall_friction, d.mass, wall)};
  }
  return {make_law<false>(k, k.stiffness, k.friction, 0.5 * d.mass, grain),
          make_law<false>(k, d.wall_stiffness, d.wall_friction, d.mass, wall)};
}

double wall_factor(const Contact& k) { return k.wall_attraction == WallAttraction::derjaguin ? 2.0 : 1.0; }

}  // namespace

double damping_ratio(double restitution) {
  const double l = std::log(restitution);
  return -l / std::sqrt(pi * pi + l * l);
}

Derived derive(const Case& c) {
  const Contact& k = c.contact;
  Derived d;
  const double size = c.material.diameter;
  d.mass = c.material.density * pi / 6.0 * size * size * size;
  const double spheres = c.rig.fill_mass ? *c.rig.fill_mass / d.mass : c.rig.fill;
  d.spheres = spheres > 0.0 ? static_cast<std::size_t>(std::llround(spheres)) : 0;
  d.weight = d.mass * c.run.gravity;
  d.length_scale = k.length_scale == LengthScale::diameter ? size : 0.5 * size;
  d.wall_friction = k.wall_friction.value_or(k.friction);
  d.wall_stiffness = k.wall_stiffness.value_or(k.stiffness);
  const double l3 = std::pow(c.material.coarse_graining, 3);
  const double given_is = k.hamaker_of == HamakerOf::original ? l3 : 1.0;
  d.hamaker = given_is * k.hamaker;
  d.wall_hamaker = given_is * k.wall_hamaker.value_or(k.hamaker);
  d.original_hamaker = d.hamaker / l3;
  const double per_hamaker = d.length_scale / (12.0 * k.minimum_separation * k.minimum_separation);
  d.pull_off = d.hamaker * per_hamaker;
  d.wall_pull_off = wall_factor(k) * d.wall_hamaker * per_hamaker;
  d.bond = d.pull_off / d.weight;
  d.wall_bond = d.wall_pull_off / d.weight;
  d.damping_ratio = damping_ratio(k.restitution);
  const double damped = std::sqrt(1.0 - d.damping_ratio * d.damping_ratio);
  const double frequency = std::max(std::sqrt(2.0 * k.stiffness / d.mass), std::sqrt(d.wall_stiffness / d.mass));
  d.contact_duration = pi / (frequency * damped);
  d.time_step = d.contact_duration / c.run.steps_per_contact;
  d.skin = c.run.skin * size;
  return d;
}

Laws make_laws(const Case& c) {
  const Derived d = derive(c);
  const Contact& k = c.contact;
  if (d.hamaker == 0.0 && d.wall_hamaker == 0.0) return make_pair(c, d, NoAttraction{}, NoAttraction{});
  const auto part = [&](double hamaker) {
    return VanDerWaals{hamaker * d.length_scale / 12.0, k.minimum_separation, k.cut_off};
  };
  return make_pair(c, d, part(d.hamaker), part(wall_factor(k) * d.wall_hamaker));
}

}  // namespace dem
