#pragma once
// Areas and volumes of the auger rigs below a height, in closed form: they tell how high an amount of powder stands.
// Heights are counted from the augers' axes. An auger takes away the mean of its cross-section over its length.
#include <functional>

#include "dem/case/case.hpp"

namespace dem {

/// Area of a disc of this radius about the axis that lies below the height z [m2].
double disc_below(double radius, double z);

/// Area [m2] below z that the powder can take in one trough with its auger: volume per length of the slice.
double trough_room_below(const Rig& rig, double z);

/// Distance [m] of the middle of the machine's blades from the end wall where their powder comes in. It leaves twice
/// the clearance of blade and trough free: there the blade's blunt end goes first, and would pinch grains against wall
/// and trough.
double end_gap(const Rig& rig);

/// Volume of the machine below z, without its augers [m3].
double machine_room_below(const Rig& rig, double z);

/// The volume of which rig.level is a share [m3]: the drum's, or the machine's below the blades' top; else 0.
double level_volume(const Rig& rig);

/// How full a vessel of the auger rigs will be, the powder taken as a liquid of spheres packed to packing_fraction.
struct TroughFill {
  double share = 0.0;    ///< of the room below the blade's top
  double surface = 0.0;  ///< m above the axis
};
/// The fill of a bed as large as `bed` in a vessel with this room below a height, in the same unit. The room must grow
/// without end.
TroughFill level_out(const Rig& rig, double bed, const std::function<double(double z)>& room_below);

}  // namespace dem
