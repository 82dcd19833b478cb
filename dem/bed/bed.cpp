// The table of coefficients of a bed, one entry per pair of materials and per material and body.
//
// Pairs of one material and walls take the [contact] of the case, and so do unlike materials, but for the elastic
// moduli, which combine as sums over both materials:
//   1/E* = sum of (1 - nu^2)/E,   1/G* = sum of 2 (2 - nu)(1 + nu)/E.
// Entries of case.pairs override all of this.
//
// Grains softer than the real ones attract less by (E / E_true)^(2/5), E_true = contact.true_young_modulus of every
// grain. E is the modulus of a pair of two alike that is as stiff as this one:
//   E = (q_1 + q_2) / (q_1 / E_1 + q_2 / E_2), q = 1 - nu^2,
// the same in either order. A wall that is of no component is taken to be softened as the grain that it meets.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/bed/derived.hpp"
#include "dem/case/coefficients.hpp"
#include "dem/case/grains.hpp"

namespace dem {
namespace {

using std::numbers::pi;

/// Young's modulus of two alike that are as stiff as these two are together [Pa].
double pair_modulus(const Elastic& a, const Elastic& b) {
  if (a.softened == b.softened) return a.softened;
  const double one = 1.0 - a.poisson_ratio * a.poisson_ratio, other = 1.0 - b.poisson_ratio * b.poisson_ratio;
  return (one + other) / (one / a.softened + other / b.softened);
}

bool is(const BodyLabel& body, const std::string& name) {
  return name == "wall" || name == body.material || name == body.name;
}

/// All that the case's pairs state about a contact; later pairs win.
PairContact own(const Case& c, const auto& concerns) {
  PairContact all;
  for (const PairContact& p : c.pairs) {
    if (!concerns(p)) continue;
    for (const PairKey& key : pair_keys)
      if (p.*key.field) all.*key.field = p.*key.field;
  }
  return all;
}

/// Common properties of contacts with spheres and with walls.
struct Meets {
  Elastic first, second;
  double radius;        ///< m, reduced, of mean spheres
  double grain_radius;  ///< m, of the smaller mean sphere
  double weight;        ///< N, of the lighter
  bool wall;
};

PairCoefficients coefficients(const Case& c, const PairContact& its, const Meets& m) {
  const Contact& k = c.contact;
  const bool hertzian = k.normal != NormalLaw::linear;
  const auto choose = [&](const std::optional<double>& pair, const std::optional<double>& of_wall, double usual) {
    return pair.value_or(m.wall ? of_wall.value_or(usual) : usual);
  };
  PairCoefficients p;
  p.stiffness = choose(its.stiffness, k.wall_stiffness, k.stiffness);
  p.young_modulus = 1.0 / (m.first.flexible() + m.second.flexible());
  p.shear_modulus = 1.0 / (m.first.shearing() + m.second.shearing());
  p.damping_ratio = damping_ratio(choose(its.restitution, k.wall_restitution, k.restitution));
  p.tension = k.tension == DashpotTension::allowed;
  p.tangential_stiffness = k.tangential_ratio * p.stiffness;
  p.tangential_damping = k.tangential_damping;
  p.friction = choose(its.friction, k.wall_friction, k.friction);
  p.cap_weight = k.cap == FrictionCap::net ? -1.0 : k.cap == FrictionCap::repulsion ? 0.0 : 1.0;
  p.rolling_friction = choose(its.rolling_friction, k.wall_rolling_friction, k.rolling_friction);
  p.twisting_friction = its.twisting_friction.value_or(k.twisting_friction);
  p.rolling_damping = k.rolling_damping;
  // For the Hertz law the normal stiffness is the tangent at an overlap of 1 % of the radius.
  const double normal = hertzian ? 2.0 * p.young_modulus * std::sqrt(m.radius * 0.01 * m.grain_radius) : p.stiffness;
  p.rolling_stiffness = k.rolling_stiffness_ratio * normal;

  double scaling = 1.0;
  if (!hertzian && k.true_stiffness) scaling = std::sqrt(p.stiffness / *k.true_stiffness);
  if (hertzian && k.true_young_modulus)
    scaling = std::pow(pair_modulus(m.first, m.second) / *k.true_young_modulus, 0.4);
  p.adhesion = scaling * choose(its.work_of_adhesion, k.wall_work_of_adhesion, k.work_of_adhesion);
  if (k.normal == NormalLaw::jkr) {
    // The law knows no contact without adhesion: one that a sphere's weight exceeds a million times stands for it.
    p.adhesion = std::max(p.adhesion, 1e-6 * m.weight / (1.5 * pi * m.radius));
  } else if (k.cohesion == Cohesion::dmt) {
    p.pull_off = 2.0 * pi * p.adhesion;
  } else {
    const double h = k.minimum_separation;
    // L of mean spheres, 4 R* or 2 R* between them; at a wall eq. (1) is used with the L of the sphere, or twice that.
    const double length = (m.wall ? 1.0 : 2.0) * (k.length_scale == LengthScale::diameter ? 2.0 : 1.0) * m.radius;
    const double twice = m.wall && k.wall_attraction == WallAttraction::derjaguin ? 2.0 : 1.0;
    const double hamaker = hamaker_in_use(c, choose(its.hamaker, k.wall_hamaker, k.hamaker));
    p.pull_off = scaling * twice * hamaker * (length / (12.0 * h * h)) / m.radius;
    p.minimum_separation = h;
    p.cut_off = k.cut_off;
  }
  return p;
}

}  // namespace

Elastic elastic(const Case& c, const Material& m) {
  const double modulus = m.young_modulus.value_or(c.contact.young_modulus);
  return {modulus, m.poisson_ratio.value_or(c.contact.poisson_ratio), modulus};
}

Elastic elastic(const Case& c, const Material& grain, const BodyLabel& body) {
  for (const Component& k : c.components) {
    if (k.material.name == body.material) return elastic(c, k.material);
  }
  const Elastic as_grain = elastic(c, grain);
  return {c.contact.wall_young_modulus.value_or(as_grain.young_modulus), as_grain.poisson_ratio, as_grain.softened};
}

double damping_ratio(double restitution) {
  const double l = std::log(restitution);
  return -l / std::sqrt(pi * pi + l * l);
}

double hamaker_in_use(const Case& c, double given) {
  const bool original = c.contact.hamaker_of == HamakerOf::original;
  return original ? std::pow(c.material.coarse_graining, c.contact.hamaker_power) * given : given;
}

BedCoefficients make_bed(const Case& c, const std::vector<BodyLabel>& bodies) {
  const std::vector<Component> parts = components_of(c);
  BedCoefficients bed;
  bed.materials = static_cast<int>(parts.size());
  const auto radius = [](const Material& m) { return 0.5 * mean_diameter(m); };
  const auto weight = [&](const Material& m) {
    return m.density * pi / 6.0 * std::pow(mean_diameter(m), 3) * c.run.gravity;
  };
  for (const Component& a : parts) {
    const Material& one = a.material;
    for (const Component& b : parts) {
      const Material& other = b.material;
      const auto concerns = [&](const PairContact& p) {
        return (p.first == one.name && p.second == other.name) || (p.second == one.name && p.first == other.name);
      };
      const double ra = radius(one), rb = radius(other);
      const double reduced = reduced_value(ra, rb);
      bed.grain.push_back(coefficients(c, own(c, concerns),
                                       {elastic(c, one), elastic(c, other), reduced, std::min(ra, rb),
                                        std::min(weight(one), weight(other)), false}));
    }
    for (const BodyLabel& body : bodies) {
      const auto concerns = [&](const PairContact& p) {
        return (p.first == one.name && is(body, p.second)) || (p.second == one.name && is(body, p.first));
      };
      bed.wall.push_back(coefficients(
          c, own(c, concerns), {elastic(c, one), elastic(c, one, body), radius(one), radius(one), weight(one), true}));
    }
  }
  bed.choice.normal = c.contact.normal;
  bed.choice.tangential = c.contact.tangential_law();
  bed.choice.resistance = c.contact.resistance;
  const auto pulls = [](const PairCoefficients& p) { return p.pull_off > 0.0; };
  const bool attracts =
      std::any_of(bed.grain.begin(), bed.grain.end(), pulls) || std::any_of(bed.wall.begin(), bed.wall.end(), pulls);
  bed.choice.attraction = attracts ? AttractionLaw::short_range : AttractionLaw::none;
  const BedSummary spheres = summarise_bed(c);
  if (spheres.equal) {
    bed.equal_mass = spheres.classes[0].mean_mass;
    bed.equal_radius = 0.5 * spheres.classes[0].diameter;
  }
  return bed;
}

BedCoefficients make_bed(const Case& c, std::size_t bodies) {
  return make_bed(c, std::vector<BodyLabel>(bodies, BodyLabel{"", "wall"}));
}

}  // namespace dem
