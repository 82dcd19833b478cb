#include "dem/derived.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/grains.hpp"

namespace dem {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double rayleigh_times = 6.0;

double sphere_mass(const Material& m, double diameter) { return m.density * pi / 6.0 * diameter * diameter * diameter; }

/// Two spheres, or a sphere and a wall.
struct Masses {
  double mass, radius;  ///< kg, m, reduced
};
Masses reduced(const Material& a, double diameter_a, const Material* b, double diameter_b) {
  const double ma = sphere_mass(a, diameter_a), ra = 0.5 * diameter_a;
  if (b == nullptr) return {ma, ra};
  const double mb = sphere_mass(*b, diameter_b), rb = 0.5 * diameter_b;
  return {ma * mb / (ma + mb), ra * rb / (ra + rb)};
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

struct Duration {
  double time = std::numeric_limits<double>::infinity();  ///< s
  std::string of;
};
void shorten(Duration& d, double time, std::string of) {
  if (time < d.time) d = {time, std::move(of)};
}

Duration contact_duration(const ContactKind& kind, const Contact& contact, Masses lightest, double speed) {
  const PairCoefficients& law = kind.law;
  const double damped = std::sqrt(1.0 - law.damping_ratio * law.damping_ratio);
  Duration d;
  if (contact.normal == NormalLaw::linear) {
    shorten(d, pi / (std::sqrt(law.stiffness / lightest.mass) * damped), "the spring-dashpot");
    return d;
  }
  const double e = law.young_modulus, r = std::sqrt(lightest.radius);
  if (speed > 0.0) {
    const double overlap = std::pow(15.0 * lightest.mass * speed * speed / (16.0 * e * r), 0.4);
    const double factor = 2.0 * std::sqrt(pi) * std::tgamma(1.4) / std::tgamma(0.9);
    shorten(d, factor * overlap / speed, fmt::format("an impact at {:.3g} m/s", speed));
  }
  const double pressed = pressing(kind.load, pull_off(law, contact.normal, lightest.radius), contact.normal);
  const double a = std::sqrt(lightest.radius * overlap_under(pressed, law, contact.normal, lightest.radius));
  if (a > 0.0) shorten(d, pi * std::sqrt(lightest.mass / (2.0 * e * a)), "half a swing of a contact under the fill");
  return d;
}

/// Of the sphere of this material with the shortest.
double rayleigh_time(const Case& c, const Material& m) {
  const double nu = m.poisson_ratio.value_or(c.contact.poisson_ratio);
  const double shear = m.young_modulus.value_or(c.contact.young_modulus) / (2.0 * (1.0 + nu));
  return pi * 0.5 * smallest_diameter(m) * std::sqrt(m.density / shear) / (0.1631 * nu + 0.8766);
}

/// What the rig does to every kind of contact.
struct Conditions {
  double depth = 0.0;  ///< m, of the fill
  double speed = 0.0;  ///< m/s, highest of impacts
};
Conditions conditions_of(const Case& c) {
  const double depth = fill_depth(c);
  return {depth, std::max(tool_speed(c), std::sqrt(2.0 * c.run.gravity * depth))};
}

/// Pull-off, load at rest and duration of one kind of contact, between a and b or a wall.
ContactKind complete(ContactKind kind, const Case& c, const Conditions& rig, const Material& a, const Material* b) {
  const NormalLaw normal = c.contact.normal;
  const double da = mean_diameter(a), db = b == nullptr ? 0.0 : mean_diameter(*b);
  const Masses mean = reduced(a, da, b, db);
  const Masses lightest = reduced(a, smallest_diameter(a), b, b == nullptr ? 0.0 : smallest_diameter(*b));
  kind.mass = mean.mass;
  kind.radius = mean.radius;
  kind.pull_off = pull_off(kind.law, normal, mean.radius);
  const double lighter = b == nullptr ? sphere_mass(a, da) : std::min(sphere_mass(a, da), sphere_mass(*b, db));
  kind.bond = kind.pull_off / (lighter * c.run.gravity);
  const double size = b == nullptr ? da : std::min(da, db);
  kind.load = sphere_mass(a, da) * c.run.gravity * rig.depth / da;
  kind.rest_overlap =
      overlap_under(pressing(kind.load, kind.pull_off, normal), kind.law, normal, mean.radius) / (0.5 * size);
  Duration d = contact_duration(kind, c.contact, lightest, rig.speed);
  if (normal != NormalLaw::linear) {
    for (const Material* m : {&a, b}) {
      if (m != nullptr) shorten(d, rayleigh_times * rayleigh_time(c, *m), "six Rayleigh times of the smallest sphere");
    }
  }
  kind.duration = d.time;
  kind.duration_of = d.of;
  return kind;
}

std::vector<ContactKind> contact_kinds(const Case& c, const Conditions& rig) {
  const std::vector<Component> parts = components_of(c);
  const std::vector<BodyLabel> bodies = body_labels(c);
  const BedCoefficients bed = make_bed(c, bodies);
  std::vector<ContactKind> kinds;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Material& a = parts[i].material;
    const auto add = [&](const std::string& partner, const PairCoefficients& law, const Material* b) {
      ContactKind kind;
      kind.first = a.name;
      kind.second = partner;
      kind.wall = b == nullptr;
      kind.law = law;
      kinds.push_back(complete(std::move(kind), c, rig, a, b));
    };
    for (std::size_t j = i; j < parts.size(); ++j)
      add(parts[j].material.name, bed.grain[i * parts.size() + j], &parts[j].material);
    for (std::size_t b = 0; b < bodies.size(); ++b) add(bodies[b].name, bed.wall[i * bodies.size() + b], nullptr);
  }
  return kinds;
}

}  // namespace

