#include "dem/bed/derived.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/case/grains.hpp"

namespace dem {
using std::numbers::pi;

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
  d.original_hamaker = d.hamaker / std::pow(c.material.coarse_graining, k.hamaker_power);
  d.conditions = conditions_of(c);
  Contacts contacts = contacts_of(c, d.conditions);
  d.bed = std::move(contacts.bed);
  d.kinds = std::move(contacts.kinds);
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

namespace {

std::string contact_line(const ContactKind& kind, const std::string& second) {
  return fmt::format(
      "{} with {}: pull-off {:.3g} N, Bond number {:.3g}, damping ratio {:.3g}, contact duration {:.3g} s, overlap at "
      "rest at most {:.2g} of a radius",
      kind.first, second, kind.pull_off, kind.bond, kind.law.damping_ratio, kind.duration, kind.rest_overlap);
}

/// Adds one line for each kind of contact. Bodies that a material meets in the same way share a line.
void add_contacts(const Derived& d, std::vector<std::string>& lines) {
  for (std::size_t k = 0; k < d.kinds.size();) {
    std::string names = d.kinds[k].second;
    std::size_t next = k + 1;
    while (next < d.kinds.size() && d.kinds[k].wall && d.kinds[next].wall &&
           contact_line(d.kinds[k], "") == contact_line(d.kinds[next], "")) {
      names += ", " + d.kinds[next++].second;
    }
    lines.push_back(contact_line(d.kinds[k], names));
    k = next;
  }
}

void add_attraction(const Case& c, const Derived& d, std::vector<std::string>& lines) {
  const Contact& k = c.contact;
  const auto pulls = [](const ContactKind& kind) { return kind.law.pull_off > 0.0; };
  if (k.normal == NormalLaw::jkr) {
    lines.push_back(fmt::format("JKR: work of adhesion {:.4g} J/m2, at walls {:.4g} J/m2; pull-off 3/2 pi w R*",
                                k.work_of_adhesion, k.wall_work_of_adhesion.value_or(k.work_of_adhesion)));
  } else if (std::none_of(d.kinds.begin(), d.kinds.end(), pulls)) {
    return;
  } else if (k.cohesion == Cohesion::dmt) {
    lines.push_back(fmt::format("DMT: work of adhesion {:.4g} J/m2, at walls {:.4g} J/m2; pull-off 2 pi w R*",
                                k.work_of_adhesion, k.wall_work_of_adhesion.value_or(k.work_of_adhesion)));
  } else {
    const double l = c.material.coarse_graining;
    lines.push_back(fmt::format(
        "van der Waals: H* {:.4g} J in use, {:.4g} J at walls; H = H*/l^{:g} {:.4g} J on the original grains (coarse "
        "graining l {:g})",
        d.hamaker, d.wall_hamaker, k.hamaker_power, d.original_hamaker, l));
    lines.push_back(fmt::format("  L of eq. (1) is the {} ({:.4g} mm), minimum separation {:.3g} nm, cut-off {:.3g} nm",
                                k.length_scale == LengthScale::diameter ? "diameter" : "radius", 1e3 * d.length_scale,
                                1e9 * k.minimum_separation, 1e9 * k.cut_off));
  }
  if (k.true_stiffness && k.normal == NormalLaw::linear)
    lines.push_back(fmt::format("  attraction scaled by sqrt(stiffness / {:.4g} N/m)", *k.true_stiffness));
  if (k.true_young_modulus && k.normal != NormalLaw::linear)
    lines.push_back(fmt::format("  attraction scaled by (young_modulus / {:.4g} Pa)^0.4", *k.true_young_modulus));
}

}  // namespace

std::vector<std::string> describe(const Case& c, const Derived& d) {
  const double mass = 1e3 * d.mass * static_cast<double>(d.spheres);
  const std::string sizes = d.smallest < d.largest
                                ? fmt::format("{:.4g} to {:.4g} mm", 1e3 * d.smallest, 1e3 * d.largest)
                                : fmt::format("{:.4g} mm", 1e3 * d.diameter);
  std::vector<std::string> lines{fmt::format("{} spheres of {}, {:.4g} g", d.spheres, sizes, mass)};
  add_contacts(d, lines);
  add_attraction(c, d, lines);
  if (c.contact.restitution_at)
    lines.push_back(fmt::format("damping found for the wanted restitution at {:.3g} m/s, attraction included",
                                *c.contact.restitution_at));
  lines.push_back(fmt::format("time step {:.4g} s, {:.3g} in the shortest contact, {:.4g} s: {}", d.time_step,
                              d.contact_duration / d.time_step, d.contact_duration, d.duration_of));
  return lines;
}

}  // namespace dem
