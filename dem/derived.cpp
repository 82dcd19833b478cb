#include "dem/derived.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dem {
namespace {

constexpr double pi = std::numbers::pi;

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

BedCoefficients make_bed(const Case& c, std::size_t bodies) {
  const Derived d = derive(c);
  const Contact& k = c.contact;
  PairCoefficients grain;
  grain.stiffness = k.stiffness;
  const double flexible = (1.0 - k.poisson_ratio * k.poisson_ratio) / k.young_modulus;
  const double shearing = 2.0 * (2.0 - k.poisson_ratio) * (1.0 + k.poisson_ratio) / k.young_modulus;
  grain.young_modulus = 1.0 / (2.0 * flexible);
  grain.shear_modulus = 1.0 / (2.0 * shearing);
  grain.damping_ratio = damping_ratio(k.restitution);
  grain.tension = k.tension == DashpotTension::allowed;
  grain.tangential_stiffness = k.tangential_ratio * k.stiffness;
  grain.tangential_damping = k.tangential_damping;
  grain.friction = k.friction;
  grain.cap_weight = k.cap == FrictionCap::net ? -1.0 : k.cap == FrictionCap::repulsion ? 0.0 : 1.0;
  grain.rolling_friction = k.rolling_friction;
  grain.twisting_friction = k.twisting_friction;
  grain.rolling_damping = k.rolling_damping;
  grain.adhesion = k.work_of_adhesion;
  PairCoefficients wall = grain;
  const double wall_modulus = k.wall_young_modulus.value_or(k.young_modulus);
  wall.young_modulus = 1.0 / (flexible * (1.0 + k.young_modulus / wall_modulus));
  wall.shear_modulus = 1.0 / (shearing * (1.0 + k.young_modulus / wall_modulus));
  wall.stiffness = d.wall_stiffness;
  wall.tangential_stiffness = k.tangential_ratio * d.wall_stiffness;
  wall.damping_ratio = damping_ratio(k.wall_restitution.value_or(k.restitution));
  wall.friction = d.wall_friction;
  wall.rolling_friction = k.wall_rolling_friction.value_or(k.rolling_friction);
  wall.adhesion = k.wall_work_of_adhesion.value_or(k.work_of_adhesion);

  const double radius = 0.5 * c.material.diameter;
  const bool hertzian = k.normal != NormalLaw::linear;
  for (auto [pair, reduced] : {std::pair{&grain, 0.5 * radius}, std::pair{&wall, radius}}) {
    // The tangent of the Hertz law at an overlap of 1 % of the radius.
    const double normal = hertzian ? 2.0 * pair->young_modulus * std::sqrt(reduced * 0.01 * radius) : pair->stiffness;
    pair->rolling_stiffness = k.rolling_stiffness_ratio * normal;
    if (k.cohesion == Cohesion::dmt) {
      pair->pull_off = 2.0 * pi * pair->adhesion;
    } else {
      pair->pull_off = (pair == &grain ? d.pull_off : d.wall_pull_off) / reduced;
      pair->minimum_separation = k.minimum_separation;
      pair->cut_off = k.cut_off;
    }
    if (k.true_stiffness) pair->pull_off *= std::sqrt(pair->stiffness / *k.true_stiffness);
  }

  BedCoefficients bed;
  bed.choice.normal = k.normal;
  bed.choice.tangential = k.tangential.value_or(hertzian ? TangentialLaw::mindlin : TangentialLaw::linear);
  bed.choice.resistance = k.resistance;
  const bool attracts = k.normal != NormalLaw::jkr && (grain.pull_off > 0.0 || wall.pull_off > 0.0);
  bed.choice.attraction = attracts ? AttractionLaw::short_range : AttractionLaw::none;
  bed.grain = {grain};
  bed.wall.assign(bodies, wall);
  bed.equal_mass = d.mass;
  bed.equal_radius = radius;
  return bed;
}

}  // namespace dem
