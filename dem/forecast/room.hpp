#pragma once
// The room that a rig's bodies leave in its box at the start, as a grid of cells. It answers questions that need no
// run: where the powder comes to rest, whether anything holds it, and how full the vessel is.
//
// Two neighbouring cells are joined unless a triangle lies between their centres. A hole that no line between centres
// passes and a wall thinner than a cell therefore do not matter. A cell is narrow where no sphere's centre fits, within
// 0.9 of a radius of a surface; the powder wets narrow cells beside wide ones, but flows through wide ones only. A gap
// narrower than a sphere therefore keeps the powder in.
//
// The powder is poured like a liquid: it runs down from where it starts, then fills the lowest place first (priority
// flood, R. Barnes et al., Computers & Geosciences 62:117 (2014)). Its slope of repose is not asked about, so the
// surface is that of a levelled bed.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dem/rig/rig.hpp"

namespace dem {

struct Room {
  Vec3 low, cell;  ///< m, a corner of the box and the edges of a cell
  std::array<int, 3> n{1, 1, 1};
  std::array<bool, 3> periodic{false, false, false};
  Vec3 down;                         ///< unit
  std::vector<std::uint8_t> walled;  ///< per cell, bit 2 a + s: something lies between it and the next along axis a,
                                     ///< s = 0 towards low, 1 towards high; at the box's end before its face
  std::vector<std::uint8_t> narrow;  ///< per cell, 1: no sphere's centre fits
  int rim = 1;                       ///< number of cells that a sphere in a wide cell reaches into narrow ones

  std::size_t total() const { return walled.size(); }
  double volume() const { return cell.x * cell.y * cell.z; }  ///< m3, of a cell
  std::array<int, 3> index(std::size_t cell_number) const;
  Vec3 centre(std::size_t cell_number) const;                                               ///< m
  double height(std::size_t cell_number) const { return -dot(down, centre(cell_number)); }  ///< m, against gravity
  /// The cell at a point, wrapped along periodic axes; total() where that is outside the box.
  std::size_t at(Vec3 point) const;
  /// The cell beyond a side, total() where that is outside the box.
  std::size_t beyond(std::size_t cell_number, int side) const;
};

/// The room of a rig with its bodies where they start; `smallest` [m] is the smallest sphere's diameter.
Room make_room(const BuiltRig& rig, double smallest);

/// Powder come to rest.
struct Poured {
  std::vector<std::uint8_t> wet;  ///< per cell
  double surface = 0.0;           ///< m against gravity
  double held = 0.0;              ///< m3 that the vessel takes before it runs over
  bool leaves = false;            ///< whether some of the powder runs out of the box
  Vec3 leaves_at;                 ///< m, where it runs out
};
/// Pours a bed of `volume` [m3] at a cell.
Poured pour(const Room& room, std::size_t start, double volume);
/// Pours a bed of `volume` [m3] in equal parts at several cells. Parts that come to rest in different chambers stay
/// there, until one of them runs over into the next. The surface is the mean over the bed; what the vessel holds is
/// that of a bed poured at the first cell.
Poured pour(const Room& room, const std::vector<std::size_t>& starts, double volume);

/// Per cell, whether powder could come there from a cell, whatever its weight.
std::vector<std::uint8_t> reached_from(const Room& room, std::size_t start);

/// Whether a sphere let go at a point falls straight out of the box: no wall is under it.
bool falls_out(const Room& room, Vec3 point);

}  // namespace dem