Derived derive(const Case& c) {
  const Contact& k = c.contact;
  const BedSummary bed = summarise_bed(c);
  Derived d;
  d.spheres = bed.spheres;
  d.smallest = bed.smallest;
  d.largest = bed.largest;
  d.mass = bed.equal ? bed.classes[0].mean_mass : bed.mass / static_cast<double>(std::max<std::size_t>(1, bed.spheres));
  d.weight = d.mass * c.run.gravity;
  d.diameter = bed.equal
                   ? bed.largest
                   : std::cbrt(6.0 / pi * bed.volume / static_cast<double>(std::max<std::size_t>(1, bed.spheres)));
  d.length_scale = k.length_scale == LengthScale::diameter ? d.diameter : 0.5 * d.diameter;
  d.hamaker = hamaker_in_use(c, k.hamaker);
  d.wall_hamaker = hamaker_in_use(c, k.wall_hamaker.value_or(k.hamaker));
  d.original_hamaker = d.hamaker / std::pow(c.material.coarse_graining, 3);
  const Conditions rig = conditions_of(c);
  d.impact_speed = rig.speed;
  d.kinds = contact_kinds(c, rig);
  d.damping_ratio = d.kinds[0].law.damping_ratio;
  d.pull_off = d.kinds[0].pull_off;
  d.bond = d.kinds[0].bond;
  d.contact_duration = std::numeric_limits<double>::infinity();
  bool walled = false;
  for (const ContactKind& kind : d.kinds) {
    if (kind.wall && !walled) {
      d.wall_pull_off = kind.pull_off;
      d.wall_bond = kind.bond;
      walled = true;
    }
    if (!(kind.duration < d.contact_duration)) continue;
    d.contact_duration = kind.duration;
    d.duration_of = fmt::format("{}, {} with {}", kind.duration_of, kind.first, kind.second);
  }
  d.time_step = c.run.time_step.value_or(d.contact_duration / c.run.steps_per_contact);
  d.skin = c.run.skin * d.diameter;
  return d;
}

std::vector<std::string> describe(const Case& c, const Derived& d) {
  const Contact& k = c.contact;
  std::vector<std::string> lines;
  if (d.smallest < d.largest) {
    lines.push_back(fmt::format("{} spheres of {:.4g} to {:.4g} mm, {:.4g} g", d.spheres, 1e3 * d.smallest,
                                1e3 * d.largest, 1e3 * d.mass * static_cast<double>(d.spheres)));
  } else {
    lines.push_back(fmt::format("{} spheres of {:.4g} mm, {:.4g} g", d.spheres, 1e3 * d.diameter,
                                1e3 * d.mass * static_cast<double>(d.spheres)));
  }
  for (const ContactKind& kind : d.kinds) {
    lines.push_back(fmt::format(
        "{} with {}: pull-off {:.3g} N, Bond number {:.3g}, damping ratio {:.3g}, contact "
        "duration {:.3g} s, overlap at rest at most {:.2g} of a radius",
        kind.first, kind.second, kind.pull_off, kind.bond, kind.law.damping_ratio, kind.duration, kind.rest_overlap));
  }
  const bool attracts =
      std::any_of(d.kinds.begin(), d.kinds.end(), [](const ContactKind& kind) { return kind.law.pull_off > 0.0; });
  if (attracts && k.cohesion == Cohesion::van_der_waals) {
    lines.push_back(
        fmt::format("van der Waals: H* {:.4g} J in use, H {:.4g} J on the original grains (coarse graining {:g}), L = "
                    "the {} ({:.4g} mm), minimum separation {:.3g} nm, cut-off {:.3g} nm",
                    d.hamaker, d.original_hamaker, c.material.coarse_graining,
                    k.length_scale == LengthScale::diameter ? "diameter" : "radius", 1e3 * d.length_scale,
                    1e9 * k.minimum_separation, 1e9 * k.cut_off));
  }
  lines.push_back(fmt::format("time step {:.4g} s, {:.3g} in the shortest contact, {:.4g} s: {}", d.time_step,
                              d.contact_duration / d.time_step, d.contact_duration, d.duration_of));
  return lines;
}

}  // namespace dem
