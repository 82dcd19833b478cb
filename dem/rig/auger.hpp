#pragma once
// The parts of the auger rigs: a right-handed auger about an axis along x, and sheets of triangles.
//
// The shaft and the blade's rim are 48-gons with vertices on the radius, the blade's two faces helicoids of 48 by 2
// quadrilaterals a pitch at x = pitch angle / 2 pi -+ thickness / 2.
#include <array>
#include <vector>

#include "data/error.hpp"
#include "dem/case/case.hpp"
#include "dem/case/cross_section.hpp"
#include "dem/rig/rig_kind.hpp"
#include "dem/walls/mesh.hpp"

namespace dem {

inline constexpr int facets = 48;         ///< sides of the shaft, the blade's rim and the trough's half circle
inline constexpr int rows_per_pitch = 4;  ///< rows of triangles of straight parts along the axis

/// Rows of points joined by triangles; `outside` is on the left of (along a row) x (to the next row).
void add_sheet(TriangleMesh& mesh, const std::vector<std::vector<Vec3>>& rows);

/// The point at this x, distance from the axis [m] and angle [rad] from y towards z.
Vec3 about_axis(double x, double radius, double angle);

struct Stretch {
  double from = 0.0, to = 0.0;  ///< m along x
};

/// Shaft and blade about the x axis. The blade's angle is 0 at x = 0; its ends lie at whole facets inside their
/// stretch. An auger that repeats along x is open at the blade's ends.
enum class BladeEnds { open, closed };
TriangleMesh auger_mesh(const Rig& rig, Stretch shaft, Stretch blade, BladeEnds ends);

/// A length of augers and trough as a quantity of the rig.
template <double Rig::*Field>
constexpr RigQuantity auger_length(const char* key, double low, double high, const char* meaning) {
  return {key,
          "m",
          low,
          high,
          meaning,
          [](const Case& c) { return c.rig.*Field; },
          [](Case& c, double si) { c.rig.*Field = si; }};
}
inline constexpr std::array auger_quantities{
    auger_length<&Rig::shaft_radius>("shaft_radius", 1e-6, 10.0, "radius of the shaft"),
    auger_length<&Rig::blade_radius>("blade_radius", 1e-6, 10.0, "outer radius of the blade"),
    auger_length<&Rig::blade_thickness>("blade_thickness", 1e-7, 10.0, "thickness of the blade along the axis"),
    auger_length<&Rig::pitch>("pitch", 1e-6, 100.0, "pitch of the helix"),
    auger_length<&Rig::trough_radius>("trough_radius", 1e-6, 10.0, "radius of the trough"),
};

/// Problems of augers and troughs that cannot be simulated.
std::vector<data::Problem> auger_problems(const Case& c);

/// A trough fuller than this many times the room below the blade's top is refused: the mixer would turn deep under the
/// powder.
inline constexpr double most_fill = 2.0;
void check_fill(const Case& c, const TroughFill& fill, std::vector<data::Problem>& found);

}  // namespace dem
