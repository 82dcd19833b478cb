#pragma once
// Units as instruments and people spell them, and the unit in a column's heading.
#include <optional>
#include <string>
#include <string_view>

#include "data/unit.hpp"

namespace data {

/// The unit meant, if it measures what `dimension` does ("N m", "rpm", "s"); nothing if not. Besides what UDUNITS-2
/// reads, these are known: of torque a force and a length in any order, with any sign for a product or none (Nm, mNm,
/// daNm, kgf cm, g cm, oz-in, ft-lbs, Newtonmeter); where a speed of rotation is wanted, 1/min, U/min, tr/min, RPM and
/// their like (revolutions per minute), Hz, kHz, 1/s, rps (per second) and deg/s; of time sec, mins, hrs; of an angle
/// deg. The symbol of the result is one that UDUNITS-2 reads, perhaps a multiple: "60 rpm", "0.0625 lbf in".
std::optional<Unit> unit_meant(std::string_view text, std::string_view dimension);

/// Whether a text is a unit of anything; "-", "1" and "%" count, and the form of a clock's times, "hh:mm:ss".
bool is_unit(std::string_view text);

/// A heading taken apart. "Torque [mN m]", "Torque (mN m)", "Torque {mN m}", "Torque / mN m", "Torque / (mN m)",
/// "Torque/mNm" and "Torque, mN m" are all a name and its unit. In square brackets any text is the unit, whether it is
/// known or not; elsewhere only a known unit is.
struct Heading {
  std::string name, unit;
};
Heading read_heading(std::string_view text);

/// Takes apart "Torque_Nm", "Torque in Nm", "Torque Nm", "Torque:Nm", "Torque <Nm>", where the unit measures what
/// `dimension` does. It is for a reader that knows what it looks for, as other names may end so, too.
std::optional<Heading> heading_with_unit(std::string_view text, std::string_view dimension);

}  // namespace data
