#pragma once
// The space that moving bodies sweep, looked at without a run: whether the bodies leave the box, whether they cut each
// other, and where a gap between them is narrower than a sphere.
//
// Points on each body's surface (evenly by area, along its sharp edges, and its corners) are followed through one turn
// of the slowest body, or through the programme, in the frame of the other body. Bodies that move together therefore
// never meet, and two tools that mesh do not count as cutting each other merely because their sweeps overlap. A point
// that crosses the other's surface, and goes deeper than a quarter of the largest sphere on both sides of it, has cut
// it. A shaft that passes through a wall across its axis turns in its hole and crosses nothing. A blade that goes
// through a wall beside its axis all the way round crosses nothing either, and is said.
//
// A gap is the least distance of a point from the other's surface, taken across the gap: where the surfaces face each
// other within 45 degrees, not where one runs into the other. What a shaft has outside its wall makes no gap.
#include <optional>
#include <string>
#include <vector>

#include "dem/case/case.hpp"
#include "dem/rig/rig.hpp"

namespace dem {

/// A moving body that cuts another.
struct Cut {
  std::size_t body = 0, other = 0;
  double depth = 0.0;   ///< m
  double time = 0.0;    ///< s since the bodies started to move
  Vec3 at;              ///< m, in the box
  bool joined = false;  ///< their surfaces meet as they start: a shaft of many corners through a wall, maybe on purpose
};

/// The narrowest gap between two bodies that move against each other, both sides of it in the box.
struct Gap {
  std::size_t body = 0, other = 0;
  double width = 0.0;  ///< m
  Vec3 at;             ///< m
};

/// How far a body's surface goes out of the box as it moves.
struct Excursion {
  std::size_t body = 0;
  double most = 0.0, least = 0.0;  ///< shares of its surface that are in the box, over its way
};

/// A body that turns and sticks out through another's wall beside it, all the time, so that it crosses nothing.
struct Through {
  std::size_t body = 0, other = 0;
  double by = 0.0;  ///< m, from where it goes through to its farthest point from the axis
  Vec3 at;          ///< m, in the box
};

struct Sweeps {
  std::vector<Cut> cuts;  ///< the deepest of each pair of bodies
  std::vector<Through> throughs;
  std::vector<Gap> gaps;              ///< of each pair, those narrower than twice the largest sphere
  std::vector<Excursion> excursions;  ///< of each body that moves
};

/// Follows the bodies as they move. `largest` [m] is the largest sphere's diameter.
Sweeps follow_bodies(const BuiltRig& rig, const RunControl& run, double largest);

/// Points of a body's surface as it moves, in the box, for those who ask what it reaches [m].
std::vector<Vec3> swept_points(const BuiltRig& rig, std::size_t body, const RunControl& run);

}  // namespace dem
