#pragma once
// The bed as a camera sees it that looks along the rig's axis: its silhouette, averaged over time, and what is measured
// on it. x is to the right of the picture and z up (dem/rig/rig.hpp), both from the axis.
//
// One picture. The plane is divided into square cells. A cell is covered where its centre lies in the disc of a sphere;
// the cell of a sphere's own centre always is. The time is linear in the spheres.
//
// The time-averaged projection is the share of the pictures in which a cell is covered. The silhouette is the cells
// whose share exceeds `silhouette_share`.
//   centre  mean position of the silhouette's cells
//   area    their number times the area of a cell
//   angles  s is the distance along the slope from the line through the axis and the centre, upwards, and h(s) the
//           surface's height across the slope. A line of least squares through h over 0.1 R < s < 0.6 R has the upper
//           angle with the horizontal, one over -0.6 R < s < -0.1 R the lower. R is half the box's width, of a drum its
//           radius. Angles are positive where the bed stands higher on the side where the measured body rises.
// The surface is where the share, interpolated between the cells' centres, falls to `silhouette_share`. It is followed
// from above the centre to both sides. Where powder lies above it, a grain in flight mostly, it is left out. No angle
// is measured where more than a tenth of it is left out, where it ends before 0.6 R, or where the centre lies outside
// the silhouette, as that of a ring does.
#include <cstdint>
#include <span>
#include <vector>

#include "dem/contact/state.hpp"
#include "dem/engine/order.hpp"
#include "dem/rig/rig.hpp"

namespace dem {

/// A cell is powder where it is covered more often than not. The boundary is then the median of a surface that moves,
/// which grains in flight above it do not shift, and gaps between grains that open and close are closed.
inline constexpr double silhouette_share = 0.5;

/// The cells. `columns` is 0 where there is no picture: the axis is vertical, or the box repeats across it.
struct PicturePlane {
  Picture picture;
  double left = 0.0, bottom = 0.0;  ///< m, edges of the first cell
  double cell = 0.0;                ///< m, edge length
  int columns = 0, rows = 0;
  double reach = 0.0;  ///< m, half the box's width: R
};
/// Cells a quarter of the smallest sphere's diameter wide, or wider: there are 256 along the longer side at most.
PicturePlane picture_plane(const Picture& picture, const Box& box, double smallest_radius);

/// Pictures that were laid one upon the other, at most 255.
struct Exposure {
  int pictures = 0;
  std::vector<std::uint8_t> covered;  ///< in how many pictures each cell is covered, row by row from the bottom left
};
/// Adds the picture of these spheres.
void expose(const PicturePlane& plane, std::span<const PositionRow> spheres, Exposure& exposure);

/// Measures of a silhouette; NaN where one is not found.
struct Silhouette {
  double x, z;                      ///< m, the centre
  double area;                      ///< m2
  double upper_angle, lower_angle;  ///< rad
};
Silhouette silhouette_of(const PicturePlane& plane, const Exposure& exposure);

}  // namespace dem
