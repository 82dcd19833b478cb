#pragma once
// Units as instruments and people spell them, and the unit in a column's heading.
#include <optional>
#include <string>
#include <string_view>

#include "data/unit.hpp"

namespace data {

/// The unit meant, if it measures what `dimension` does ("N m", "rpm", "s"); nothing if not. Known besides what
/// UDUNITS-2 reads: Nm, mNm, uNm, Ncm, kgf cm, kp cm, gf cm, with any of the signs for a product; and, where a speed of
/// rotation is wanted, 1/min, min-1, U/min, r/min, rev/min, RPM (revolutions per minute), Hz, 1/s, s-1, rps (per
/// second). The symbol of the result is one that UDUNITS-2 reads.
std::optional<Unit> unit_meant(std::string_view text, std::string_view dimension);

/// Whether a text is a unit of anything; "-", "1" and "%" count.
bool is_unit(std::string_view text);

/// "Torque [mN m]", "Torque (mN m)", "Torque / mN m", "Torque/mNm" and "Torque, mN m" are all a name and its unit. In
/// square brackets stands a unit whether it is known or not; elsewhere only one that is.
struct Heading {
  std::string name, unit;
};
Heading read_heading(std::string_view text);

}  // namespace data
