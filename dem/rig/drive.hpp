#pragma once
// The sign between the powder's moment on a mesh about its axis and the torque that its drive supplies.
#include "dem/case/case.hpp"
#include "dem/walls/motion.hpp"

namespace dem {

/// The sign: -1 where the mesh turns forward on the whole over the measured window, from run.start_up to run.longest,
/// so that a torque that the powder resists with is positive; else +1. A mesh that turns as far back as forward, or not
/// at all, has the moment itself as its torque.
double drive_sign(const Motion& motion, const RunControl& run);

/// Whether the sign of a measured body differs from the sign by its programme's last speed. The last speed decided in
/// earlier versions, so runs of such a rig differ from earlier ones.
bool drive_sign_corrected(const Case& c);

/// Time of a turn of the first measured body [s]; where it rests, of the body that turns the slowest, else of the
/// slowest oscillation; 0 where nothing moves. Of a rig that measures no body, a turn at the rig's angular velocity.
double turn_of(const Case& c);

}  // namespace dem
