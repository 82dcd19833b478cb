#pragma once
// Units by UDUNITS-2. Inside the program all numbers are SI; a Unit converts where they enter and leave it.
#include <string>
#include <string_view>

namespace data {

/// A unit and its affine map to SI base units: si = factor * value + offset. "" and "1" are dimensionless.
/// Angular speed in rpm becomes rad/s.
struct Unit {
  std::string symbol;  ///< as the user wrote it: "mN m"
  double factor = 1.0;
  double offset = 0.0;
  std::string si_symbol = "1";  ///< the SI unit that it is mapped to, in base units: "kg m2 s-2"
  bool of_differences = false;  ///< the unit is of errors and shifts: 2 degC are 2 K, and offset is 0
  Unit differences() const {
    Unit unit = *this;
    unit.offset = 0.0;
    unit.of_differences = true;
    return unit;
  }
  double to_si(double value) const { return factor * value + offset; }
  double from_si(double si) const { return (si - offset) / factor; }
  /// Converts a decimal text in long double, so that all readers get the same bits. Characters after the number are
  /// ignored. Text without a number gives 0, so the caller checks first.
  double to_si(std::string_view digits) const;
  /// The value rounded to this many significant digits in this unit, in SI.
  double rounded(double si, int digits) const;
  /// The decimal with the fewest digits that to_si(text) takes back to the same double.
  std::string digits(double si) const;
};

/// Whether a number of this unit is written without a unit.
inline bool is_bare(std::string_view symbol) { return symbol.empty() || symbol == "1"; }

/// The unit as it is written behind a number: " mN m", or nothing; of a unit that is a multiple itself " x 10 rpm".
inline std::string behind_number(std::string_view symbol) {
  if (is_bare(symbol)) return {};
  return (symbol.front() >= '0' && symbol.front() <= '9' ? " x " : " ") + std::string(symbol);
}

/// A quantity with its unit, as in a heading or in a line "# units: rpm [rpm], friction [1]" of a table.
inline std::string with_unit(std::string_view name, const Unit& unit) {
  return std::string(name) + " [" + (unit.symbol.empty() ? "1" : unit.symbol) + "]";
}

/// Parses a unit. Throws std::invalid_argument when UDUNITS-2 does not know it.
Unit parse_unit(std::string_view symbol);

/// Whether two units measure the same dimension. The radian counts: "rpm" is an angular speed and "Hz" is not, so that
/// 2 Hz is never taken for 2 rad/s; nor is "s" taken for a reciprocal "Hz", as UDUNITS-2 itself would.
bool convertible(std::string_view a, std::string_view b);

}  // namespace data
