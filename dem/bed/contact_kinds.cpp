#include "dem/bed/contact_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/bed/derived.hpp"
#include "dem/case/grains.hpp"
#include "dem/rig/rig.hpp"

namespace dem {
namespace {

using std::numbers::pi;
constexpr double rayleigh_times = 6.0;

double sphere_mass(const Material& m, double diameter) { return m.density * pi / 6.0 * diameter * diameter * diameter; }

/// Two spheres, or a sphere and a wall, at rest.
Encounter meeting(const std::vector<Component>& parts, const ContactKind& kind, double (*diameter)(const Material&)) {
  const auto ball = [&](std::size_t index) {
    const Material& m = parts[index].material;
    const double size = diameter(m);
    return Ball{.mass = sphere_mass(m, size), .radius = 0.5 * size, .material = index, .velocity = {}, .spin = {}};
  };
  Encounter e;
  e.sphere = ball(kind.material);
  if (kind.wall)
    e.body = kind.other;
  else
    e.partner = ball(kind.other);
  return e;
}
double reduced_mass(const Encounter& e) {
  return e.partner ? reduced_value(e.sphere.mass, e.partner->mass) : e.sphere.mass;
}
double reduced_radius(const Encounter& e) {
  return e.partner ? reduced_value(e.sphere.radius, e.partner->radius) : e.sphere.radius;
}

double pull_off(const PairCoefficients& law, NormalLaw normal, double radius) {
  return (normal == NormalLaw::jkr ? 1.5 * pi * law.adhesion : law.pull_off) * radius;
}

/// The load that presses a contact as the load and the attraction do together [N]; for JKR see Johnson et al. (1971).
double pressing(double load, double pulled, NormalLaw normal) {
  return normal == NormalLaw::jkr ? load + 2.0 * pulled + 2.0 * std::sqrt(pulled * (pulled + load)) : load + pulled;
}

/// Overlap under a force by the elastic law [m].
double overlap_under(double force, const PairCoefficients& law, NormalLaw normal, double radius) {
  if (normal == NormalLaw::linear) return force / law.stiffness;
  return std::pow(0.75 * force / (law.young_modulus * std::sqrt(radius)), 2.0 / 3.0);
}

/// sqrt(stiffness / mass) of the elastic law at an overlap [rad/s].
double frequency(const PairCoefficients& law, NormalLaw normal, const Encounter& e, double overlap) {
  const double stiffness =
      normal == NormalLaw::linear ? law.stiffness : 2.0 * law.young_modulus * std::sqrt(reduced_radius(e) * overlap);
  return std::sqrt(stiffness / reduced_mass(e));
}

void shorten(ContactKind& kind, double time, const std::string& of) {
  if (!(time < kind.duration)) return;
  kind.duration = time;
  kind.duration_of = of;
}

void shorten_linear(ContactKind& kind, const Encounter& lightest) {
  const double zeta = kind.law.damping_ratio;
  if (zeta < 1.0)
    shorten(kind, pi / (std::sqrt(kind.law.stiffness / reduced_mass(lightest)) * std::sqrt(1.0 - zeta * zeta)),
            "the spring-dashpot");
}

/// The Rayleigh time of the sphere of this material that has the shortest one.
double rayleigh_time(const Case& c, const Material& m) {
  const double nu = m.poisson_ratio.value_or(c.contact.poisson_ratio);
  const double shear = m.young_modulus.value_or(c.contact.young_modulus) / (2.0 * (1.0 + nu));
  return pi * 0.5 * smallest_diameter(m) * std::sqrt(m.density / shear) / (0.1631 * nu + 0.8766);
}

void shorten_hertzian(ContactKind& kind, const Case& c, const Encounter& lightest, double speed) {
  const NormalLaw normal = c.contact.normal;
  const double e = kind.law.young_modulus, mass = reduced_mass(lightest), radius = reduced_radius(lightest);
  if (speed > 0.0) {
    const double overlap = std::pow(15.0 * mass * speed * speed / (16.0 * e * std::sqrt(radius)), 0.4);
    const double factor = 2.0 * std::sqrt(pi) * std::tgamma(1.4) / std::tgamma(0.9);
    shorten(kind, factor * overlap / speed, fmt::format("an impact at {:.3g} m/s", speed));
  }
  const double pressed = pressing(kind.load, pull_off(kind.law, normal, radius), normal);
  if (pressed > 0.0)
    shorten(kind, pi / frequency(kind.law, normal, lightest, overlap_under(pressed, kind.law, normal, radius)),
            "half a swing of a contact under the fill");
}

/// The damping of this kind for restitution_at, and what it asks of the time step.
void find_damping(ContactKind& kind, const Case& c, const std::vector<Component>& parts, BedCoefficients& bed) {
  const double speed = *c.contact.restitution_at;
  const Encounter mean = meeting(parts, kind, mean_diameter);
  kind.found = damping_for({restitution_of(kind.law.damping_ratio), speed}, bed, mean);
  const double zeta = kind.found->damping_ratio.value_or(0.0);
  kind.law.damping_ratio = zeta;
  const auto materials = static_cast<std::size_t>(bed.materials);
  if (kind.wall)
    bed.wall[kind.material * (bed.wall.size() / materials) + kind.other].damping_ratio = zeta;
  else
    bed.grain[kind.material * materials + kind.other].damping_ratio =
        bed.grain[kind.other * materials + kind.material].damping_ratio = zeta;
}

void shorten_by_collision(ContactKind& kind, const Case& c, const Encounter& lightest, const BedCoefficients& bed) {
  Encounter e = lightest;
  e.sphere.velocity.z = -*c.contact.restitution_at;
  const Collision hit = collide(*make_force_pass(bed), e);
  if (hit.end == CollisionEnd::parted)
    shorten(kind, hit.duration, fmt::format("the collision at {:.3g} m/s", *c.contact.restitution_at));
  const double deepest = std::max(hit.largest_overlap, kind.rest_overlap * lightest.sphere.radius);
  shorten(kind, pi / (2.0 * kind.law.damping_ratio * frequency(kind.law, c.contact.normal, lightest, deepest)),
          "the dashpot");
}

/// Pull-off, load at rest, damping and duration of one kind.
void complete(ContactKind& kind, const Case& c, const Conditions& rig, BedCoefficients& bed) {
  const NormalLaw normal = c.contact.normal;
  const std::vector<Component> parts = components_of(c);
  const Encounter mean = meeting(parts, kind, mean_diameter), lightest = meeting(parts, kind, smallest_diameter);
  const Ball& a = mean.sphere;
  const Ball b = mean.partner.value_or(a);
  kind.mass = reduced_mass(mean);
  kind.radius = reduced_radius(mean);
  kind.pull_off = pull_off(kind.law, normal, kind.radius);
  kind.bond = kind.pull_off / (std::min(a.mass, b.mass) * c.run.gravity);
  kind.load = a.mass * c.run.gravity * rig.depth / (2.0 * a.radius);
  kind.rest_overlap = overlap_under(pressing(kind.load, kind.pull_off, normal), kind.law, normal, kind.radius) /
                      std::min(a.radius, b.radius);
  kind.duration = std::numeric_limits<double>::infinity();
  if (c.contact.restitution_at) find_damping(kind, c, parts, bed);
  if (normal == NormalLaw::linear) {
    shorten_linear(kind, lightest);
  } else {
    shorten_hertzian(kind, c, lightest, rig.speed);
    const std::string of = "six Rayleigh times of the smallest sphere";
    shorten(kind, rayleigh_times * rayleigh_time(c, parts[kind.material].material), of);
    if (!kind.wall) shorten(kind, rayleigh_times * rayleigh_time(c, parts[kind.other].material), of);
  }
  if (c.contact.restitution_at) shorten_by_collision(kind, c, lightest, bed);
}

}  // namespace

double restitution_of(double zeta) { return std::exp(-pi * zeta / std::sqrt(1.0 - zeta * zeta)); }

Conditions conditions_of(const Case& c) {
  const double depth = fill_depth(c);
  return {depth, std::max(tool_speed(c), std::sqrt(2.0 * c.run.gravity * depth))};
}

Contacts contacts_of(const Case& c, const Conditions& rig) {
  const std::vector<std::string> grains = grain_names(c);
  const std::vector<BodyLabel> bodies = body_labels(c);
  Contacts all{make_bed(c, bodies), {}};
  const auto add = [&](std::size_t i, std::size_t other, const std::string& second, bool wall) {
    ContactKind kind;
    kind.first = grains[i];
    kind.second = second;
    kind.material = i;
    kind.other = other;
    kind.wall = wall;
    kind.law = wall ? all.bed.wall[i * bodies.size() + other] : all.bed.grain[i * grains.size() + other];
    complete(kind, c, rig, all.bed);
    all.kinds.push_back(std::move(kind));
  };
  for (std::size_t i = 0; i < grains.size(); ++i) {
    for (std::size_t j = i; j < grains.size(); ++j) add(i, j, grains[j], false);
    for (std::size_t b = 0; b < bodies.size(); ++b) add(i, b, bodies[b].name, true);
  }
  return all;
}

}  // namespace dem
