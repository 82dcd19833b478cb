#pragma once
// From coefficients to parts, and from a choice of parts to the one law that composes them.
#include <cmath>
#include <memory>

#include "dem/contact/forces/elastic.hpp"
#include "dem/contact/forces/law_pass.hpp"
#include "dem/contact/laws.hpp"

namespace dem {

inline double floor_of(const PairCoefficients& c) { return c.tension ? -std::numeric_limits<double>::infinity() : 0.0; }
inline double hertz_damping(const PairCoefficients& c) { return 2.0 * std::sqrt(5.0 / 6.0) * c.damping_ratio; }

inline void fill(LinearNormal& part, const PairCoefficients& c) {
  part = {c.stiffness, 2.0 * c.damping_ratio * std::sqrt(c.stiffness), floor_of(c)};
}
inline void fill(HertzNormal& part, const PairCoefficients& c) {
  part = {c.young_modulus, hertz_damping(c), floor_of(c)};
}
inline void fill(JkrNormal& part, const PairCoefficients& c) {
  part = {c.young_modulus, hertz_damping(c), floor_of(c), c.adhesion};
}
inline void fill(LinearTangential& part, const PairCoefficients& c) {
  // The dashpot is a share of the normal dashpot. The latter's linear form is taken beside Hertz too.
  const double ratio = c.tangential_damping * 2.0 * c.damping_ratio;
  part = {c.tangential_stiffness, ratio * std::sqrt(c.stiffness), c.friction};
}
inline void fill(MindlinTangential& part, const PairCoefficients& c) {
  part = {c.shear_modulus, c.tangential_damping * hertz_damping(c), c.friction};
}
inline void fill(NoResistance&, const PairCoefficients&) {}
inline void fill(ConstantResistance& part, const PairCoefficients& c) {
  part = {c.rolling_friction, c.twisting_friction};
}
inline void fill(SpringResistance& part, const PairCoefficients& c) {
  // The damping is a fraction of the critical one of a rolling oscillation, whose mass is that of spinning in place: I
  // / R^2 = 2/5 m.
  part = {c.rolling_friction, c.twisting_friction, c.rolling_stiffness,
          2.0 * c.rolling_damping * std::sqrt(0.4 * c.rolling_stiffness)};
}
inline void fill(NoAttraction&, const PairCoefficients&) {}
inline void fill(ShortRangeAttraction& part, const PairCoefficients& c) {
  part = {c.pull_off, c.minimum_separation, c.cut_off};
}

template <class Law>
Law make_law(const PairCoefficients& c) {
  Law law;
  fill(law.normal, c);
  fill(law.tangential, c);
  fill(law.resistance, c);
  fill(law.attraction, c);
  law.cap_weight = c.cap_weight;
  return law;
}

template <class Law>
std::shared_ptr<const ForcePass> composed(const BedCoefficients& bed) {
  const auto laws = [](const std::vector<PairCoefficients>& pairs) {
    std::vector<Law> made;
    for (const PairCoefficients& c : pairs) made.push_back(make_law<Law>(c));
    return made;
  };
  return std::make_shared<LawPass<Law>>(
      LawTables<Law>{laws(bed.grain), laws(bed.wall), bed.materials, bed.equal_mass, bed.equal_radius});
}

template <class Normal, class Tangential, class Resistance>
std::shared_ptr<const ForcePass> with_attraction(const BedCoefficients& bed) {
  if constexpr (!std::same_as<Normal, JkrNormal>) {
    if (bed.choice.attraction == AttractionLaw::short_range)
      return composed<ContactLaw<Normal, Tangential, Resistance, ShortRangeAttraction>>(bed);
  }
  return composed<ContactLaw<Normal, Tangential, Resistance, NoAttraction>>(bed);
}

/// The law of these elastic parts with the resistance and the attraction chosen.
template <class Normal, class Tangential>
std::shared_ptr<const ForcePass> compose(const BedCoefficients& bed) {
  switch (bed.choice.resistance) {
    case ResistanceLaw::constant:
      return with_attraction<Normal, Tangential, ConstantResistance>(bed);
    case ResistanceLaw::spring:
      return with_attraction<Normal, Tangential, SpringResistance>(bed);
    case ResistanceLaw::none:
      break;
  }
  return with_attraction<Normal, Tangential, NoResistance>(bed);
}

}  // namespace dem
