#pragma once
// The forecast of a run before it is made: how full the vessel is, where the bed's surface will lie, the gaps in
// spheres, and what moves how. It also finds what would make the run nonsense: powder that nothing holds or that does
// not fit, a tool that never meets it or that cuts the vessel (dem/forecast/room.hpp, dem/forecast/sweep.hpp; slice and
// drum in closed form).
//
// A bed is taken as a levelled liquid of packing_fraction. A tool is only said to miss the bed when it also misses a
// bed of half solids by more than a cell of the room's grid: heaps and waves are not asked about.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "data/error.hpp"
#include "dem/bed/derived.hpp"

namespace dem {

/// A gap between two bodies that move against each other.
struct NamedGap {
  std::string between;      ///< "paddle and vessel"
  double width = 0.0;       ///< m
  double in_spheres = 0.0;  ///< width in diameters of the largest sphere
};

struct Forecast {
  std::size_t spheres = 0;
  double mass = 0.0;              ///< kg
  double largest = 0.0;           ///< m
  std::optional<double> fill;     ///< share of what the vessel holds before it runs over; none where nothing holds any
  std::optional<double> surface;  ///< m against gravity, from the box's origin, or above slice's and drum's axis
  std::string up;                 ///< "z", "above the axis": what the surface is counted along
  std::string full_at;            ///< what a fill of 1 reaches
  std::vector<NamedGap> gaps;     ///< narrower than four of the largest sphere, the narrowest first
  std::vector<std::string> bodies;      ///< one line each: size, triangles, how it moves
  std::vector<data::Problem> problems;  ///< problems that make the run nonsense
  std::vector<std::string> warnings;    ///< remarks that a user should look at
};

/// Throws data::InputError (78) when the spheres do not fit.
Forecast forecast(const PreparedCase& prepared, std::uint64_t seed);

/// Fill, surface and gaps as lines for the user.
std::vector<std::string> describe(const Forecast& f);

}  // namespace dem
