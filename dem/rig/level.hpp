#pragma once
// The level of a bed at rest: its share of the room that the rig's kind names (dem/case/cross_section.hpp,
// level_volume).
#include <algorithm>

#include "dem/case/cross_section.hpp"
#include "dem/case/grains.hpp"
#include "dem/rig/rig_kind.hpp"

namespace dem {

/// The level that is set, or else the level that the fill comes to, at most 1.
inline double level_of(const Case& c) {
  const double room = level_volume(c.rig);
  if (c.rig.level || room <= 0.0) return c.rig.level.value_or(0.0);
  return std::min(1.0, summarise_bed(c).volume / packing_fraction / room);
}

inline constexpr RigQuantity level_quantity{
    "level",
    "1",
    1e-6,
    1.0,
    "bed / drum, or bed / room of the machine below its blades' top, of volume, the bed at rest with a solid "
    "fraction of 0.6",
    level_of,
    [](Case& c, double si) { c.rig.level = si; }};

}  // namespace dem
