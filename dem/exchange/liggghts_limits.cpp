// What LIGGGHTS has no word for (liggghts.hpp).
#include <fmt/format.h>

#include <algorithm>

#include "dem/bed/derived.hpp"
#include "dem/case/grains.hpp"
#include "dem/exchange/liggghts.hpp"
#include "dem/rig/rig.hpp"

namespace dem {
namespace {

/// Whether a body's moduli differ from one material of the bed to the other.
bool follows_its_grain(const Case& c, const BodyLabel& body) {
  const std::vector<Component> parts = components_of(c);
  const Elastic first = elastic(c, parts.front().material, body);
  return std::any_of(parts.begin(), parts.end(), [&](const Component& part) {
    const Elastic with = elastic(c, part.material, body);
    return with.young_modulus != first.young_modulus || with.poisson_ratio != first.poisson_ratio;
  });
}

}  // namespace

std::vector<data::Problem> not_in_liggghts(const Case& c) {
  std::vector<data::Problem> found;
  const Contact& law = c.contact;
  const auto refuse = [&](const char* key, const std::string& what, const std::string& nearest) {
    found.push_back({key, "LIGGGHTS has no " + what, nearest});
  };
  const BedCoefficients bed = make_bed(c, body_labels(c));
  const auto any = [&](const auto& value) {
    const auto has = [&](const PairCoefficients& p) { return value(p) > 0.0; };
    return std::any_of(bed.grain.begin(), bed.grain.end(), has) || std::any_of(bed.wall.begin(), bed.wall.end(), has);
  };
  switch (law.normal) {  // without a default: a new law is refused until it is thought of here
    case NormalLaw::linear:
    case NormalLaw::hertz:
      if (any([](const PairCoefficients& p) { return p.pull_off; }))
        refuse("contact.cohesion", "attraction that stays the same in a contact",
               "the nearest is no attraction (hamaker = 0, work_of_adhesion = 0) and in its input `cohesion sjkr`, "
               "whose force grows with the contact's area");
      break;
    case NormalLaw::jkr:
      refuse("contact.normal", "JKR law",
             "the nearest is normal = \"hertz\" and in its input `cohesion sjkr`, whose force grows with the contact's "
             "area and is not JKR's");
      break;
  }
  if (law.normal == NormalLaw::hertz) {
    const std::vector<BodyLabel> bodies = body_labels(c);
    if (std::any_of(bodies.begin(), bodies.end(), [&](const BodyLabel& body) { return follows_its_grain(c, body); }))
      refuse("contact.wall_young_modulus", "wall whose moduli are those of each grain that it meets",
             "set contact.wall_young_modulus, and one Poisson's ratio for all materials");
  }
  if (law.normal == NormalLaw::hertz && law.tangential_law() == TangentialLaw::linear)
    refuse("contact.tangential", "linear tangential spring beside the Hertz law",
           "the nearest is tangential = \"mindlin\"");
  switch (law.resistance) {
    case ResistanceLaw::none:
    case ResistanceLaw::constant:
      break;
    case ResistanceLaw::spring:
      refuse("contact.resistance", "rolling spring along R* w x n",
             "the nearest is resistance = \"constant\", its `rolling_friction cdt`");
      break;
  }
  if (any([](const PairCoefficients& p) { return p.twisting_friction; }))
    refuse("contact.twisting_friction", "friction against twisting", "the nearest is 0");
  for (const RigBody& body : rig_bodies(c)) {
    if (body.motion.programme.size() > 1 || !body.motion.oscillations.empty())
      refuse("rig.mesh", fmt::format("motion like that of '{}' in one command", body.label.name),
             "the nearest is one constant speed (speed_ratio)");
  }
  return found;
}

}  // namespace dem
